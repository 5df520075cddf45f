#include "engine/world/Walkers.h"

#include <algorithm>

#include "engine/world/Object.h"
#include "engine/world/ObjectExtras.h"

namespace df {

Walkers::~Walkers() {
  for (Object* p_o : m_objects) p_o->m_p_extras->follows_path = false;
}

void Walkers::add(Object& object) {
  if (std::find(m_objects.begin(), m_objects.end(), &object) == m_objects.end()) m_objects.push_back(&object);
}

void Walkers::remove(Object& object) {
  std::erase(m_objects, &object);
}

void Walkers::step() {
  const std::vector<Object*> walkers = m_objects;  // those that arrive take themselves out
  for (Object* p_o : walkers) p_o->stepPath();
}

}  // namespace df

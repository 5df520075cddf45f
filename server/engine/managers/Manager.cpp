#include "engine/managers/Manager.h"

#include "engine/world/EventDispatch.h"
#include "engine/world/World.h"

namespace df {

int Manager::startUp() {
  m_is_started = true;
  World::current().setStarted(m_started, true);
  return 0;
}

void Manager::shutDown() {
  m_is_started = false;
  World::current().setStarted(m_started, false);
}

bool Manager::isStarted() const {
  return m_started != 0 ? World::current().isStarted(m_started) : m_is_started;
}

int Manager::registerInterest(Object* p_o, const std::string& event_type) {
  return p_o != nullptr ? p_o->registerInterest(event_type) : -1;
}

int Manager::unregisterInterest(Object* p_o, const std::string& event_type) {
  return p_o != nullptr ? p_o->unregisterInterest(event_type) : -1;
}

int Manager::onEvent(const Event* p_event) const {
  return World::current().events().onEvent(p_event);
}

}  // namespace df

#include "Manager.h"

#include "World.h"

namespace df {

int Manager::startUp() {
  m_is_started = true;
  return 0;
}

void Manager::shutDown() {
  m_is_started = false;
}

int Manager::onEvent(const Event* p_event) const {
  return World::current().onEvent(p_event);
}

}  // namespace df

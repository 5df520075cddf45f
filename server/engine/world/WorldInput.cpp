// The part of World that takes players' inputs.

#include "engine/world/InputQueue.h"
#include "engine/world/World.h"

namespace df {

std::uint32_t World::join(const std::string& name, Color color, std::uint32_t id) {
  return m_input->push({.kind = InputQueue::kJoin, .player = id, .name = name, .color = color});
}

void World::leave(std::uint32_t player) {
  m_input->push({.kind = InputQueue::kLeave, .player = player});
}

void World::key(std::uint32_t player, Keyboard::Key key, EventKeyboardAction action, const ViewedTick& seen) {
  m_input->push({.kind = InputQueue::kKey, .player = player, .seen = seen, .key = key, .key_action = action});
}

void World::mouse(std::uint32_t player, EventMouseAction action, Mouse::Button button, int x, int y,
                  const ViewedTick& seen) {
  m_input->push({.kind = InputQueue::kMouse,
                 .player = player,
                 .seen = seen,
                 .button = button,
                 .mouse_action = action,
                 .x = x,
                 .y = y});
}

void World::drainInput() {
  const Scope scope(*this);
  m_input->drain();
}

}  // namespace df

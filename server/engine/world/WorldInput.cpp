// The part of World that takes players' inputs.

#include <algorithm>

#include "engine/world/InputQueue.h"
#include "engine/world/World.h"

namespace df {

std::uint32_t World::join(const std::string& name, Color color, std::uint32_t id) {
  id = std::max(id, m_next_player);
  m_next_player = id + 1;
  m_input->push({.kind = InputQueue::kJoin, .player = id, .name = name, .color = color});
  return id;
}

void World::leave(std::uint32_t player) {
  m_input->push({.kind = InputQueue::kLeave, .player = player});
}

void World::key(std::uint32_t player, Keyboard::Key key, EventKeyboardAction action, const ViewedTick& seen) {
  if (key < 0 || key >= Keyboard::kKeyCount || action < KEY_PRESSED || action > KEY_DOWN) return;
  m_input->push({.kind = InputQueue::kKey, .player = player, .seen = seen, .key = key, .key_action = action});
}

void World::mouse(std::uint32_t player, EventMouseAction action, Mouse::Button button, int x, int y,
                  const ViewedTick& seen) {
  if (action < CLICKED || action > MOVED) return;
  if (button < Mouse::UNDEFINED_MOUSE_BUTTON || button > Mouse::MIDDLE) return;
  if (x < 0 || y < 0 || x >= getWindowWidth() || y >= getWindowHeight()) return;
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

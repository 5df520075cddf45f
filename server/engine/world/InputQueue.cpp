#include "engine/world/InputQueue.h"

#include <algorithm>
#include <utility>

#include "engine/events/EventKeyboard.h"
#include "engine/events/EventMouse.h"
#include "engine/world/ControlApplier.h"
#include "engine/world/EventPlayer.h"
#include "engine/world/Views.h"
#include "engine/world/World.h"
#include "engine/world/WorldExtras.h"

namespace df {

std::uint32_t InputQueue::push(Input input) {
  if (input.kind == kJoin) {
    input.player = std::max(input.player, m_world.m_next_player);
    m_world.m_next_player = input.player + 1;
  }
  const std::uint32_t player = input.player;
  if (input.kind == kScore) {
    m_world.extras().scores.keep(input.table, input.name, input.points);
    return player;
  }
  if (input.kind == kRoom) {
    m_world.extras().rooms.keep(std::move(input.room));
    return player;
  }
  if (isPossible(input)) m_inputs.push_back(std::move(input));
  return player;
}

bool InputQueue::isPossible(const Input& input) const {
  if (input.kind == kKey) {
    return input.key >= 0 && input.key < Keyboard::kKeyCount && input.key_action >= KEY_PRESSED &&
           input.key_action <= KEY_DOWN;
  }
  if (input.kind != kMouse) return true;
  return input.mouse_action >= CLICKED && input.mouse_action <= MOVED &&
         input.button >= Mouse::UNDEFINED_MOUSE_BUTTON && input.button <= Mouse::MIDDLE && input.x >= 0 &&
         input.y >= 0 && input.x < m_world.getWindowWidth() && input.y < m_world.getWindowHeight();
}

// The filter may set another one, or none.
bool InputQueue::isFiltered(const Event* p_event) {
  const WorldExtras* p_extras = m_world.findExtras();
  if (p_extras == nullptr || p_extras->input_filter == nullptr) return false;
  const auto filter = p_extras->input_filter;
  return filter(p_event);
}

void InputQueue::drain() {
  isFiltered(nullptr);
  std::vector<Input> inputs;
  inputs.swap(m_inputs);
  for (const Input& input : inputs) {
    const std::uint32_t before = std::exchange(m_world.m_input_player, input.player);
    const ViewedTick seen_before = std::exchange(m_world.m_input_seen, input.seen);
    handle(input);
    m_world.m_input_player = before;
    m_world.m_input_seen = seen_before;
  }
}

void InputQueue::handle(const Input& input) {
  if (input.kind == kJoin) {
    m_world.views().addPlayer(input.player, input.name, input.color);
    const EventJoin event(input.player);
    m_world.onEvent(&event);
    return;
  }
  if (m_world.getPlayer(input.player) == nullptr) return;  // has left, or never joined
  if (input.kind == kKey) sendKey(input);
  if (input.kind == kMouse) sendMouse(input);
  if (input.kind == kLeave) {
    const EventLeave event(input.player);
    if (!isFiltered(&event)) m_world.onEvent(&event);
    m_world.views().removePlayer(input.player);
  }
}

void InputQueue::sendKey(const Input& input) {
  EventKeyboard event;
  event.setKey(input.key);
  event.setKeyboardAction(input.key_action);
  event.setPlayer(input.player);
  // Declared controls have no effect during a pause, either.
  event.setHandled(!m_world.isPaused() &&
                   handleKey(m_world, *m_world.getPlayer(input.player), input.key, input.key_action));
  if (!isFiltered(&event)) m_world.onEvent(&event);
}

void InputQueue::sendMouse(const Input& input) {
  FixedVector corner = m_world.views().cornerOf(m_world.getPlayer(input.player));
  if (m_world.m_p_lag_compensation != nullptr && input.seen.known) {
    corner = m_world.m_p_lag_compensation->viewCornerOf(input.player, input.seen).value_or(corner);
  }
  EventMouse event;
  event.setMouseAction(input.mouse_action);
  event.setMouseButton(input.button);
  event.setMousePosition(Vector(static_cast<double>(cellOf(corner.x)) + input.x,
                                static_cast<double>(cellOf(corner.y)) + input.y));
  event.setPlayer(input.player);
  if (!isFiltered(&event)) m_world.onEvent(&event);
}

}  // namespace df

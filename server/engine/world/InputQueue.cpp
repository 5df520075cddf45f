#include "engine/world/InputQueue.h"

#include <algorithm>
#include <utility>

#include "engine/events/EventKeyboard.h"
#include "engine/events/EventMouse.h"
#include "engine/world/ControlApplier.h"
#include "engine/world/EventDispatch.h"
#include "engine/world/EventPlayer.h"
#include "engine/world/ObjectRegistry.h"
#include "engine/world/Views.h"
#include "engine/world/WorldExtras.h"
#include "engine/world/WorldState.h"

namespace df {

InputQueue::InputQueue(ObjectRegistry& objects, Views& views, EventDispatch& events, Mover& mover,
                       LazyExtras& extras, const WorldState& state)
    : m_objects(objects),
      m_views(views),
      m_events(events),
      m_mover(mover),
      m_extras(extras),
      m_state(state) {}

std::uint32_t InputQueue::join(const std::string& name, Color color, std::uint32_t id) {
  return push({.kind = kJoin, .player = id, .name = name, .color = color});
}

void InputQueue::leave(std::uint32_t player) {
  push({.kind = kLeave, .player = player});
}

void InputQueue::key(std::uint32_t player, Keyboard::Key key, EventKeyboardAction action,
                     const ViewedTick& seen) {
  push({.kind = kKey, .player = player, .seen = seen, .key = key, .key_action = action});
}

void InputQueue::mouse(std::uint32_t player, EventMouseAction action, Mouse::Button button, int x, int y,
                       const ViewedTick& seen) {
  push({.kind = kMouse,
        .player = player,
        .seen = seen,
        .button = button,
        .mouse_action = action,
        .x = x,
        .y = y});
}

std::uint32_t InputQueue::push(Input input) {
  // Ids are used once, except that a player whose leave waits here may join again (RoomManager::restart).
  const auto leaves = [&input](const Input& one) { return one.kind == kLeave && one.player == input.player; };
  if (input.kind == kJoin && std::none_of(m_inputs.begin(), m_inputs.end(), leaves)) {
    input.player = std::max(input.player, m_next_player);
    m_next_player = input.player + 1;
  }
  const std::uint32_t player = input.player;
  if (input.kind == kScore) {
    m_extras.get().scores.addStored(input.table, input.name, input.points);
    return player;
  }
  if (input.kind == kRoom) {
    m_extras.get().rooms.update(std::move(input.room));
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
         input.y >= 0 && input.x < m_views.width() && input.y < m_views.height();
}

// Calls a copy of the filter, because the filter may replace or remove itself.
bool InputQueue::isFiltered(const Event* p_event) {
  const WorldExtras* p_extras = m_extras.find();
  if (p_extras == nullptr || p_extras->input_filter == nullptr) return false;
  const auto filter = p_extras->input_filter;
  return filter(p_event);
}

void InputQueue::clear() {
  m_inputs.clear();
  m_leavers.clear();
  m_lag_compensated = false;
}

bool InputQueue::handleGameOver() {
  if (!m_game_over_leaves || m_player == 0) return false;
  m_leavers.push_back(m_player);
  return true;
}

void InputQueue::drain() {
  isFiltered(nullptr);
  std::vector<Input> inputs;
  inputs.swap(m_inputs);
  for (const Input& input : inputs) {
    const std::uint32_t before = std::exchange(m_player, input.player);
    const ViewedTick seen_before = std::exchange(m_seen, input.seen);
    handle(input);
    m_player = before;
    m_seen = seen_before;
  }
}

void InputQueue::handle(const Input& input) {
  if (input.kind == kJoin) {
    m_views.addPlayer(input.player, input.name, input.color);
    const EventJoin event(input.player);
    m_events.onEvent(&event);
    return;
  }
  if (m_views.player(input.player) == nullptr) return;  // the player has left, or never joined
  if (input.kind == kKey) sendKey(input);
  if (input.kind == kMouse) sendMouse(input);
  if (input.kind == kLeave) {
    const EventLeave event(input.player);
    if (!isFiltered(&event)) m_events.onEvent(&event);
    m_views.removePlayer(input.player);
  }
}

void InputQueue::sendKey(const Input& input) {
  EventKeyboard event;
  event.setKey(input.key);
  event.setKeyboardAction(input.key_action);
  event.setPlayer(input.player);
  // Like handlers, declared controls do not get keys during a pause.
  event.setHandled(!m_state.paused && ControlApplier::handleKey(m_mover, *m_views.player(input.player),
                                                                input.key, input.key_action));
  if (!isFiltered(&event)) m_events.onEvent(&event);
}

void InputQueue::sendMouse(const Input& input) {
  FixedVector corner = m_views.cornerOf(m_views.player(input.player));
  if (m_p_lag_compensation != nullptr && input.seen.known) {
    corner = m_p_lag_compensation->viewCornerOf(input.player, input.seen).value_or(corner);
  }
  EventMouse event;
  event.setMouseAction(input.mouse_action);
  event.setMouseButton(input.button);
  event.setMousePosition(Vector(static_cast<double>(cellOf(corner.x)) + input.x,
                                static_cast<double>(cellOf(corner.y)) + input.y));
  event.setPlayer(input.player);
  if (!isFiltered(&event)) m_events.onEvent(&event);
}

// True if an Object's box is drawn in this cell, on one axis. A box smaller than a cell is drawn in one cell.
static bool coversCell(Fixed position, Fixed corner, Fixed extent, std::int32_t cell) {
  if (extent < kFixedOne) return cellOf(position + corner + extent / 2) == cell;
  return cellOf(position + corner + kFixedOne / 2) <= cell &&
         cell <= cellOf(position + corner + extent - kFixedOne / 2);
}

ObjectList InputQueue::objectsSeenAt(Vector cell) const {
  const auto where = toFixed(cell);
  if (!where) return {};
  const WorldStore& store = m_objects.store();
  return m_objects.collect([&](auto s) {
    if (!store.has(s, WorldStore::kActive) || !store.has(s, WorldStore::kVisible)) return false;
    std::optional<FixedVector> p = store.position(s);
    if (m_p_lag_compensation != nullptr && m_seen.known) {
      p = m_p_lag_compensation->positionOf(store.key(s), m_seen);
    }
    const FixedBox box = store.box(s);
    return p && coversCell(p->x, box.corner.x, box.size.x, cellOf(where->x)) &&
           coversCell(p->y, box.corner.y, box.size.y, cellOf(where->y));
  });
}

}  // namespace df

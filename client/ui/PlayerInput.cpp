#include "client/ui/PlayerInput.h"

#include <algorithm>
#include <utility>

namespace naiad {

void PlayerInput::moveMouse(const MouseEvent& event, const ViewPlacement& placement, Time now) {
  ClientSession* session = m_connection.session();
  if (event.action == MouseEvent::Action::kRelease) m_button = df::Mouse::UNDEFINED_MOUSE_BUTTON;
  const auto cell = placement.toView(event.x, event.y);
  if (!cell || session == nullptr) return;
  if (!(*cell == m_pointer)) m_move = m_pointer = *cell;
  if (event.action != MouseEvent::Action::kPress) return;
  m_button = event.button;
  session->sendMouse(df::CLICKED, event.button, cell->x, cell->y, now);
}

void PlayerInput::update(Time now) {
  sendKeys(m_held.expire(now), now);
  sendHeld(now);
  sendMove(now);
}

PlayerInput::Time PlayerInput::deadline() const {
  const Time next = std::min(m_held.deadline(), m_next_key_tick);
  return m_move ? std::min(next, m_last_move + kMoveInterval) : next;
}

void PlayerInput::sendKeys(const std::vector<KeyAction>& actions, Time now) {
  ClientSession* session = m_connection.session();
  if (session == nullptr) return;
  for (const KeyAction& action : actions) session->sendKey(action.key, action.action, now);
}

void PlayerInput::sendHeld(Time now) {
  if (now < m_next_key_tick) return;
  ClientSession* session = m_connection.session();
  const auto tick = session != nullptr ? session->welcome().tick : WelcomeMessage().tick;
  m_next_key_tick = std::max(m_next_key_tick + tick, now + tick / 2);
  sendKeys(m_held.tick(), now);
  if (m_button != df::Mouse::UNDEFINED_MOUSE_BUTTON && session != nullptr) {
    session->sendMouse(df::PRESSED, m_button, m_pointer.x, m_pointer.y, now);
  }
}

void PlayerInput::sendMove(Time now) {
  if (!m_move || now - m_last_move < kMoveInterval || m_connection.session() == nullptr) return;
  const CellPosition cell = *std::exchange(m_move, std::nullopt);
  m_last_move = now;
  m_connection.session()->sendMouse(df::MOVED, df::Mouse::UNDEFINED_MOUSE_BUTTON, cell.x, cell.y, now);
}

}  // namespace naiad

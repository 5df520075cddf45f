#include "engine/world/Controls.h"

namespace df {

Controls& Controls::onKey(Keyboard::Key key, EventKeyboardAction action) {
  m_key = key;
  m_action = action;
  return *this;
}

Controls& Controls::step(double dx, double dy) {
  return add(ControlEffect::kStep, true, true, dx, dy);
}

Controls& Controls::velocity(double vx, double vy) {
  return add(ControlEffect::kVelocity, true, true, vx, vy);
}

Controls& Controls::velocityX(double vx) {
  return add(ControlEffect::kVelocity, true, false, vx, 0);
}

Controls& Controls::velocityY(double vy) {
  return add(ControlEffect::kVelocity, false, true, 0, vy);
}

Controls& Controls::drive(double vx, double vy) {
  return add(ControlEffect::kDrive, vx != 0, vy != 0, vx, vy);
}

Controls& Controls::every(int ticks, int group) {
  if (m_table.rows.empty() || ticks < 0 || ticks > kMaxControlTicks || group < 0 ||
      group >= static_cast<int>(kControlGroups)) {
    m_is_invalid = true;
    return *this;
  }
  m_table.rows.back().wait = static_cast<std::uint16_t>(ticks);
  m_table.rows.back().group = static_cast<std::uint8_t>(group);
  return *this;
}

Controls& Controls::within(const Box& box) {
  const auto bounds = toFixed(box);
  m_is_invalid |= !bounds;
  m_table.bounded = true;
  m_table.bounds = bounds.value_or(FixedBox{});
  return *this;
}

Controls& Controls::toWholeCells() {
  m_table.whole_cells = true;
  return *this;
}

Controls& Controls::releaseAfter(int ticks) {
  m_is_invalid |= ticks < 0 || ticks > kMaxControlTicks;
  if (!m_is_invalid) m_table.patience = static_cast<std::uint16_t>(ticks);
  return *this;
}

std::optional<ControlTable> Controls::table() const {
  if (m_is_invalid || !isValid(m_table)) return std::nullopt;
  return m_table;
}

Controls& Controls::add(ControlEffect effect, bool x, bool y, double vx, double vy) {
  const auto value = toFixed(Vector(vx, vy), toCells(kMaxControlReach));
  m_is_invalid |= !value || m_table.rows.size() == kMaxControlRows;
  if (m_is_invalid) return *this;
  const EventKeyboardAction action = effect == ControlEffect::kDrive ? KEY_PRESSED : m_action;
  m_table.rows.push_back({m_key, action, effect, x, y, *value});
  return *this;
}

}  // namespace df

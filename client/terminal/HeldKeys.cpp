#include "client/terminal/HeldKeys.h"

#include <algorithm>

namespace naiad {

std::vector<KeyAction> HeldKeys::setRealReleases(bool real) {
  if (real == m_real) return {};
  std::vector<KeyAction> out = releaseAll();
  m_real = real;
  return out;
}

std::vector<KeyAction> HeldKeys::takeKey(const KeyEvent& event, Time now) {
  std::vector<KeyAction> out = expire(now);
  if (event.key == df::Keyboard::UNDEFINED_KEY) return out;
  const auto held = m_held.find(event.key);
  if (event.action == KeyEvent::Action::kRelease) {
    // The key was pressed while a text line was open.
    if (held == m_held.end()) return out;
    m_held.erase(held);
    out.push_back({event.key, df::KEY_RELEASED});
    return out;
  }
  if (held == m_held.end()) {
    m_held.emplace(event.key, Held{now, m_real});
    out.push_back({event.key, df::KEY_PRESSED});
    return out;
  }
  if (!m_real) learn(now - held->second.last);
  held->second.last = now;
  held->second.repeating = true;
  return out;
}

std::vector<KeyAction> HeldKeys::expire(Time now) {
  std::vector<KeyAction> out;
  if (m_real) return out;
  for (auto it = m_held.begin(); it != m_held.end();) {
    if (now - it->second.last >= releaseDelay()) {
      out.push_back({it->first, df::KEY_RELEASED});
      it = m_held.erase(it);
    } else {
      ++it;
    }
  }
  return out;
}

HeldKeys::Time HeldKeys::deadline() const {
  Time first = Time::max();
  if (m_real) return first;
  for (const auto& [key, held] : m_held) first = std::min(first, held.last + releaseDelay());
  return first;
}

std::vector<KeyAction> HeldKeys::tick() const {
  std::vector<KeyAction> out;
  for (const auto& [key, held] : m_held) {
    if (held.repeating && out.size() < kMaxHeld) out.push_back({key, df::KEY_DOWN});
  }
  return out;
}

std::vector<KeyAction> HeldKeys::releaseAll() {
  std::vector<KeyAction> out;
  for (const auto& [key, held] : m_held) out.push_back({key, df::KEY_RELEASED});
  m_held.clear();
  return out;
}

HeldKeys::Duration HeldKeys::releaseDelay() const {
  return std::clamp<Duration>(m_interval * 3 / 2, kMinRelease, kMaxRelease);
}

void HeldKeys::learn(Duration gap) {
  // Repeats that the network bunched up arrive together and say nothing about the keyboard.
  if (gap < std::chrono::milliseconds(5)) return;
  m_interval += (gap - m_interval) / 8;
}

}  // namespace naiad

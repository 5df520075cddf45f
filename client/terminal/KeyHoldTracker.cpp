#include "client/terminal/KeyHoldTracker.h"

#include <algorithm>
#include <array>
#include <utility>

namespace naiad {
namespace {

using df::Keyboard::Key;

/// Returns the key of the opposite direction in its group (arrows, WASD); undefined for other keys.
Key oppositeOf(Key key) {
  using namespace df::Keyboard;
  static constexpr std::array<std::pair<Key, Key>, 4> kPairs = {
      {{LEFTARROW, RIGHTARROW}, {UPARROW, DOWNARROW}, {A, D}, {W, S}}};
  for (const auto& [one, other] : kPairs) {
    if (key == one) return other;
    if (key == other) return one;
  }
  return UNDEFINED_KEY;
}

bool isDirection(Key key) {
  return oppositeOf(key) != df::Keyboard::UNDEFINED_KEY;
}

}  // namespace

std::vector<KeyAction> KeyHoldTracker::setRealReleases(bool real) {
  if (real == m_real) return {};
  std::vector<KeyAction> out = releaseAll();
  m_real = real;
  return out;
}

std::vector<KeyAction> KeyHoldTracker::handleKey(const KeyEvent& event, Time now) {
  if (event.key == df::Keyboard::UNDEFINED_KEY) return expire(now);
  if (!m_real && event.action != KeyEvent::Action::kRelease) return handleTyped(event.key, now);
  std::vector<KeyAction> out = expire(now);
  const auto held = m_held.find(event.key);
  if (event.action == KeyEvent::Action::kRelease) {
    // The key is not held if it was pressed while a chat line was open.
    if (held == m_held.end()) return out;
    m_held.erase(held);
    out.push_back({event.key, df::KEY_RELEASED});
  } else if (held == m_held.end()) {
    m_held.emplace(event.key, Held{now, now, true});
    out.push_back({event.key, df::KEY_PRESSED});
  }
  return out;
}

std::vector<KeyAction> KeyHoldTracker::handleTyped(Key key, Time now) {
  std::vector<KeyAction> out = expire(now);
  learnPause(key, now);
  updateOtherHolds(key, now, out);
  const auto held = m_held.find(key);
  if (held == m_held.end()) {
    pressFirst(key, m_held[key], now);
    out.push_back({key, df::KEY_PRESSED});
    return out;
  }
  const Duration gap = now - held->second.last;
  // If a key types sooner than the keyboard would repeat it, or after another key, it was pressed again.
  const bool again = held->second.silenced || (held->second.bridging && gap < bridge(key) * 3 / 4);
  if (again && gap >= releaseDelay()) {
    out.push_back({key, df::KEY_RELEASED});
    out.push_back({key, df::KEY_PRESSED});
    pressFirst(key, held->second, now);
    return out;
  }
  handleRepeat(held->second, now);
  return out;
}

void KeyHoldTracker::pressFirst(Key key, Held& held, Time now) {
  const Duration over = bridge(key);
  const bool bridges = over > Duration{};
  held = Held{now, now + (bridges ? over : releaseDelay()), bridges, bridges};
}

void KeyHoldTracker::handleRepeat(Held& held, Time now) {
  if (!held.bridging) learnInterval(now - held.last);
  held = Held{now, now + releaseDelay(), true};
}

// Keyboards repeat only the key pressed last, so the other held keys fall silent, released or not.
void KeyHoldTracker::updateOtherHolds(Key key, Time now, std::vector<KeyAction>& out) {
  if (m_held.contains(key)) return;
  for (auto it = m_held.begin(); it != m_held.end();) {
    Held& other = it->second;
    const bool opposite = m_rule.opposites && oppositeOf(it->first) == key;
    const bool stays = m_rule.companion > Duration{} && !opposite;
    if (opposite || (other.bridging && !stays)) {
      out.push_back({it->first, df::KEY_RELEASED});
      it = m_held.erase(it);
      continue;
    }
    // Only once: repeated taps of this key must not keep a released key down.
    if (stays && other.repeating && !std::exchange(other.silenced, true))
      other.until = std::max(other.until, now + m_rule.companion);
    ++it;
  }
}

KeyHoldTracker::Duration KeyHoldTracker::bridge(Key key) const {
  if (!isDirection(key) || m_rule.first == HoldRule::First::kTap) return {};
  if (m_rule.first == HoldRule::First::kUsual) return kUsualPause + kUsualPause / 8;
  return m_pause > Duration{} ? m_pause + m_pause / 8 + std::chrono::milliseconds(20) : Duration{};
}

std::vector<KeyAction> KeyHoldTracker::expire(Time now) {
  std::vector<KeyAction> out;
  if (m_real) return out;
  for (auto it = m_held.begin(); it != m_held.end();) {
    if (now >= it->second.until) {
      out.push_back({it->first, df::KEY_RELEASED});
      it = m_held.erase(it);
    } else {
      ++it;
    }
  }
  return out;
}

KeyHoldTracker::Time KeyHoldTracker::deadline() const {
  Time first = Time::max();
  if (m_real) return first;
  for (const auto& [key, held] : m_held) first = std::min(first, held.until);
  return first;
}

std::vector<KeyAction> KeyHoldTracker::tick() const {
  std::vector<KeyAction> out;
  for (const auto& [key, held] : m_held) {
    if (held.repeating && out.size() < kMaxHeld) out.push_back({key, df::KEY_DOWN});
  }
  return out;
}

std::vector<KeyAction> KeyHoldTracker::releaseAll() {
  std::vector<KeyAction> out;
  for (const auto& [key, held] : m_held) out.push_back({key, df::KEY_RELEASED});
  m_held.clear();
  return out;
}

KeyHoldTracker::Duration KeyHoldTracker::releaseDelay() const {
  return std::clamp<Duration>(m_interval * 3 / 2, kMinRelease, kMaxRelease);
}

void KeyHoldTracker::learnInterval(Duration gap) {
  // Repeats that the network delivers together do not show the keyboard's interval.
  if (gap < std::chrono::milliseconds(5)) return;
  m_interval += (gap - m_interval) / 8;
}

// A byte soon after the last one is a repeat, so the gap before the last one was the pause.
void KeyHoldTracker::learnPause(Key key, Time now) {
  Past& past = m_past[key];
  const Duration gap = now - past.last;
  if (gap >= std::chrono::milliseconds(5) && gap < kMinRelease) {
    const Duration pause = past.last - past.first;
    if (pause >= kMinPause && pause <= kMaxPause) m_pause = pause;
  }
  past.first = std::exchange(past.last, now);
}

}  // namespace naiad

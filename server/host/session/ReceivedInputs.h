// The inputs that a client sent and the world has not had yet: in order, each id once.
//
// They wait here, and not in the world's InputQueue, which lasts for one tick. The limits are a client's, and
// are enforced as its updates arrive, while a world in a process of its own answers later. A snapshot
// acknowledges the inputs of its tick, so the host has to know which these are.
#pragma once

#include <algorithm>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>

#include "shared/replica/Acks.h"
#include "shared/replica/UpdateCodec.h"
#include "shared/values/ControlTable.h"
#include "shared/values/Keyboard.h"

namespace naiad {

/// The keys that a player holds down, by the inputs received. A client that is cut off or killed sends no
/// releases, so the server makes them.
class PressedKeys {
 public:
  void noteInput(const Input& input) {
    if (!input.is_mouse) m_down.set(input.key, input.action != df::KEY_RELEASED);
  }
  /// Call `release(input)` with a release of each key that is down, by key. No key is down afterwards.
  template <class Release>
  void releaseAll(Release release) {
    for (std::size_t key = 0; key < m_down.size() && m_down.any(); ++key) {
      if (!m_down.test(key)) continue;
      m_down.reset(key);
      Input input;
      input.key = static_cast<std::uint8_t>(key);
      input.action = df::KEY_RELEASED;
      release(input);
    }
  }

 private:
  std::bitset<df::Keyboard::kKeyCount> m_down;
};

class ReceivedInputs {
 public:
  static constexpr std::size_t kMaxQueued = 64;
  static constexpr int kPerTick = 16;
  /// An input that asks for a tick farther ahead is applied at once.
  static constexpr std::int32_t kMaxEarly = 8;

  enum class Verdict { kQueued, kRepeated, kTooMany };
  Verdict add(const Input& input) {
    if (!isNewer(input.id, m_newest)) return Verdict::kRepeated;
    if (m_queue.size() >= kMaxQueued) return Verdict::kTooMany;
    m_newest = input.id;
    m_queue.push_back(input);
    m_pressed.noteInput(input);
    return Verdict::kQueued;
  }
  /// Call `apply(input)` for up to kPerTick inputs that are due in the world's next tick.
  template <class Apply>
  void takeDue(std::uint32_t tick, Apply apply) {
    for (int i = 0; i < kPerTick && !m_queue.empty() && !isTooEarly(m_queue.front(), tick); ++i) {
      apply(m_queue.front());
      m_queue.pop_front();
    }
  }
  /// Queue the release of all keys that are down, in the tick `tick`.
  void releaseKeys(std::uint32_t tick) {
    m_pressed.releaseAll([this, tick](Input input) {
      input.id = m_newest;  // acknowledged together with that one
      input.tick = tick;
      m_queue.push_back(input);
    });
  }
  /// Another world begins: drop keys, controls and queued inputs. Return the last id dropped.
  std::optional<std::uint32_t> clear() {
    std::optional<std::uint32_t> last;
    if (!m_queue.empty()) last = m_queue.back().id;
    m_queue.clear();
    m_pressed = {};
    m_controls.reset();
    return last;
  }

  /// The player steers by declared controls (null: does not). Keys in them wait for the tick that they ask
  /// for, since the client's prediction has applied them there.
  void setControls(const std::shared_ptr<const df::ControlTable>& controls) {
    if (m_controls != controls) m_controls = controls;
  }
  /// The id received last; 0: none.
  std::uint32_t newest() const { return m_newest; }

 private:
  bool isTooEarly(const Input& input, std::uint32_t tick) const {
    const auto early = static_cast<std::int32_t>(input.tick - tick);
    if (m_controls == nullptr || input.is_mouse || early <= 0 || early > kMaxEarly) return false;
    return std::any_of(m_controls->rows.begin(), m_controls->rows.end(),
                       [&input](const df::ControlRow& row) { return row.key == input.key; });
  }

  std::deque<Input> m_queue;
  std::uint32_t m_newest = 0;
  PressedKeys m_pressed;  ///< after all of m_queue
  std::shared_ptr<const df::ControlTable> m_controls;
};

}  // namespace naiad

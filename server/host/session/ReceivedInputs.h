// Inputs received from a client and not yet applied by the world: in order, each id once.
//
// They wait here because the world's InputQueue lasts for one tick only. Limits are per client and are
// checked when updates arrive; a world process could check them only later. A snapshot acknowledges the
// inputs of its tick, so the host must know which inputs a tick has.
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

/// The keys that a player holds down according to the received inputs. A disconnected or killed client sends
/// no releases, so the server creates them.
class PressedKeys {
 public:
  void recordInput(const Input& input) {
    if (!input.is_mouse) m_down.set(input.key, input.action != df::KEY_RELEASED);
  }
  /// Calls `release(input)` with a release of each key that is down, in key code order; then no key is down.
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
  /// Maximum number of waiting inputs; one more is kTooMany, which ends the session (Session::handleInput()).
  static constexpr std::size_t kMaxQueued = 64;
  static constexpr int kPerTick = 16;  ///< maximum number of inputs applied in a tick; others wait
  /// Number of ticks: an input for a tick further ahead than this is applied at once.
  static constexpr std::int32_t kMaxEarly = 8;

  enum class Result { kQueued, kRepeated, kTooMany };
  Result add(const Input& input) {
    if (!isNewer(input.id, m_newest)) return Result::kRepeated;
    if (m_queue.size() >= kMaxQueued) return Result::kTooMany;
    m_newest = input.id;
    m_queue.push_back(input);
    m_pressed.recordInput(input);
    return Result::kQueued;
  }
  /// Calls `apply(input)` for up to kPerTick inputs that are due in `tick`, the world's next tick.
  template <class Apply>
  void popDue(std::uint32_t tick, Apply apply) {
    for (int i = 0; i < kPerTick && !m_queue.empty() && !isTooEarly(m_queue.front(), tick); ++i) {
      apply(m_queue.front());
      m_queue.pop_front();
    }
  }
  /// Queues a release of each key that is down, for `tick`.
  void releaseKeys(std::uint32_t tick) {
    m_pressed.releaseAll([this, tick](Input input) {
      input.id = m_newest;  // acknowledged together with the newest input
      input.tick = tick;
      m_queue.push_back(input);
    });
  }
  /// Drops keys, controls and queued inputs, for another world. Returns the last dropped input's id, if any.
  std::optional<std::uint32_t> clear() {
    std::optional<std::uint32_t> last;
    if (!m_queue.empty()) last = m_queue.back().id;
    m_queue.clear();
    m_pressed = {};
    m_controls.reset();
    return last;
  }

  /// Sets the controls that the player steers with; null: none. An input of one of their keys waits for the
  /// tick that it names, because the client's prediction applied the input in that tick.
  void setControls(const std::shared_ptr<const df::ControlTable>& controls) {
    if (m_controls != controls) m_controls = controls;
  }
  /// Returns the id of the newest received input; 0 if none.
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
  PressedKeys m_pressed;  ///< keys that are down after all inputs of m_queue
  std::shared_ptr<const df::ControlTable> m_controls;
};

}  // namespace naiad

// Which appearance of a sequence is shown: a function of the tick that server and client share.
//
// So what is animated, and what turns, costs nothing while it goes on: both ends count ticks.
#pragma once

#include <cstddef>
#include <cstdint>

namespace naiad {

/// Appearances of a sequence, at most.
inline constexpr std::size_t kMaxFrames = 256;
/// Ticks for which a clock shows one of them, at most.
inline constexpr std::uint32_t kMaxTicksPerFrame = 1u << 16;

/// Made by the functions below. What does not belong to its kind is 0 (ticks_per_frame: 1).
struct Selector {
  enum Kind : std::uint8_t {
    kFixed,      ///< one, for ever
    kClock,      ///< one after the other, round and round
    kClockOnce,  ///< one after the other; the last one stays
    kAngle,      ///< by an angle that grows in each tick: the sequence is a whole turn
  };
  Kind kind = kFixed;
  std::uint8_t frame = 0;             ///< kFixed: the one that is shown
  std::uint32_t ticks_per_frame = 1;  ///< clocks: 1 … kMaxTicksPerFrame
  std::uint32_t start = 0;            ///< clocks: the tick with which the first one begins
  std::uint32_t angle = 0;            ///< kAngle: at tick 0; 2^32 are a turn
  std::int32_t spin = 0;              ///< kAngle: what a tick adds to it

  static Selector fixed(std::size_t frame);
  /// `first` is shown from `tick` on, for a whole `ticks_per_frame`.
  static Selector clock(std::uint32_t tick, std::uint32_t ticks_per_frame, bool loop = true,
                        std::size_t first = 0);
  /// The angle is `angle` at `tick`. Frame k of n is shown around k/n of a turn. A picture that looks the
  /// same after 1/m of a turn shows its sequence m times in a turn: m · angle, m · spin, modulo 2^32.
  static Selector turning(std::uint32_t tick, std::uint32_t angle, std::int32_t spin);

  /// The one of `frames` (at least 1) that is shown at `tick`.
  std::size_t at(std::uint32_t tick, std::size_t frames) const;
  /// kAngle: the angle at `tick`.
  std::uint32_t angleAt(std::uint32_t tick) const;

  /// Does it select among so many frames? A single one is always kFixed.
  bool fits(std::size_t frames) const;
  /// Clocks: ticks since `start` at `tick`, without whole rounds, or once the last frame is shown as few as
  /// show it. Below frames · ticks_per_frame.
  std::uint32_t age(std::uint32_t tick, std::size_t frames) const;
  /// The same from `tick` on, counted from the latest start that shows it so.
  Selector rebased(std::uint32_t tick, std::size_t frames) const;
  /// May it be sent at `tick`? It fits, and its age is no more than age() gives: one meaning, one spelling.
  bool isCanonical(std::uint32_t tick, std::size_t frames) const {
    return fits(frames) && *this == rebased(tick, frames);
  }

  friend bool operator==(const Selector&, const Selector&) = default;
};

}  // namespace naiad

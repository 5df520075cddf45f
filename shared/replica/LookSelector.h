// Selects the appearance of a sequence as a function of the tick that server and client share.
//
// So animation and rotation need no traffic, because both ends count ticks.
#pragma once

#include <cstddef>
#include <cstdint>

namespace naiad {

/// Maximum number of appearances of a sequence.
inline constexpr std::size_t kMaxFrames = 256;
/// Maximum number of ticks for which a clock shows one appearance.
inline constexpr std::uint32_t kMaxTicksPerFrame = 1u << 16;

/// Made by the functions below. Fields that a kind does not use are 0 (ticks_per_frame: 1).
struct Selector {
  enum Kind : std::uint8_t {
    kFixed,      ///< always the same appearance
    kClock,      ///< one appearance after the other, looping
    kClockOnce,  ///< one appearance after the other; the last one stays
    kAngle,      ///< chosen by an angle that changes each tick; the sequence is a whole turn
  };
  Kind kind = kFixed;
  std::uint8_t frame = 0;             ///< kFixed: index of the shown appearance
  std::uint32_t ticks_per_frame = 1;  ///< clocks: 1 … kMaxTicksPerFrame
  std::uint32_t start = 0;            ///< clocks: the tick at which the first appearance begins
  std::uint32_t angle = 0;            ///< kAngle: angle at tick 0; 2^32 is a turn
  std::int32_t spin = 0;              ///< kAngle: change of the angle per tick

  static Selector fixed(std::size_t frame);
  /// Makes a clock that shows `first` from `tick` on, for a whole `ticks_per_frame`.
  static Selector clock(std::uint32_t tick, std::uint32_t ticks_per_frame, bool loop = true,
                        std::size_t first = 0);
  /// Makes a selector whose angle at `tick` is `angle`. Frame k of n is shown around k/n of a turn. For a
  /// picture that looks alike after 1/m of a turn, pass m · angle and m · spin, modulo 2^32.
  static Selector turning(std::uint32_t tick, std::uint32_t angle, std::int32_t spin);

  /// Returns the index, among `frames` (at least 1), that is shown at `tick`.
  std::size_t at(std::uint32_t tick, std::size_t frames) const;
  /// Returns the angle at `tick`; only for kAngle.
  std::uint32_t angleAt(std::uint32_t tick) const;

  /// True if the selector is valid for this many frames. For fewer than two frames, only kFixed is.
  bool fits(std::size_t frames) const;
  /// Returns the ticks from `start` to `tick`; only for clocks. If the clock loops, modulo
  /// frames · ticks_per_frame; else limited to 0 … (frames − 1) · ticks_per_frame.
  std::uint32_t age(std::uint32_t tick, std::size_t frames) const;
  /// Returns a selector that shows the same frames from `tick` on, with the latest possible start.
  Selector rebased(std::uint32_t tick, std::size_t frames) const;
  /// True if it may be sent at `tick`: it is valid with its latest start, so each meaning has one encoding.
  bool isCanonical(std::uint32_t tick, std::size_t frames) const {
    return fits(frames) && *this == rebased(tick, frames);
  }

  friend bool operator==(const Selector&, const Selector&) = default;
};

}  // namespace naiad

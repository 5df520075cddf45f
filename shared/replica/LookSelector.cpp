#include "shared/replica/LookSelector.h"

#include <algorithm>

namespace naiad {

Selector Selector::fixed(std::size_t frame) {
  Selector selector;
  selector.frame = static_cast<std::uint8_t>(frame);
  return selector;
}

Selector Selector::clock(std::uint32_t tick, std::uint32_t ticks_per_frame, bool loop, std::size_t first) {
  Selector selector;
  selector.kind = loop ? kClock : kClockOnce;
  selector.ticks_per_frame = ticks_per_frame;
  selector.start = tick - static_cast<std::uint32_t>(first) * ticks_per_frame;
  return selector;
}

Selector Selector::turning(std::uint32_t tick, std::uint32_t angle, std::int32_t spin) {
  Selector selector;
  selector.kind = kAngle;
  selector.angle = angle - static_cast<std::uint32_t>(spin) * tick;
  selector.spin = spin;
  return selector;
}

// Angles of 32 bits wrap after a turn, and so does the product with a tick that wraps: the angle never jumps.
std::uint32_t Selector::angleAt(std::uint32_t tick) const {
  return angle + static_cast<std::uint32_t>(spin) * tick;
}

std::size_t Selector::at(std::uint32_t tick, std::size_t frames) const {
  switch (kind) {
    case kClock:
    case kClockOnce:
      return age(tick, frames) / ticks_per_frame;
    case kAngle: {
      const auto half = static_cast<std::uint32_t>((std::uint64_t{1} << 31) / frames);
      return static_cast<std::size_t>((std::uint64_t{angleAt(tick) + half} * frames) >> 32);
    }
    default:
      return std::min<std::size_t>(frame, frames - 1);
  }
}

bool Selector::fits(std::size_t frames) const {
  if (kind == kFixed) return frame < std::max<std::size_t>(frames, 1);
  return frames > 1 && frames <= kMaxFrames && ticks_per_frame >= 1 && ticks_per_frame <= kMaxTicksPerFrame;
}

std::uint32_t Selector::age(std::uint32_t tick, std::size_t frames) const {
  const std::int64_t since = static_cast<std::int32_t>(tick - start);
  const std::int64_t count = static_cast<std::int64_t>(frames);
  if (kind == kClockOnce) {
    return static_cast<std::uint32_t>(
        std::clamp<std::int64_t>(since, 0, (count - 1) * std::int64_t{ticks_per_frame}));
  }
  const std::int64_t round = count * ticks_per_frame;
  const std::int64_t rest = since % round;
  return static_cast<std::uint32_t>(rest < 0 ? rest + round : rest);
}

Selector Selector::rebased(std::uint32_t tick, std::size_t frames) const {
  Selector selector = *this;
  if (kind == kClock || kind == kClockOnce) selector.start = tick - age(tick, frames);
  return selector;
}

}  // namespace naiad

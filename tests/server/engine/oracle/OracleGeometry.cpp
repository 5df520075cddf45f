#include "OracleGeometry.h"

#include <algorithm>
#include <array>

namespace oracle {

__extension__ typedef unsigned __int128 WideUnsigned;

static constexpr Time kNever{2, 1};

bool operator<(Time a, Time b) {
  return static_cast<WideUnsigned>(a.numerator) * b.denominator <
         static_cast<WideUnsigned>(b.numerator) * a.denominator;
}

// Functions for one axis.

namespace {

/// One coordinate of a path, which advances `length` units one by one.
struct Axis {
  Wide from;
  Wide to;

  bool isForward() const { return to >= from; }
  std::uint64_t length() const { return static_cast<std::uint64_t>(isForward() ? to - from : from - to); }
  Wide after(std::uint64_t units) const { return isForward() ? from + units : from - units; }
  /// Returns the whole units covered at `time`.
  std::uint64_t gone(Time time) const {
    return static_cast<std::uint64_t>(static_cast<WideUnsigned>(length()) * time.numerator /
                                      time.denominator);
  }
  /// Returns the whole units covered at the last moment before `time`.
  std::uint64_t goneBefore(Time time) const {
    const WideUnsigned product = static_cast<WideUnsigned>(length()) * time.numerator;
    const WideUnsigned rounded_up = (product + time.denominator - 1) / time.denominator;
    return rounded_up == 0 ? 0 : static_cast<std::uint64_t>(rounded_up - 1);
  }
};

/// The times from `begin`, included, to `end`, excluded.
struct Span {
  Time begin;
  Time end;
};

/// Returns when an interval of this `size`, whose low end moves along `axis`, touches the interval from `low`
/// to `high`.
std::optional<Span> touchingSpan(const Axis& axis, Wide size, Wide low, Wide high) {
  // Units after which the contact begins, and the last unit at which it lasts.
  const Wide first = axis.isForward() ? low - (axis.from + size) : axis.from - high;
  const Wide last = axis.isForward() ? high - axis.from : axis.from + size - low;
  const auto length = axis.length();
  if (last < 0 || first > length) return std::nullopt;
  if (length == 0) return Span{{0, 1}, kNever};
  return Span{{static_cast<std::uint64_t>(std::max<Wide>(first, 0)), length},
              {static_cast<std::uint64_t>(last + 1), length}};
}

/// Returns the next time after `time` at which a coordinate enters another cell, ⌊coordinate⌋.
Time nextCell(const Axis& axis, Time time) {
  if (axis.length() == 0) return kNever;
  const std::uint64_t gone = axis.gone(time);
  const Wide one = df::kFixedOne;
  const Wide into_cell = ((axis.after(gone) % one) + one) % one;
  const Wide next = gone + (axis.isForward() ? one - into_cell : into_cell + 1);
  if (next > axis.length()) return kNever;
  return {static_cast<std::uint64_t>(next), axis.length()};
}

}  // namespace

// Functions for both axes.

FixedVector SweepPath::at(Time time) const {
  const Axis x{from.x, to.x};
  const Axis y{from.y, to.y};
  return {static_cast<Fixed>(x.after(x.gone(time))), static_cast<Fixed>(y.after(y.gone(time)))};
}

FixedVector SweepPath::before(Time time) const {
  const Axis x{from.x, to.x};
  const Axis y{from.y, to.y};
  return {static_cast<Fixed>(x.after(x.goneBefore(time))), static_cast<Fixed>(y.after(y.goneBefore(time)))};
}

/// Returns how far `a` has to move right, left, down and up to touch the other box on that axis; negative if
/// `a` already reaches past that edge.
static std::array<Wide, 4> distances(const FixedBox& a, const FixedBox& b) {
  return {Wide{b.corner.x} - (a.corner.x + a.size.x), Wide{a.corner.x} - (b.corner.x + b.size.x),
          Wide{b.corner.y} - (a.corner.y + a.size.y), Wide{a.corner.y} - (b.corner.y + b.size.y)};
}

Wide gap(const FixedBox& a, const FixedBox& b) {
  const auto sides = distances(a, b);
  return *std::max_element(sides.begin(), sides.end());
}

bool closesGap(const FixedBox& box, const SweepPath& path, const FixedBox& other) {
  const Wide right = Wide{path.to.x} - path.from.x;
  const Wide down = Wide{path.to.y} - path.from.y;
  const std::array<Wide, 4> approaches{right, -right, down, -down};
  const FixedBox at_start = translate(box, path.from);
  const auto sides = distances(at_start, other);
  for (std::size_t i = 0; i < sides.size(); ++i) {
    if (sides[i] == gap(at_start, other) && approaches[i] <= 0) return false;
  }
  return true;
}

static std::optional<Span> touchingSpan(const SweepPath& path, const FixedBox& box, const FixedBox& other) {
  const Axis left{Wide{path.from.x} + box.corner.x, Wide{path.to.x} + box.corner.x};
  const Axis top{Wide{path.from.y} + box.corner.y, Wide{path.to.y} + box.corner.y};
  const auto x = touchingSpan(left, box.size.x, other.corner.x, Wide{other.corner.x} + other.size.x);
  const auto y = touchingSpan(top, box.size.y, other.corner.y, Wide{other.corner.y} + other.size.y);
  if (!x || !y) return std::nullopt;
  const Span both{std::max(x->begin, y->begin), std::min(x->end, y->end)};
  return both.begin < both.end ? std::optional(both) : std::nullopt;
}

std::optional<Time> firstTouch(const SweepPath& path, const FixedBox& box, const FixedBox& other) {
  const auto span = touchingSpan(path, box, other);
  if (!span) return std::nullopt;
  const bool at_start = span->begin.numerator == 0;
  const bool at_end = boxIntersectsBox(translate(box, path.to), other);
  if (at_start && !closesGap(box, path, other) && !at_end) return std::nullopt;
  return span->begin;
}

std::optional<Time> firstShare(const SweepPath& path, const FixedBox& box, const Mask& mask,
                               const FixedBox& other, const Mask& others_mask) {
  const auto span = touchingSpan(path, box, other);
  if (!span) return std::nullopt;
  const auto share = [&](FixedVector position) {
    return shareCell(translate(box, position), mask, other, others_mask);
  };
  const Axis left{Wide{path.from.x} + box.corner.x, Wide{path.to.x} + box.corner.x};
  const Axis top{Wide{path.from.y} + box.corner.y, Wide{path.to.y} + box.corner.y};

  bool apart = true;
  if (span->begin.numerator == 0 && share(path.from)) {
    const bool at_end = boxIntersectsBox(translate(box, path.to), other) && share(path.to);
    if (closesGap(box, path, other) || at_end) return span->begin;
    apart = false;
  }
  // The shared cells change only when the corner of the moving box enters another cell.
  for (Time time = span->begin; time < span->end && time < kNever;
       time = std::min(nextCell(left, time), nextCell(top, time))) {
    const bool shares = share(path.at(time));
    if (shares && apart) return time;
    if (!shares) apart = true;
  }
  return std::nullopt;
}

}  // namespace oracle

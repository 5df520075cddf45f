#include "engine/collision/Sweep.h"

#include <algorithm>

#include "engine/collision/Mask.h"

namespace df {

namespace {

__extension__ typedef __int128 Wide;
__extension__ typedef unsigned __int128 WideUnsigned;

// Returns a − b for a >= b: the difference of two coordinates may be too large for a signed number.
std::uint64_t distance(Fixed a, Fixed b) {
  return static_cast<std::uint64_t>(a) - static_cast<std::uint64_t>(b);
}

WideUnsigned multiply(std::uint64_t a, std::uint64_t b) {
  return static_cast<WideUnsigned>(a) * b;
}

// Returns the least corner coordinate with which the mask's first character is in this cell (⌊corner⌋ + 1).
Fixed lowOfCell(std::int64_t cell) {
  return (cell - 1) * kFixedOne;
}

// Range of cells of the first character, on one axis, in which the comparison of masks cannot change, because
// one mask is full and the other lies wholly inside it.
struct Still {
  std::int64_t first = 0;
  std::int64_t last = -1;

  Still(bool is_own_full, std::int64_t own_length, bool is_other_full, std::int64_t cell,
        std::int64_t length) {
    if (is_own_full == is_other_full) return;
    first = is_other_full ? cell : cell + length - own_length;
    last = is_other_full ? cell + length - own_length : cell;
  }
  std::int64_t next(std::int64_t cell, int direction) const {
    if (cell < first || cell > last) return cell + direction;
    return direction > 0 ? last + 1 : first - 1;
  }
};

}  // namespace

std::strong_ordering operator<=>(Moment a, Moment b) {
  if (a.denominator == b.denominator) return a.numerator <=> b.numerator;
  const WideUnsigned left = multiply(a.numerator, b.denominator);
  const WideUnsigned right = multiply(b.numerator, a.denominator);
  if (left == right) return std::strong_ordering::equal;
  return left < right ? std::strong_ordering::less : std::strong_ordering::greater;
}

// The gap of two boxes: on one axis, or the larger one of both axes.
struct Sweep::Gap {
  Wide size;
  bool shrinks;  // true if it shrinks as soon as the move begins

  static Gap ofPair(const Gap& x, const Gap& y) {
    if (x.size == y.size) return {x.size, x.shrinks && y.shrinks};
    return x.size > y.size ? x : y;
  }
};

Sweep::Sweep(const FixedBox& box, FixedVector from, FixedVector to) : m_from(from) {
  const auto axis = [](Fixed corner, Fixed size, Fixed start, Fixed end) -> Axis {
    const auto [least, most] = std::minmax(start, end);
    return {start + corner,      size, distance(most, least), (end > start) - (end < start), least + corner,
            most + corner + size};
  };
  m_x = axis(box.corner.x, box.size.x, from.x, to.x);
  m_y = axis(box.corner.y, box.size.y, from.y, to.y);
}

// Returns the steps at which the low edge lies within [first, last], which the move reaches.
Sweep::Stay Sweep::Axis::stayWithin(Fixed first, Fixed last) const {
  if (direction >= 0) return {low < first ? distance(first, low) : 0, distance(last, low) + 1};
  return {low > last ? distance(low, last) : 0, distance(low, first) + 1};
}

// True if the low edge is within [first, last] at any time of the move.
bool Sweep::Axis::reaches(Fixed first, Fixed last) const {
  return path_low <= last && path_high - size >= first;
}

Fixed Sweep::Axis::lowAfter(std::uint64_t steps) const {
  const auto start = static_cast<std::uint64_t>(low);
  return static_cast<Fixed>(direction < 0 ? start - steps : start + steps);
}

std::uint64_t Sweep::Axis::stepsBy(Moment moment) const {
  if (moment.numerator == 0) return 0;
  if (moment.denominator == length) return moment.numerator;
  return static_cast<std::uint64_t>(multiply(length, moment.numerator) / moment.denominator);
}

std::uint64_t Sweep::Axis::stepsBefore(Moment moment) const {
  if (length == 0 || moment.numerator == 0) return 0;
  if (moment.numerator > moment.denominator) return length;
  if (moment.denominator == length) return moment.numerator - 1;
  // ⌈a/b⌉ − 1 is ⌊(a − 1)/b⌋.
  return static_cast<std::uint64_t>((multiply(length, moment.numerator) - 1) / moment.denominator);
}

// Returns the number of steps until the mask's first character is drawn in `cell`, which lies ahead of the
// character. Returns UINT64_MAX if the axis does not move.
std::uint64_t Sweep::Axis::stepsToCell(std::int64_t cell) const {
  if (direction > 0) return distance(lowOfCell(cell), low);
  if (direction < 0) return distance(low, lowOfCell(cell + 1) - 1);
  return UINT64_MAX;
}

Sweep::Gap Sweep::Axis::gapTo(Fixed low_then, Fixed other_low, Fixed other_size) const {
  const Wide ahead = static_cast<Wide>(other_low) - low_then - size;
  const Wide behind = static_cast<Wide>(low_then) - other_low - other_size;
  if (ahead > behind) return {ahead, direction > 0};
  return {behind, behind > ahead && direction < 0};
}

// Returns the first time at which both axes are in their ranges, except at the start. An axis without
// movement is not special: both products with its length are 0; the other axis leaves at one above 0.
std::optional<Moment> Sweep::bothWithin(const Stay& x, const Stay& y) const {
  const WideUnsigned enter_x = multiply(x.enter, m_y.length);
  const WideUnsigned enter_y = multiply(y.enter, m_x.length);
  if (x.enter != 0 && enter_x >= enter_y) {
    if (enter_x >= multiply(y.leave, m_x.length)) return std::nullopt;
    return Moment{x.enter, m_x.length};
  }
  if (enter_y >= multiply(x.leave, m_y.length)) return std::nullopt;
  return Moment{y.enter, m_y.length};
}

std::optional<Moment> Sweep::touchOnPath(const FixedBox& other) const {
  const Stay x = m_x.stayWithin(other.corner.x - m_x.size, other.corner.x + other.size.x);
  const Stay y = m_y.stayWithin(other.corner.y - m_y.size, other.corner.y + other.size.y);
  if ((x.enter | y.enter) != 0) return bothWithin(x, y);
  if (endsWithin(x, y) || closesGap(other)) return Moment{};
  return std::nullopt;
}

std::optional<Moment> Sweep::firstShare(const Mask* p_own, const FixedBox& other,
                                        const Mask* p_others) const {
  if (!mayTouch(other)) return std::nullopt;
  const FixedVector size = {m_x.size, m_y.size};
  const CellBox own = drawnCells(p_own, {{m_x.low, m_y.low}, size});
  const CellBox cells = drawnCells(p_others, other);

  // Range of the low edge in which the boxes touch and the masks' rectangles overlap, so that there are cells
  // to compare. It is never empty, because equal corners mean equal first cells.
  const Fixed first_x = std::max(other.corner.x - size.x, lowOfCell(cells.x - own.width + 1));
  const Fixed first_y = std::max(other.corner.y - size.y, lowOfCell(cells.y - own.height + 1));
  const Fixed last_x = std::min(other.corner.x + other.size.x, lowOfCell(cells.x + cells.width) - 1);
  const Fixed last_y = std::min(other.corner.y + other.size.y, lowOfCell(cells.y + cells.height) - 1);
  if (!m_x.reaches(first_x, last_x) || !m_y.reaches(first_y, last_y)) return std::nullopt;
  const Stay x = m_x.stayWithin(first_x, last_x);
  const Stay y = m_y.stayWithin(first_y, last_y);
  const bool is_at_start = (x.enter | y.enter) == 0;
  const std::optional<Moment> enter = is_at_start ? Moment{} : bothWithin(x, y);
  if (!enter) return std::nullopt;

  const auto share = [&](std::int64_t cell_x, std::int64_t cell_y) {
    return shareCell(p_own, {{lowOfCell(cell_x), lowOfCell(cell_y)}, size}, p_others, other);
  };
  const auto cellAfter = [](const Axis& axis, std::uint64_t steps) {
    return (axis.lowAfter(steps) >> kFixedBits) + 1;
  };
  std::int64_t cell_x = cellAfter(m_x, m_x.stepsBy(*enter));
  std::int64_t cell_y = cellAfter(m_y, m_y.stepsBy(*enter));
  bool shares = share(cell_x, cell_y);
  if (shares && !is_at_start) return enter;
  if (shares) {
    if (closesGap(other)) return enter;
    if (endsWithin(x, y) && share(cellAfter(m_x, m_x.length), cellAfter(m_y, m_y.length))) return enter;
  }
  if (p_own == nullptr && p_others == nullptr) return std::nullopt;  // full masks share cells without a break

  // Visits one cell of the first character after another, in the order of time.
  const Still still_x(p_own == nullptr, own.width, p_others == nullptr, cells.x, cells.width);
  const Still still_y(p_own == nullptr, own.height, p_others == nullptr, cells.y, cells.height);
  for (;;) {
    const std::int64_t next_x = still_x.next(cell_x, m_x.direction);
    const std::int64_t next_y = still_y.next(cell_y, m_y.direction);
    const Moment at_x = {m_x.stepsToCell(next_x), m_x.length};
    const Moment at_y = {m_y.stepsToCell(next_y), m_y.length};
    const bool reaches_x = at_x.numerator <= m_x.length;
    const bool reaches_y = at_y.numerator <= m_y.length;
    if (!reaches_x && !reaches_y) return std::nullopt;
    const bool moves_x = reaches_x && (!reaches_y || at_x <= at_y);
    const bool moves_y = reaches_y && (!reaches_x || at_y <= at_x);
    const Moment now = moves_x ? at_x : at_y;
    if (multiply(now.numerator, m_x.length) >= multiply(x.leave, now.denominator)) return std::nullopt;
    if (multiply(now.numerator, m_y.length) >= multiply(y.leave, now.denominator)) return std::nullopt;
    if (moves_x) cell_x = next_x;
    if (moves_y) cell_y = next_y;
    const bool shared = shares;
    shares = share(cell_x, cell_y);
    if (shares && !shared) return now;
  }
}

FixedVector Sweep::before(Moment moment) const {
  const auto coordinate = [moment](const Axis& axis, Fixed from) {
    const std::uint64_t steps = axis.stepsBefore(moment);
    const auto start = static_cast<std::uint64_t>(from);
    return static_cast<Fixed>(axis.direction < 0 ? start - steps : start + steps);
  };
  return {coordinate(m_x, m_from.x), coordinate(m_y, m_from.y)};
}

bool Sweep::closesGap(const FixedBox& other) const {
  return Gap::ofPair(m_x.gapTo(m_x.low, other.corner.x, other.size.x),
                     m_y.gapTo(m_y.low, other.corner.y, other.size.y))
      .shrinks;
}

bool Sweep::movesOutOf(const FixedBox& other) const {
  const auto gapAfter = [&](std::uint64_t steps_x, std::uint64_t steps_y) {
    return Gap::ofPair(m_x.gapTo(m_x.lowAfter(steps_x), other.corner.x, other.size.x),
                       m_y.gapTo(m_y.lowAfter(steps_y), other.corner.y, other.size.y))
        .size;
  };
  const Wide at_start = gapAfter(0, 0);
  return at_start <= 0 && gapAfter(m_x.length, m_y.length) > at_start;
}

}  // namespace df

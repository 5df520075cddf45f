// Plain reference implementations for Sweep: they test every step of the lattice and every cell of the masks.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/collision/Mask.h"
#include "engine/collision/Sweep.h"

namespace df::test {

__extension__ typedef __int128 Wide;
__extension__ typedef unsigned __int128 WideUnsigned;

inline constexpr Fixed kFar = 2000000000 * kFixedOne;

inline FixedVector cells(double x, double y) {
  return {*toFixed(x), *toFixed(y)};
}

struct Move {
  FixedBox box;  // relative to the position
  FixedVector from;
  FixedVector to;

  Sweep sweep() const { return {box, from, to}; }
  FixedBox at(FixedVector position) const { return translate(box, position); }
};

struct Masks {
  const Mask* p_own = nullptr;
  const Mask* p_others = nullptr;
};

// A position on the path, which the mover reaches at `time`.
struct Visit {
  Moment time;
  FixedVector position;
};

inline std::uint64_t magnitude(Fixed from, Fixed to) {
  return from < to ? static_cast<std::uint64_t>(to) - static_cast<std::uint64_t>(from)
                   : static_cast<std::uint64_t>(from) - static_cast<std::uint64_t>(to);
}

inline Fixed advance(Fixed from, Fixed to, std::uint64_t steps) {
  const auto start = static_cast<std::uint64_t>(from);
  return static_cast<Fixed>(from < to ? start + steps : start - steps);
}

// Returns all positions of a short move, one by one.
inline std::vector<Visit> everyVisit(const Move& move) {
  const auto way_x = static_cast<Wide>(magnitude(move.from.x, move.to.x));
  const auto way_y = static_cast<Wide>(magnitude(move.from.y, move.to.y));
  std::vector<Visit> visits = {{{0, 1}, move.from}};
  for (Wide x = 0, y = 0; x < way_x || y < way_y;) {
    const bool is_x = x < way_x && (y == way_y || (x + 1) * way_y <= (y + 1) * way_x);
    const bool is_y = y < way_y && (x == way_x || (y + 1) * way_x <= (x + 1) * way_y);
    x += is_x ? 1 : 0;
    y += is_y ? 1 : 0;
    const Moment time = is_x ? Moment{static_cast<std::uint64_t>(x), static_cast<std::uint64_t>(way_x)}
                             : Moment{static_cast<std::uint64_t>(y), static_cast<std::uint64_t>(way_y)};
    visits.push_back({time,
                      {advance(move.from.x, move.to.x, static_cast<std::uint64_t>(x)),
                       advance(move.from.y, move.to.y, static_cast<std::uint64_t>(y))}});
  }
  return visits;
}

// Returns the positions of a long move at which something may change: whether the boxes touch and, if
// `at_cells`, the cell of the mover's corner. Use `at_cells` only for moves of at most a few hundred cells.
inline std::vector<Visit> tellingVisits(const Move& move, const FixedBox& other, bool at_cells) {
  const auto stepsOf = [at_cells](Fixed from, Fixed to, Fixed corner, Fixed size, Fixed low,
                                  Fixed other_size) {
    std::vector<Fixed> marks = {low - size - 1, low - size, low + other_size, low + other_size + 1};
    const Fixed least = std::min(from, to) + corner;
    const Fixed most = std::max(from, to) + corner;
    for (Fixed mark = (least >> kFixedBits) * kFixedOne; at_cells && mark <= most; mark += kFixedOne) {
      marks.push_back(mark);
      marks.push_back(mark - 1);
    }
    std::vector<std::uint64_t> steps = {0};
    for (const Fixed mark : marks) {
      if (mark >= least && mark <= most) steps.push_back(magnitude(from + corner, mark));
    }
    return steps;
  };
  const std::uint64_t way_x = magnitude(move.from.x, move.to.x);
  const std::uint64_t way_y = magnitude(move.from.y, move.to.y);
  std::vector<Moment> times;
  for (const std::uint64_t steps :
       stepsOf(move.from.x, move.to.x, move.box.corner.x, move.box.size.x, other.corner.x, other.size.x)) {
    times.push_back({steps, std::max<std::uint64_t>(1, way_x)});
  }
  for (const std::uint64_t steps :
       stepsOf(move.from.y, move.to.y, move.box.corner.y, move.box.size.y, other.corner.y, other.size.y)) {
    times.push_back({steps, std::max<std::uint64_t>(1, way_y)});
  }
  const auto isEarlier = [](Moment a, Moment b) {
    return static_cast<WideUnsigned>(a.numerator) * b.denominator <
           static_cast<WideUnsigned>(b.numerator) * a.denominator;
  };
  std::stable_sort(times.begin(), times.end(), isEarlier);
  std::vector<Visit> visits;
  for (const Moment time : times) {
    const auto along = [time](std::uint64_t length) {
      return static_cast<std::uint64_t>(static_cast<WideUnsigned>(length) * time.numerator /
                                        time.denominator);
    };
    visits.push_back(
        {time,
         {advance(move.from.x, move.to.x, along(way_x)), advance(move.from.y, move.to.y, along(way_y))}});
  }
  visits.push_back({{1, 1}, move.to});
  return visits;
}

inline bool sharePlainly(Masks masks, const FixedBox& a, const FixedBox& b) {
  struct Drawn {
    Fixed x, y, width, height;
    const Mask* p_mask;
    bool isSet(Fixed cell_x, Fixed cell_y) const {
      if (cell_x < x || cell_y < y || cell_x >= x + width || cell_y >= y + height) return false;
      return p_mask == nullptr || p_mask->isSet(static_cast<int>(cell_x - x), static_cast<int>(cell_y - y));
    }
  };
  const auto drawn = [](const Mask* p_mask, const FixedBox& box) -> Drawn {
    const Fixed x = (box.corner.x >> kFixedBits) + 1;
    const Fixed y = (box.corner.y >> kFixedBits) + 1;
    if (p_mask != nullptr) return {x, y, p_mask->width(), p_mask->height(), p_mask};
    const auto roundUp = [](Fixed size) {
      const Fixed whole = size / kFixedOne + (size % kFixedOne != 0 ? 1 : 0);
      return std::max<Fixed>(1, whole);
    };
    return {x, y, roundUp(box.size.x), roundUp(box.size.y), nullptr};
  };
  const Drawn in_a = drawn(masks.p_own, a);
  const Drawn in_b = drawn(masks.p_others, b);
  for (Fixed y = in_a.y; y < in_a.y + in_a.height; ++y) {
    for (Fixed x = in_a.x; x < in_a.x + in_a.width; ++x) {
      if (in_a.isSet(x, y) && in_b.isSet(x, y)) return true;
    }
  }
  return false;
}

// Returns `scale` times the gap of a pair after the mover is displaced by (dx,dy)/scale.
inline Wide gapOf(const FixedBox& a, const FixedBox& b, Wide scale = 1, Wide dx = 0, Wide dy = 0) {
  const auto onAxis = [scale](Fixed own, Fixed own_size, Fixed other, Fixed other_size, Wide d) {
    const Wide low = own * scale + d;
    const Wide high = low + own_size * scale;
    const Wide other_low = other * scale;
    const Wide other_high = other_low + other_size * scale;
    return std::max(other_low - high, low - other_high);
  };
  return std::max(onAxis(a.corner.x, a.size.x, b.corner.x, b.size.x, dx),
                  onAxis(a.corner.y, a.size.y, b.corner.y, b.size.y, dy));
}

// Compares the gaps at the start and after a very short part of the move. Gaps are whole units, and the
// displacement is less than half a unit, so the axis with the larger gap cannot change.
inline bool closesPlainly(const Move& move, const FixedBox& other) {
  const Wide dx = static_cast<Wide>(move.to.x) - move.from.x;
  const Wide dy = static_cast<Wide>(move.to.y) - move.from.y;
  const Wide longest = std::max(dx < 0 ? -dx : dx, dy < 0 ? -dy : dy);
  const Wide scale = 2 * longest + 1;
  return gapOf(move.at(move.from), other, scale, dx, dy) < gapOf(move.at(move.from), other, scale);
}

// Returns the first time at which `meets` is true. At the start it counts only by the rule of firstTouch().
// `may_meet_again` is for masks.
template <typename Meets>
inline std::optional<Moment> firstPlainly(const Move& move, const FixedBox& other,
                                          const std::vector<Visit>& visits, bool may_meet_again,
                                          Meets meets) {
  bool met = meets(move.from);
  if (met) {
    if (closesPlainly(move, other) || meets(move.to)) return Moment{};
    if (!may_meet_again) return std::nullopt;
  }
  for (const Visit& visit : visits) {
    const bool meets_now = meets(visit.position);
    if (meets_now && !met) return visit.time;
    met = meets_now;
  }
  return std::nullopt;
}

inline std::optional<Moment> touchPlainly(const Move& move, const FixedBox& other,
                                          const std::vector<Visit>& visits) {
  return firstPlainly(move, other, visits, false,
                      [&](FixedVector position) { return intersects(move.at(position), other); });
}

inline std::optional<Moment> sharePlainly(const Move& move, Masks masks, const FixedBox& other,
                                          const std::vector<Visit>& visits) {
  return firstPlainly(move, other, visits, true, [&](FixedVector position) {
    return intersects(move.at(position), other) && sharePlainly(masks, move.at(position), other);
  });
}

}  // namespace df::test

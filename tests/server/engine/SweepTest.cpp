#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "Mask.h"
#include "SplitMix64.h"
#include "Sweep.h"

namespace df::test {
namespace {

__extension__ typedef __int128 Wide;
__extension__ typedef unsigned __int128 WideUnsigned;

constexpr Fixed kFar = 2000000000 * kFixedOne;

FixedVector cells(double x, double y) {
  return {*toFixed(x), *toFixed(y)};
}

// ---- The plain answers: every step of the lattice, every cell of the masks.

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

// From `time` on, the mover is at `position`.
struct Visit {
  Moment time;
  FixedVector position;
};

std::uint64_t magnitude(Fixed from, Fixed to) {
  return from < to ? static_cast<std::uint64_t>(to) - static_cast<std::uint64_t>(from)
                   : static_cast<std::uint64_t>(from) - static_cast<std::uint64_t>(to);
}

Fixed goOn(Fixed from, Fixed to, std::uint64_t steps) {
  const auto start = static_cast<std::uint64_t>(from);
  return static_cast<Fixed>(from < to ? start + steps : start - steps);
}

// All positions of a short move, one by one.
std::vector<Visit> everyVisit(const Move& move) {
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
                      {goOn(move.from.x, move.to.x, static_cast<std::uint64_t>(x)),
                       goOn(move.from.y, move.to.y, static_cast<std::uint64_t>(y))}});
  }
  return visits;
}

// The positions of a long move at which something may change: whether the boxes touch and, if asked for, a
// cell of the mover's corner (not of a move over more than some hundred cells, please).
std::vector<Visit> tellingVisits(const Move& move, const FixedBox& other, bool at_cells) {
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
    const auto along = [time](std::uint64_t way) {
      return static_cast<std::uint64_t>(static_cast<WideUnsigned>(way) * time.numerator / time.denominator);
    };
    visits.push_back(
        {time, {goOn(move.from.x, move.to.x, along(way_x)), goOn(move.from.y, move.to.y, along(way_y))}});
  }
  visits.push_back({{1, 1}, move.to});
  return visits;
}

bool sharePlainly(Masks masks, const FixedBox& a, const FixedBox& b) {
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

// The gap of a pair, times `scale`, with the mover displaced by further (dx,dy)/scale.
Wide gapOf(const FixedBox& a, const FixedBox& b, Wide scale = 1, Wide dx = 0, Wide dy = 0) {
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

// So short a time of the move that no other side of the boxes can become the one that counts: gaps are whole
// units, and those that are not the largest are at least one less.
bool closesPlainly(const Move& move, const FixedBox& other) {
  const Wide dx = static_cast<Wide>(move.to.x) - move.from.x;
  const Wide dy = static_cast<Wide>(move.to.y) - move.from.y;
  const Wide longest = std::max(dx < 0 ? -dx : dx, dy < 0 ? -dy : dy);
  const Wide scale = 2 * longest + 1;
  return gapOf(move.at(move.from), other, scale, dx, dy) < gapOf(move.at(move.from), other, scale);
}

// The rule of the start and the first time, for any predicate. `may_meet_again` is for the masks.
template <typename Meets>
std::optional<Moment> firstPlainly(const Move& move, const FixedBox& other, const std::vector<Visit>& visits,
                                   bool may_meet_again, Meets meets) {
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

std::optional<Moment> touchPlainly(const Move& move, const FixedBox& other,
                                   const std::vector<Visit>& visits) {
  return firstPlainly(move, other, visits, false,
                      [&](FixedVector position) { return intersects(move.at(position), other); });
}

std::optional<Moment> sharePlainly(const Move& move, Masks masks, const FixedBox& other,
                                   const std::vector<Visit>& visits) {
  return firstPlainly(move, other, visits, true, [&](FixedVector position) {
    return intersects(move.at(position), other) && sharePlainly(masks, move.at(position), other);
  });
}

// ---- Random cases against the plain answers.

class RandomSweeps : public testing::Test {
 protected:
  Fixed number(Fixed below) { return static_cast<Fixed>(random.below(static_cast<std::uint64_t>(below))); }
  Fixed between(Fixed least, Fixed most) {
    const std::uint64_t offset = random.below(magnitude(least, most) + 1);
    return static_cast<Fixed>(static_cast<std::uint64_t>(least) + offset);
  }
  // Straight moves and none at all are worth their own share.
  FixedVector displacement(Fixed most) {
    const Fixed kind = number(8);
    return {kind == 0 ? 0 : between(-most, most), kind == 1 ? 0 : between(-most, most)};
  }
  FixedVector anywhere() {
    static constexpr std::array<Fixed, 5> kPlaces = {0, -kFar + 1000, kFar - 1000, kFixedOne, -3 * kFixedOne};
    return {kPlaces[random.below(kPlaces.size())], kPlaces[random.below(kPlaces.size())]};
  }
  Mask mask(int width, int height) {
    const int sparse = static_cast<int>(number(4)) + 1;
    std::vector<std::string> rows(static_cast<std::size_t>(height));
    for (std::string& row : rows) {
      for (int x = 0; x < width; ++x) row += number(sparse + 1) == 0 ? '#' : ' ';
    }
    return *Mask::fromRows(rows);
  }

  naiad::SplitMix64 random{5};
};

TEST_F(RandomSweeps, TouchWhatEveryStepFinds) {
  int hits = 0;
  int starts = 0;
  int outs = 0;
  for (int i = 0; i < 300000; ++i) {
    const FixedVector place = anywhere();
    const Fixed spread = i % 2 == 0 ? 12 : 50;
    Move move;
    move.box = {{between(-9, 9), between(-9, 9)}, {number(9), number(9)}};
    move.from = place + FixedVector{between(-20, 20), between(-20, 20)};
    move.to = move.from + displacement(i % 3 == 0 ? 4 : 40);
    const FixedBox other = {place + FixedVector{between(-spread, spread), between(-spread, spread)},
                            {number(12), number(12)}};
    const Sweep sweep = move.sweep();
    const std::vector<Visit> visits = everyVisit(move);

    const std::optional<Moment> expected = touchPlainly(move, other, visits);
    const std::optional<Moment> found = sweep.firstTouch(other);
    ASSERT_EQ(found, expected) << i;
    ASSERT_EQ(sweep.closesGap(other), closesPlainly(move, other)) << i;
    const Wide at_start = gapOf(move.at(move.from), other);
    const bool moves_out = at_start <= 0 && gapOf(move.at(move.to), other) > at_start;
    ASSERT_EQ(sweep.movesOutOf(other), moves_out) << i;
    hits += found ? 1 : 0;
    starts += found && found->numerator == 0 ? 1 : 0;
    outs += moves_out ? 1 : 0;

    Moment moment = found.value_or(Moment{1, 1});
    if (i % 2 == 0) {
      moment.denominator = random.below(2) == 0 ? 1 + random.below(100) : (random.next() | 1);
      moment.numerator = random.below(moment.denominator);
      if (random.below(8) == 0) moment.numerator = moment.denominator;
    }
    FixedVector before = move.from;
    for (const Visit& visit : visits) {
      if (visit.time < moment) before = visit.position;
    }
    ASSERT_EQ(sweep.before(moment), before) << i;
  }
  EXPECT_GT(hits, 20000);
  EXPECT_GT(starts, 5000);
  EXPECT_GT(outs, 5000);
}

// Borders of cells and of boxes lie a few units apart, so that moves of a few units cross them in any order.
TEST_F(RandomSweeps, ShareWhatEveryStepFinds) {
  int hits = 0;
  int agains = 0;
  for (int i = 0; i < 150000; ++i) {
    const FixedVector place = {(anywhere().x >> kFixedBits) * kFixedOne,
                               (anywhere().y >> kFixedBits) * kFixedOne};
    const auto someCells = [&](Fixed most, Fixed jitter) {
      return FixedVector{fromCells(static_cast<std::int32_t>(number(most))) + between(-jitter, jitter),
                         fromCells(static_cast<std::int32_t>(number(most))) + between(-jitter, jitter)};
    };
    Move move;
    move.box = {someCells(2, 10), someCells(4, 10)};
    move.box.size = {std::max<Fixed>(0, move.box.size.x), std::max<Fixed>(0, move.box.size.y)};
    move.from = place + someCells(4, 12);
    move.to = move.from + displacement(30);
    FixedBox other = {place + someCells(5, 12), someCells(4, 10)};
    other.size = {std::max<Fixed>(0, other.size.x), std::max<Fixed>(0, other.size.y)};
    const Mask own = mask(1 + static_cast<int>(number(4)), 1 + static_cast<int>(number(4)));
    const Mask others = mask(1 + static_cast<int>(number(4)), 1 + static_cast<int>(number(4)));
    const Masks masks = {number(4) == 0 ? nullptr : &own, number(4) == 0 ? nullptr : &others};

    const std::optional<Moment> expected = sharePlainly(move, masks, other, everyVisit(move));
    const std::optional<Moment> found = move.sweep().firstShare(masks.p_own, other, masks.p_others);
    ASSERT_EQ(found, expected) << i;
    hits += found ? 1 : 0;
    if (found && found->numerator != 0 && sharePlainly(masks, move.at(move.from), other)) ++agains;
  }
  EXPECT_GT(hits, 5000);
  EXPECT_GT(agains, 20) << "met again after coming apart";
}

TEST_F(RandomSweeps, OverManyCellsMeetWhatAWalkFromMarkToMarkFinds) {
  int hits = 0;
  int late = 0;
  int agains = 0;
  for (int i = 0; i < 80000; ++i) {
    // Quarters of a cell make many things happen at once; other coordinates never agree.
    const bool is_round = i % 3 != 0;
    const auto jitter = [&] { return is_round ? number(4) * (kFixedOne / 4) : number(kFixedOne); };
    const auto coordinate = [&](Fixed least, Fixed most) {
      return between(least, most) * kFixedOne + jitter();
    };
    const auto around = [&](FixedVector place, Fixed spread) {
      return place + FixedVector{coordinate(-spread, spread), coordinate(-spread, spread)};
    };
    FixedVector place = anywhere();
    place = {place.x / 1000 * 999, place.y / 1000 * 999};
    place = {(place.x >> kFixedBits) * kFixedOne, (place.y >> kFixedBits) * kFixedOne};
    Move move;
    move.box = {around({}, 5), {coordinate(0, 6), coordinate(0, 6)}};
    move.from = around(place, 12);
    move.to = around(move.from, i % 2 == 0 ? 3 : 25);
    if (number(6) == 0) move.to.x = move.from.x;
    if (number(6) == 0) move.to.y = move.from.y;
    const bool is_large = number(10) == 0;
    const FixedBox other = {around(place, 9), {coordinate(0, is_large ? 30 : 6), coordinate(0, 6)}};
    const auto side = [&] { return 1 + static_cast<int>(number(8)); };
    const Mask own = mask(side(), side());
    const Mask others = mask(number(8) == 0 ? 70 : side(), side());
    const Masks masks = {number(4) == 0 ? nullptr : &own, number(3) == 0 ? nullptr : &others};

    const Sweep sweep = move.sweep();
    const std::vector<Visit> visits = tellingVisits(move, other, true);
    const std::optional<Moment> share = sharePlainly(move, masks, other, visits);
    const std::optional<Moment> touch = touchPlainly(move, other, visits);
    ASSERT_EQ(sweep.firstTouch(other), touch) << i;
    ASSERT_EQ(sweep.firstShare(masks.p_own, other, masks.p_others), share) << i;
    ASSERT_EQ(sweep.closesGap(other), closesPlainly(move, other)) << i;
    hits += share ? 1 : 0;
    late += share && touch && *share > *touch ? 1 : 0;
    if (share && share->numerator != 0 && sharePlainly(masks, move.at(move.from), other)) ++agains;
  }
  EXPECT_GT(hits, 3000);
  EXPECT_GT(late, 1000) << "masks met after the boxes did";
  EXPECT_GT(agains, 50) << "met again after coming apart";
}

TEST_F(RandomSweeps, AcrossTheWorldTouchWhatAWalkFromMarkToMarkFinds) {
  int hits = 0;
  for (int i = 0; i < 100000; ++i) {
    const Fixed reach = i % 2 == 0 ? kFar : kFar / 1000;
    const Fixed largest = i % 3 == 0 ? fromCells(1000000) : fromCells(1000);
    const auto anyPoint = [&] { return FixedVector{between(-reach, reach), between(-reach, reach)}; };
    Move move;
    move.box = {{between(-largest, largest), between(-largest, largest)}, {number(largest), number(largest)}};
    move.from = anyPoint();
    move.to = anyPoint();
    // Close to some point of the way.
    const double share = random.unit();
    const auto aim = [&](Fixed from, Fixed to, Fixed corner) {
      const double way = static_cast<double>(magnitude(from, to)) * share;
      const Fixed point =
          goOn(from, to, static_cast<std::uint64_t>(way)) + corner + between(-largest, largest);
      return std::clamp(point, -kFar, kFar);
    };
    const FixedBox other = {
        {aim(move.from.x, move.to.x, move.box.corner.x), aim(move.from.y, move.to.y, move.box.corner.y)},
        {number(largest), number(largest)}};
    const Sweep sweep = move.sweep();
    const std::optional<Moment> found = sweep.firstTouch(other);
    ASSERT_EQ(found, touchPlainly(move, other, tellingVisits(move, other, false))) << i;
    hits += found ? 1 : 0;
    if (!found || found->numerator == 0) continue;
    ASSERT_FALSE(intersects(move.at(sweep.before(*found)), other)) << i;
    const auto after = [&](Fixed from, Fixed to) {
      const WideUnsigned steps = static_cast<WideUnsigned>(magnitude(from, to)) * found->numerator;
      return goOn(from, to, static_cast<std::uint64_t>(steps / found->denominator));
    };
    const FixedVector then = {after(move.from.x, move.to.x), after(move.from.y, move.to.y)};
    ASSERT_TRUE(intersects(move.at(then), other)) << i;
  }
  EXPECT_GT(hits, 30000);
}

// ---- Moments.

TEST(Moments, AreComparedAsFractionsNotAsDoubles) {
  constexpr std::uint64_t kMost = UINT64_MAX;
  EXPECT_EQ((Moment{1, 2}), (Moment{3, 6}));
  EXPECT_EQ((Moment{0, 1}), (Moment{0, kMost}));
  EXPECT_EQ((Moment{kMost, kMost}), (Moment{1, 1}));
  EXPECT_LT((Moment{kMost - 1, kMost}), (Moment{1, 1}));
  EXPECT_LT((Moment{kMost - 2, kMost - 1}), (Moment{kMost - 1, kMost}));
  EXPECT_GT((Moment{1, kMost - 1}), (Moment{1, kMost}));
  EXPECT_LT((Moment{5, kMost}), (Moment{6, kMost}));
  EXPECT_EQ((Moment{1, 4}).toDouble(), 0.25);
}

// ---- What docs/collisions.md promises.

const FixedBox kCharacter = {{-kFixedOne / 2, -kFixedOne / 2}, {kFixedOne, kFixedOne}};

TEST(SweptMove, FastArrowMeetsTheWindow) {
  const FixedBox arrow = {cells(-2, -0.5), cells(4, 1)};
  const FixedBox window = translate(kCharacter, cells(21, 0));
  const Sweep sweep(arrow, cells(10, 0), cells(25, 0));
  ASSERT_FALSE(intersects(translate(arrow, cells(25, 0)), window));
  const std::optional<Moment> touch = sweep.firstTouch(window);
  ASSERT_TRUE(touch);
  EXPECT_EQ(*touch, (Moment{17, 30}));  // from its tip at 12 to the glass at 20.5: 8.5 of 15 cells
  EXPECT_EQ(sweep.before(*touch), (FixedVector{fromCells(10) + 17 * (kFixedOne / 2) - 1, 0}));
}

TEST(SweptMove, WhatLiesBesideBeforeOrBehindIsNotHit) {
  const Sweep sweep(kCharacter, cells(0, 0), cells(10, 5));
  const auto isHit = [&](double x, double y) {
    return sweep.firstTouch(translate(kCharacter, cells(x, y))).has_value();
  };
  EXPECT_TRUE(isHit(6, 3));
  EXPECT_TRUE(isHit(11, 6)) << "the edges touch at the target";
  EXPECT_TRUE(isHit(6, 4.5)) << "the corners touch on the way";
  EXPECT_FALSE(isHit(6, 4.6));
  EXPECT_FALSE(isHit(11.01, 5));
  EXPECT_FALSE(isHit(-2, -1));
  EXPECT_FALSE(isHit(0, 5));
}

TEST(SweptMove, MovesAnAxisOnlyWhenAWholeUnitIsFull) {
  // Two units to the right while it goes three down: x is 1 from t = 1/2 on, when y is 1.
  const Sweep sweep({{}, {}}, {0, 0}, {2, 3});
  EXPECT_EQ(sweep.firstTouch({{1, 1}, {}}), (Moment{1, 2}));
  EXPECT_EQ(sweep.firstTouch({{0, 1}, {}}), (Moment{1, 3}));
  EXPECT_EQ(sweep.firstTouch({{1, 2}, {}}), (Moment{2, 3}));
  EXPECT_EQ(sweep.firstTouch({{2, 3}, {}}), (Moment{1, 1}));
  EXPECT_EQ(sweep.firstTouch({{1, 0}, {}}), std::nullopt) << "never at (1,0)";
  EXPECT_EQ(sweep.firstTouch({{0, 2}, {}}), std::nullopt);
  EXPECT_EQ(sweep.before({1, 2}), (FixedVector{0, 1}));
  EXPECT_EQ(sweep.before({2, 3}), (FixedVector{1, 1}));
  EXPECT_EQ(sweep.before({1, 1}), (FixedVector{1, 2}));
  EXPECT_EQ(sweep.before({0, 1}), (FixedVector{0, 0}));
}

// A character directly to the left of a wall two cells thick and ten high.
class AtTheWall : public testing::Test {
 protected:
  std::optional<Moment> touch(FixedVector by) const {
    return Sweep(kCharacter, start, start + by).firstTouch(wall);
  }

  const FixedVector start = cells(-0.5, 5);
  const FixedBox wall = {{0, 0}, {2 * kFixedOne, 10 * kFixedOne}};
};

TEST_F(AtTheWall, LeavingIsFree) {
  EXPECT_EQ(touch({-1, 0}), std::nullopt);
  EXPECT_EQ(touch(cells(-20, 0)), std::nullopt);
  EXPECT_EQ(touch(cells(-20, 3)), std::nullopt);
}

TEST_F(AtTheWall, GoingInHitsAtOnce) {
  EXPECT_EQ(touch({1, 0}), Moment{});
  EXPECT_EQ(touch(cells(20, 0)), Moment{}) << "on the other side at the end, but through the wall";
  EXPECT_EQ(touch(cells(1, 20)), Moment{});
}

TEST_F(AtTheWall, StandingStillTouches) {
  EXPECT_EQ(touch({0, 0}), Moment{});
}

TEST_F(AtTheWall, SlidingAlongHitsUnlessItEndsBeyond) {
  EXPECT_EQ(touch(cells(0, 5.5)), Moment{}) << "the corners touch at the end";
  EXPECT_EQ(touch(cells(0, -2)), Moment{});
  EXPECT_EQ(touch(cells(0, 5.5) + FixedVector{0, 1}), std::nullopt);
  EXPECT_EQ(touch(cells(0, -20)), std::nullopt);
}

TEST_F(AtTheWall, OneUnitAwaySlidesFreely) {
  // Where a mover is placed that the wall has stopped.
  const Sweep arrival(kCharacter, cells(-10, 3), cells(10, 7));
  const std::optional<Moment> touch = arrival.firstTouch(wall);
  ASSERT_TRUE(touch);
  const FixedVector stop = arrival.before(*touch);
  EXPECT_EQ(stop.x, -kFixedOne / 2 - 1);
  for (const double way : {-20.0, -1.0, 0.0, 1.0, 20.0}) {
    EXPECT_EQ(Sweep(kCharacter, stop, stop + cells(0, way)).firstTouch(wall), std::nullopt) << way;
  }
  EXPECT_EQ(Sweep(kCharacter, stop, stop + FixedVector{1, 0}).firstTouch(wall), (Moment{1, 1}));
}

TEST_F(AtTheWall, FromInsideTheShortestWayOutIsFree) {
  // Half a cell deep from the left, five from above and below.
  const FixedVector inside = cells(0, 5);
  const auto touch_from = [&](FixedVector by) {
    return Sweep(kCharacter, inside, inside + by).firstTouch(wall);
  };
  EXPECT_EQ(touch_from(cells(-3, 0)), std::nullopt);
  EXPECT_EQ(touch_from(cells(-3, 20)), std::nullopt);
  EXPECT_EQ(touch_from(cells(-0.5, 0)), Moment{}) << "the edges still touch";
  EXPECT_EQ(touch_from(cells(3, 0)), Moment{}) << "deeper first";
  EXPECT_EQ(touch_from(cells(0, 20)), std::nullopt) << "no deeper, and out in the end";
}

TEST(SweptMove, GapOfAPairIsTheLargerAndClosesOnlyIfAllOfItDoes) {
  const FixedBox wall = {{0, 0}, cells(4, 4)};
  const auto closes = [&](FixedVector from, FixedVector by) {
    return Sweep(kCharacter, from, from + by).closesGap(wall);
  };
  EXPECT_TRUE(closes(cells(-3, 2), cells(1, 0)));
  EXPECT_FALSE(closes(cells(-3, 2), cells(0, 1)));
  EXPECT_FALSE(closes(cells(-3, 2), cells(-1, 0)));
  EXPECT_TRUE(closes(cells(7, 2), cells(-1, 9)));
  // Corner to corner: both axes have gap 0.
  const FixedVector corner = cells(-0.5, -0.5);
  EXPECT_TRUE(closes(corner, cells(1, 1)));
  EXPECT_FALSE(closes(corner, cells(1, 0)));
  EXPECT_FALSE(closes(corner, cells(1, -1)));
  // In the very middle any way is out.
  EXPECT_FALSE(closes(cells(2, 2), cells(1, 0)));
  EXPECT_FALSE(closes(cells(2, 2), cells(-1, 1)));
}

TEST(SweptMove, MovesOutIfTheGapIsLargerAtTheEnd) {
  const FixedBox wall = {{0, 0}, cells(4, 4)};
  const auto movesOut = [&](FixedVector from, FixedVector by) {
    return Sweep(kCharacter, from, from + by).movesOutOf(wall);
  };
  EXPECT_TRUE(movesOut(cells(1, 2), {-1, 0})) << "still inside, but less so";
  EXPECT_TRUE(movesOut(cells(1, 2), cells(20, 0))) << "by the long way";
  EXPECT_FALSE(movesOut(cells(1, 2), cells(2, 0))) << "as deep from the other side";
  EXPECT_FALSE(movesOut(cells(1, 2), cells(0, 0)));
  EXPECT_TRUE(movesOut(cells(-0.5, 2), {-1, 0}));
  EXPECT_FALSE(movesOut({-kFixedOne / 2 - 1, 0}, cells(-5, 0))) << "did not touch";
}

// ---- Masks on the way.

class MaskedMove : public testing::Test {
 protected:
  static FixedBox boxAt(int x, int y, int width, int height) {
    return {{fromCells(x - 1), fromCells(y - 1)}, {fromCells(width), fromCells(height)}};
  }
  // A mask whose first character is in cell (0,0) of its position.
  static Sweep sweep(const Mask& mask, FixedVector from, FixedVector to) {
    return {boxAt(0, 0, mask.width(), mask.height()), from, to};
  }
};

TEST_F(MaskedMove, FliesThroughAHoleAsHighAsItself) {
  const Mask arrow = *Mask::fromRows({">-->"});
  const Mask gate = *Mask::fromRows({"#", "#", " ", "#"});
  const FixedBox box = boxAt(10, 0, 1, 4);
  for (int y = 0; y < 4; ++y) {
    const Sweep move = sweep(arrow, cells(0, y), cells(30, y));
    EXPECT_TRUE(move.firstTouch(box)) << y;
    // Its tip enters the gate's cell after 7 cells.
    const auto expected = y == 2 ? std::nullopt : std::optional(Moment{7, 30});
    EXPECT_EQ(move.firstShare(&arrow, box, &gate), expected) << y;
  }
}

TEST_F(MaskedMove, SideBySideMayPass) {
  const Mask dot = *Mask::fromRows({"o"});
  const Sweep move = sweep(dot, cells(0, 0), cells(20, 0));
  EXPECT_TRUE(move.firstTouch(boxAt(10, 1, 1, 1)));
  EXPECT_FALSE(move.firstShare(&dot, boxAt(10, 1, 1, 1), &dot));
  EXPECT_FALSE(move.firstShare(&dot, boxAt(10, 1, 1, 1), nullptr));
  EXPECT_FALSE(move.firstShare(nullptr, boxAt(10, 1, 1, 1), nullptr));
  EXPECT_TRUE(move.firstShare(nullptr, boxAt(10, 0, 1, 1), nullptr));
}

TEST_F(MaskedMove, GoesDownIntoACellAtItsLastUnit) {
  const Mask dot = *Mask::fromRows({"o"});
  const Sweep move = sweep(dot, cells(5, 0), cells(-5, 0));
  const FixedBox other = boxAt(0, 0, 1, 1);
  // From cell 5 to the last unit of cell 0: four cells and a unit, of ten.
  const auto way = static_cast<std::uint64_t>(10 * kFixedOne);
  const std::optional<Moment> share = move.firstShare(&dot, other, &dot);
  EXPECT_EQ(share, (Moment{static_cast<std::uint64_t>(4 * kFixedOne + 1), way}));
  EXPECT_EQ(move.before(*share), cells(1, 0));
}

TEST_F(MaskedMove, MeetsAgainWhatItHasLeft) {
  // Two bars in a row: the mover begins in the first, leaves it and meets the second.
  const Mask bars = *Mask::fromRows({"#   #   "});
  const Mask dot = *Mask::fromRows({"o"});
  const FixedBox box = boxAt(0, 0, 8, 1);
  EXPECT_EQ(sweep(dot, cells(0, 0), cells(-3, 0)).firstShare(&dot, box, &bars), std::nullopt);
  const Sweep through = sweep(dot, cells(0, 0), cells(10, 0));
  EXPECT_FALSE(through.closesGap(box)) << "the axis across is no deeper";
  EXPECT_EQ(through.firstShare(&dot, box, &bars), (Moment{4, 10}));
  EXPECT_EQ(sweep(dot, cells(0, 0), cells(4, 0)).firstShare(&dot, box, &bars), Moment{})
      << "shares at the end";
  EXPECT_EQ(sweep(dot, cells(0, 0), cells(3, 0)).firstShare(&dot, box, &bars), std::nullopt);
}

TEST_F(MaskedMove, InsideARingIsFreeUntilItMeetsTheRim) {
  const Mask ring = *Mask::fromRows({"######", "#    #", "#    #", "#    #", "######"});
  const Mask dot = *Mask::fromRows({"o"});
  const FixedBox box = boxAt(0, 0, 6, 5);
  EXPECT_EQ(sweep(dot, cells(1, 1), cells(4, 3)).firstShare(&dot, box, &ring), std::nullopt);
  EXPECT_EQ(sweep(dot, cells(1, 2), cells(11, 2)).firstShare(&dot, box, &ring), (Moment{4, 10}));
  EXPECT_EQ(sweep(dot, cells(1, 2), cells(1, 2)).firstShare(&dot, box, &ring), std::nullopt);
}

TEST_F(MaskedMove, CrossesTheLargestBoxByItsEndsOnly) {
  // A ship of two rows, the lower one empty, above the wall: only the empty row is level with it.
  const Mask ship = *Mask::fromRows({"####", "    "});
  const FixedBox wall = boxAt(0, 0, 1000000, 1);
  const Sweep along = sweep(ship, cells(-100, -1), cells(2000000, -1));
  EXPECT_TRUE(along.firstTouch(wall));
  EXPECT_EQ(along.firstShare(&ship, wall, nullptr), std::nullopt);
  // It sinks by one cell while it crosses: the upper row is level with the wall in the end.
  const Sweep sinking = sweep(ship, cells(0, -1), cells(900000, 0));
  EXPECT_EQ(sinking.firstShare(&ship, wall, nullptr), (Moment{1, 1}));
  // The same the other way round: the wall moves, up.
  const Sweep rising(boxAt(0, 0, 1000000, 1), cells(-900000, 0), cells(0, -1));
  EXPECT_EQ(rising.firstShare(nullptr, boxAt(0, -1, 4, 2), &ship),
            (Moment{1, static_cast<std::uint64_t>(kFixedOne)}));
}

// ---- As far and as fast as the world allows.

// `base` at the origin and at every end of the world: the same answers, shifted.
void expectSameEverywhere(const Move& base, const FixedBox& other, Masks masks = {}) {
  const Sweep here = base.sweep();
  for (const Fixed x : {-kFar + fromCells(3000000), Fixed{0}, kFar - fromCells(3000000)}) {
    for (const Fixed y : {-kFar + fromCells(3000000), Fixed{0}, kFar - fromCells(3000000)}) {
      const FixedVector offset = {x, y};
      const Sweep there(base.box, base.from + offset, base.to + offset);
      const FixedBox other_there = translate(other, offset);
      const std::optional<Moment> touch = here.firstTouch(other);
      EXPECT_EQ(there.firstTouch(other_there), touch);
      EXPECT_EQ(there.firstShare(masks.p_own, other_there, masks.p_others),
                here.firstShare(masks.p_own, other, masks.p_others));
      EXPECT_EQ(there.closesGap(other_there), here.closesGap(other));
      EXPECT_EQ(there.movesOutOf(other_there), here.movesOutOf(other));
      const Moment moment = touch.value_or(Moment{1, 3});
      EXPECT_EQ(there.before(moment), here.before(moment) + offset);
    }
  }
}

TEST(FarAndFast, AnswersAreTheSameAtTheEndsOfTheWorld) {
  const Mask mask = *Mask::fromRows({"#  #", " ## ", "#  #"});
  for (const double size : {0.0, 1.0, 10000.0, 1000000.0}) {
    for (const double speed : {1.0, 15.0, 1000000.0}) {
      for (const double slope : {0.0, 0.001, -0.37, 1.0}) {
        const FixedBox box = {cells(-size / 2, -size / 2), cells(size, size)};
        const Move move = {box, cells(0.25, 0.75), cells(0.25 + speed, 0.75 + speed * slope)};
        for (const double x : {-3.0, 0.0, 5.0, 400.0, 999999.0}) {
          expectSameEverywhere(move, {cells(x, x * slope), cells(1, 3)}, {nullptr, &mask});
          expectSameEverywhere(move, {cells(x, 0), cells(10000, 0)}, {&mask, nullptr});
          expectSameEverywhere(move, {cells(x, 0.5), {}});
        }
      }
    }
  }
}

TEST(FarAndFast, FromEndToEndOfTheWorld) {
  const FixedVector first = {-kFar, -kFar};
  const FixedVector last = {kFar, kFar};
  for (const bool is_back : {false, true}) {
    const Sweep sweep = is_back ? Sweep(kCharacter, last, first) : Sweep(kCharacter, first, last);
    const FixedVector target = is_back ? first : last;
    const Fixed unit = is_back ? -1 : 1;
    // In the middle: half of the way, less one cell.
    const FixedBox middle = translate(kCharacter, {});
    const auto way = static_cast<std::uint64_t>(kFar) * 2;
    const Moment touch = {static_cast<std::uint64_t>(kFar - kFixedOne), way};
    EXPECT_EQ(sweep.firstTouch(middle), touch);
    EXPECT_EQ(sweep.before(touch), (FixedVector{-unit * (kFixedOne + 1), -unit * (kFixedOne + 1)}));
    EXPECT_TRUE(sweep.closesGap(middle));
    EXPECT_FALSE(sweep.movesOutOf(middle));
    // At the target, with a little to spare.
    EXPECT_EQ(sweep.firstTouch(translate(kCharacter, target)), (Moment{way - kFixedOne, way}));
    const FixedBox beyond = translate(kCharacter, target + FixedVector{unit * kFixedOne, unit * kFixedOne});
    EXPECT_EQ(sweep.firstTouch(beyond), (Moment{1, 1}));
    EXPECT_EQ(sweep.before({1, 1}), (FixedVector{target.x - unit, target.y - unit}));
    EXPECT_EQ(sweep.firstTouch(translate(beyond, {unit, 0})), std::nullopt);
    // Out of what stands at the start.
    const FixedBox behind = translate(kCharacter, is_back ? last : first);
    EXPECT_EQ(sweep.firstTouch(behind), std::nullopt);
    EXPECT_TRUE(sweep.movesOutOf(behind));
  }
}

TEST(FarAndFast, SlowAxisBesideTheFastestOneIsExact) {
  // x crosses the world while y goes three units: y is 1 from a third of the way on, to the unit.
  const Sweep sweep({{}, {}}, {-kFar, 0}, {kFar, 3});
  const auto way = static_cast<std::uint64_t>(kFar) * 2;
  const std::uint64_t third = way / 3 + 1;  // no multiple of 3
  const auto at = [](std::uint64_t steps) { return goOn(-kFar, kFar, steps); };
  EXPECT_EQ(sweep.firstTouch({{at(third), 1}, {}}), (Moment{third, way}));
  EXPECT_EQ(sweep.firstTouch({{at(third - 1), 1}, {}}), (Moment{1, 3})) << "between two steps of x";
  EXPECT_EQ(sweep.firstTouch({{at(third - 2), 1}, {}}), std::nullopt);
  EXPECT_EQ(sweep.firstTouch({{at(third - 1), 0}, {}}), (Moment{third - 1, way}));
  EXPECT_EQ(sweep.before({1, 3}), (FixedVector{at(third - 1), 0}));
  EXPECT_EQ(sweep.before({third, way}), (FixedVector{at(third - 1), 1}));
  EXPECT_EQ(sweep.before({1, 1}), (FixedVector{at(way - 1), 2}));
}

TEST(FarAndFast, MasksMeetAtTheEndOfTheFastestMove) {
  const Mask mask = *Mask::fromRows({"# ", " #"});
  const FixedBox box = {{-kFixedOne, -kFixedOne}, {2 * kFixedOne, 2 * kFixedOne}};
  const Sweep sweep(box, {-kFar, -kFar}, {kFar, kFar});
  const FixedBox wall = translate({{}, {fromCells(1000000), fromCells(1000000)}}, {kFar, kFar});
  // The corners of the boxes meet a cell before the target, the characters at the target.
  const auto way = static_cast<std::uint64_t>(kFar) * 2;
  EXPECT_EQ(sweep.firstTouch(wall), (Moment{way - kFixedOne, way}));
  EXPECT_EQ(sweep.firstShare(&mask, wall, nullptr), (Moment{1, 1}));
  EXPECT_EQ(sweep.firstShare(&mask, translate(wall, {kFixedOne, 0}), nullptr), std::nullopt);
}

}  // namespace
}  // namespace df::test

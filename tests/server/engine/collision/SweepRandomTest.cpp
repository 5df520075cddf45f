// Compares sweeps in random cases with the reference results of PlainSweep.h.
#include <gtest/gtest.h>

#include <string>

#include "PlainSweep.h"
#include "shared/values/SplitMix64.h"

namespace df::test {
namespace {

class RandomSweeps : public testing::Test {
 protected:
  Fixed number(Fixed below) { return static_cast<Fixed>(random.below(static_cast<std::uint64_t>(below))); }
  Fixed between(Fixed least, Fixed most) {
    const std::uint64_t offset = random.below(magnitude(least, most) + 1);
    return static_cast<Fixed>(static_cast<std::uint64_t>(least) + offset);
  }
  // A fixed share of the moves is along an axis or has no length.
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

TEST_F(RandomSweeps, TouchResultsMatchSteppingUnitByUnit) {
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

// The borders of cells and boxes are a few units apart, so short moves cross them in any order.
TEST_F(RandomSweeps, FirstShareMatchesSteppingUnitByUnit) {
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
  EXPECT_GT(agains, 20) << "hit again after coming apart";
}

TEST_F(RandomSweeps, MultiCellSweepsMatchAReferenceWalk) {
  int hits = 0;
  int late = 0;
  int agains = 0;
  for (int i = 0; i < 80000; ++i) {
    // Multiples of a quarter cell make events coincide; other coordinates rarely do.
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
  EXPECT_GT(late, 1000) << "masks touched after the boxes did";
  EXPECT_GT(agains, 50) << "hit again after coming apart";
}

TEST_F(RandomSweeps, WorldWideSweepsMatchAReferenceWalk) {
  int hits = 0;
  for (int i = 0; i < 100000; ++i) {
    const Fixed reach = i % 2 == 0 ? kFar : kFar / 1000;
    const Fixed largest = i % 3 == 0 ? fromCells(1000000) : fromCells(1000);
    const auto anyPoint = [&] { return FixedVector{between(-reach, reach), between(-reach, reach)}; };
    Move move;
    move.box = {{between(-largest, largest), between(-largest, largest)}, {number(largest), number(largest)}};
    move.from = anyPoint();
    move.to = anyPoint();
    // The other box is close to some point of the path.
    const double share = random.unit();
    const auto aim = [&](Fixed from, Fixed to, Fixed corner) {
      const double distance = static_cast<double>(magnitude(from, to)) * share;
      const Fixed point =
          advance(from, to, static_cast<std::uint64_t>(distance)) + corner + between(-largest, largest);
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
      return advance(from, to, static_cast<std::uint64_t>(steps / found->denominator));
    };
    const FixedVector then = {after(move.from.x, move.to.x), after(move.from.y, move.to.y)};
    ASSERT_TRUE(intersects(move.at(then), other)) << i;
  }
  EXPECT_GT(hits, 30000);
}

}  // namespace
}  // namespace df::test

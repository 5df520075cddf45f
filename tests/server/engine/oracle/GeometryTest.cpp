// Compares the oracle's geometry with tests of every position of a path.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <ostream>

#include "OracleGeometry.h"
#include "Rng.h"

namespace oracle {

static void PrintTo(Time time, std::ostream* p_out) {
  *p_out << time.numerator << '/' << time.denominator;
}

namespace {

bool isEqual(Time a, Time b) {
  return !(a < b) && !(b < a);
}

/// A path, the box and mask that move along it, and the box and mask that they may hit.
struct Case {
  SweepPath path;
  FixedBox box;
  Mask mask;
  FixedBox other;
  Mask others_mask;

  bool touches(FixedVector where) const { return boxIntersectsBox(translate(box, where), other); }
  bool shares(FixedVector where) const {
    return touches(where) && shareCell(translate(box, where), mask, other, others_mask);
  }
};

/// Returns the first of `times` (sorted, 0 to 1) at which `meets` is true. A contact at the start counts only
/// if the gap closes or `meets` is true at the end, too.
std::optional<Time> look(const Case& c, const std::vector<Time>& times,
                         const std::function<bool(FixedVector)>& meets) {
  std::size_t i = 0;
  if (meets(c.path.from)) {
    if (closesGap(c.box, c.path, c.other) || meets(c.path.to)) return Time{0, 1};
    while (i < times.size() && meets(c.path.at(times[i]))) ++i;
  }
  while (i < times.size() && !meets(c.path.at(times[i]))) ++i;
  return i < times.size() ? std::optional(times[i]) : std::nullopt;
}

void expectEqual(const std::optional<Time>& found, const std::optional<Time>& expected, int number) {
  ASSERT_EQ(found.has_value(), expected.has_value()) << "case " << number;
  if (!found) return;
  EXPECT_TRUE(isEqual(*found, *expected)) << "case " << number << ": " << testing::PrintToString(*found)
                                          << " for " << testing::PrintToString(*expected);
}

/// Makes a case whose coordinates are multiples of `unit`, with boxes of at most `size` units.
Case randomCase(Rng& rng, Fixed unit, int reach, int size) {
  const auto vector = [&](int least, int most) {
    const Fixed x = unit * rng.between(least, most);
    return FixedVector{x, unit * rng.between(least, most)};
  };
  Case c;
  c.path.from = vector(-reach, reach);
  c.path.to = c.path.from + vector(-reach, reach);
  if (rng.chance(20)) c.path.to.x = c.path.from.x;
  if (rng.chance(20)) c.path.to.y = c.path.from.y;
  c.box.corner = vector(-size, size);
  c.box.size = vector(0, size);
  c.other.corner = vector(-reach, reach);
  c.other.size = vector(0, size);
  return c;
}

TEST(GeometryTest, FirstTouchMatchesTestingEveryPosition) {
  Rng rng(1);
  int met = 0;
  int at_start = 0;
  for (int number = 0; number < 20'000; ++number) {
    const Case c = randomCase(rng, 1, 9, 6);
    const auto length_x = static_cast<std::uint64_t>(std::abs(c.path.to.x - c.path.from.x));
    const auto length_y = static_cast<std::uint64_t>(std::abs(c.path.to.y - c.path.from.y));
    const std::uint64_t steps = std::max<std::uint64_t>(length_x, 1) * std::max<std::uint64_t>(length_y, 1);
    std::vector<Time> times;
    for (std::uint64_t i = 0; i <= steps; ++i) times.push_back({i, steps});

    const auto found = firstTouch(c.path, c.box, c.other);
    expectEqual(found, look(c, times, [&](FixedVector where) { return c.touches(where); }), number);
    if (!found) continue;
    ++met;
    if (found->numerator == 0) {
      ++at_start;
      EXPECT_EQ(c.path.before(*found), c.path.from);
      continue;
    }
    // The position before the hit is that of the previous step, which does not touch yet.
    std::uint64_t i = 0;
    while (!isEqual(times[i], *found)) ++i;
    EXPECT_EQ(c.path.before(*found), c.path.at(times[i - 1]));
    EXPECT_FALSE(c.touches(c.path.before(*found)));
    EXPECT_TRUE(c.touches(c.path.at(*found)));
  }
  EXPECT_GT(met, 2'000);
  EXPECT_GT(at_start, 500);
}

// Contacts change only where a coordinate reaches a multiple of the unit or leaves it.
TEST(GeometryTest, FirstShareMatchesTestingEveryPosition) {
  const Fixed unit = df::kFixedOne / 4;
  Rng rng(2);
  int met = 0;
  int met_again = 0;
  int passed = 0;
  for (int number = 0; number < 100'000; ++number) {
    Case c = randomCase(rng, unit, 20, 16);
    const auto mask = [&] {
      Mask rows(static_cast<std::size_t>(rng.below(5)));
      for (std::string& row : rows) {
        for (int i = rng.below(5); i >= 0; --i) row += rng.chance(40) ? '#' : ' ';
      }
      return rows;
    };
    c.mask = mask();
    c.others_mask = mask();

    std::vector<Time> times{{0, 1}, {1, 1}};
    for (const Fixed distance : {c.path.to.x - c.path.from.x, c.path.to.y - c.path.from.y}) {
      const auto length = static_cast<std::uint64_t>(std::abs(distance));
      for (std::uint64_t gone = 0; gone < length; gone += static_cast<std::uint64_t>(unit)) {
        times.push_back({gone, length});
        times.push_back({gone + 1, length});
      }
    }
    std::sort(times.begin(), times.end());

    const auto found = firstShare(c.path, c.box, c.mask, c.other, c.others_mask);
    expectEqual(found, look(c, times, [&](FixedVector where) { return c.shares(where); }), number);
    const auto touched = firstTouch(c.path, c.box, c.other);
    if (found) ++met;
    if (found && found->numerator != 0 && c.shares(c.path.from)) ++met_again;
    if (touched && !found) ++passed;
  }
  EXPECT_GT(met, 2'000);
  EXPECT_GT(met_again, 10);
  EXPECT_GT(passed, 500);
}

// Compares with the gap after a move so short that the largest of the four distances stays the largest.
TEST(GeometryTest, ClosingGapIsSmallerAMomentLater) {
  constexpr Fixed kMoment = 1000;
  Rng rng(3);
  const auto scaled = [](FixedBox box) {
    return FixedBox{{box.corner.x * kMoment, box.corner.y * kMoment},
                    {box.size.x * kMoment, box.size.y * kMoment}};
  };
  int closing = 0;
  for (int number = 0; number < 20'000; ++number) {
    const Case c = randomCase(rng, 1, 9, 6);
    const FixedBox at_start = scaled(translate(c.box, c.path.from));
    const FixedBox a_moment_later = translate(at_start, c.path.to - c.path.from);
    const bool closes = gap(a_moment_later, scaled(c.other)) < gap(at_start, scaled(c.other));
    EXPECT_EQ(closesGap(c.box, c.path, c.other), closes) << "case " << number;
    if (closes) ++closing;
  }
  EXPECT_GT(closing, 2'000);
}

// Across the whole number range, a distance does not fit a signed 64-bit number.
TEST(GeometryTest, PathAcrossTheWholeWorldIsExact) {
  const Fixed end = df::fromCells(2'000'000'000);
  const FixedBox character{{-df::kFixedOne / 2, -df::kFixedOne / 2}, {df::kFixedOne, df::kFixedOne}};
  const SweepPath path{{-end, -end}, {end, end}};
  const auto time = firstTouch(
      path, character, translate(character, {end - 10 * df::kFixedOne, end - 10 * df::kFixedOne - 5}));
  ASSERT_TRUE(time);
  EXPECT_EQ(path.before(*time), (FixedVector{end - 11 * df::kFixedOne - 1, end - 11 * df::kFixedOne - 1}));
  EXPECT_EQ(path.at({1, 1}), path.to);
  EXPECT_EQ(gap(translate(character, path.from), translate(character, path.to)),
            2 * static_cast<Wide>(end) - df::kFixedOne);
}

}  // namespace
}  // namespace oracle

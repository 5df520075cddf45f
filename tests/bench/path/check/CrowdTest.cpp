#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <map>

#include "tests/bench/path/scene/Crowd.h"
#include "tests/bench/path/scene/Status.h"

namespace bench::path {
namespace {

TEST(Crowd, DependsOnlyOnItsSeed) {
  Crowd a(5);
  Crowd b(5);
  Crowd other(6);
  for (int i = 0; i < 100; ++i) {
    a.tick();
    b.tick();
    other.tick();
  }
  EXPECT_EQ(drawScene(a).cells, drawScene(b).cells);
  EXPECT_NE(drawScene(a).cells, drawScene(other).cells);
}

TEST(Crowd, WalkersStayOnScreenInCreationOrder) {
  Crowd crowd(7);
  for (int i = 0; i < 2000; ++i) {
    crowd.tick();
    const auto& walkers = crowd.walkers();
    ASSERT_EQ(walkers.size(), static_cast<std::size_t>(kCrowd));
    ASSERT_TRUE(std::is_sorted(walkers.begin(), walkers.end(), [](auto& a, auto& b) { return a.id < b.id; }));
    for (const Walker& walker : walkers) {
      ASSERT_TRUE(walker.x >= 0 && walker.x <= (kWidth - 1) * kUnits);
      ASSERT_TRUE(walker.y >= 0 && walker.y <= (kHeight - 1) * kUnits);
    }
  }
}

TEST(Crowd, WalkersChangeAtTheSpecifiedRates) {
  Crowd crowd(8);
  std::map<std::uint32_t, Walker> before;
  int changed = 0;
  int born = 0;
  int still = 0;
  int running = 0;
  constexpr int kTicks = 5000;
  for (int i = 0; i < kTicks; ++i) {
    for (const Walker& walker : crowd.walkers()) before[walker.id] = walker;
    crowd.tick();
    for (const Walker& walker : crowd.walkers()) {
      still += walker.vx == 0 && walker.vy == 0;
      running += std::abs(walker.vx) == kUnits;
      const auto old = before.find(walker.id);
      if (old == before.end()) {
        ++born;
        continue;
      }
      changed += old->second.ch != walker.ch;
      ASSERT_EQ(walker.x, old->second.x + walker.vx);
      ASSERT_EQ(walker.y, old->second.y + walker.vy);
    }
    before.clear();
  }
  constexpr double kMoves = 1.0 * kCrowd * kTicks;
  EXPECT_NEAR(born / kMoves, 0.002, 0.0003);
  EXPECT_NEAR(changed / kMoves, 0.02 * 25 / 26, 0.001);
  EXPECT_NEAR(still / kMoves, 0.1, 0.02);
  EXPECT_NEAR(running / kMoves, 0.1, 0.02);
}

TEST(Status, CounterCanBeReadBack) {
  Crowd crowd(1);
  for (int i = 0; i < 1234; ++i) crowd.tick();
  Picture picture = drawScene(crowd);
  EXPECT_EQ(counterIn(picture), 1234u);
  picture.at(7, kStatusRow).ch = ' ';
  EXPECT_EQ(counterIn(picture), std::nullopt);
}

TEST(Status, MarkerDistinguishesArrowsModuloFour) {
  for (std::uint32_t arrows = 0; arrows < 9; ++arrows) {
    Picture picture;
    const MarkerCell cell = markerAfter(arrows);
    picture.at(cell.x, cell.y).ch = '@';
    EXPECT_EQ(markerIn(picture), arrows % 4);
    const MarkerCell next = markerAfter(arrows + 1);
    EXPECT_EQ(std::abs(next.x - cell.x) + std::abs(next.y - cell.y), 1) << "it walks";
    picture.at(next.x, next.y).ch = '@';
    EXPECT_EQ(markerIn(picture), std::nullopt) << "half painted";
  }
}

}  // namespace
}  // namespace bench::path

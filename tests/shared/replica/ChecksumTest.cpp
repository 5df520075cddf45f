#include <gtest/gtest.h>

#include <functional>
#include <set>

#include "RandomRecords.h"
#include "shared/replica/Checksum.h"

namespace naiad {
namespace {

using test::RandomRecords;

std::uint64_t sumOf(std::uint32_t id, std::uint8_t generation, const ObjectState& state) {
  return lifeSum(id, generation, state.order) + motionSum(id, state.motion) + lookSum(id, state.look) +
         bodySum(id, state.body);
}

TEST(Checksum, SumDoesNotDependOnTheMotionsBaseTick) {
  RandomRecords random(1);
  for (int i = 0; i < 2000; ++i) {
    const auto tick = static_cast<std::uint32_t>(random.rng().below(1u << 30));
    const Motion motion = random.motion(tick);
    const Motion later = rebase(motion, tick + static_cast<std::uint32_t>(random.rng().below(1u << 20)));
    ASSERT_EQ(motionSum(5, motion), motionSum(5, later));
    Motion moved = later;
    moved.position.x += 1;
    ASSERT_NE(motionSum(5, motion), motionSum(5, moved));
  }
}

TEST(Checksum, EveryFieldChangesTheSum) {
  ObjectState state{7,
                    {100, {df::fromCells(10), 5}, {3, 4}, {1, 2}},
                    {{{{0, 0, U'@', df::CYAN}, {256, 0, U'>', df::CYAN}}}, 2},
                    {}};
  state.look.selector = Selector::fixed(0);
  const auto drawn = [](Appearance changed) {
    return [changed](ObjectState& s) { s.look.sequence = {changed}; };
  };
  const auto chosen = [](const Selector& selector) {
    return [selector](ObjectState& s) {
      s.look.sequence = {s.look.sequence[0], {}};
      s.look.selector = selector;
    };
  };
  const Appearance before = state.look.sequence[0];
  const Glyph a = before[0], b = before[1];
  const std::function<void(ObjectState&)> changes[] = {
      [](ObjectState&) {},
      [](ObjectState& s) { s.order = 8; },
      [](ObjectState& s) { s.motion.tick = 101; },
      [](ObjectState& s) { s.motion.position.x += 1; },
      [](ObjectState& s) { s.motion.position.y += 1; },
      [](ObjectState& s) { std::swap(s.motion.position.x, s.motion.position.y); },
      [](ObjectState& s) { s.motion.velocity.x += 1; },
      [](ObjectState& s) { s.motion.velocity.y += 1; },
      [](ObjectState& s) { s.motion.acceleration.x += 1; },
      [](ObjectState& s) { s.motion.acceleration.y += 1; },
      [](ObjectState& s) { s.look.altitude = 3; },
      [](ObjectState& s) { s.look.sequence = {}; },
      drawn({}),
      drawn({a}),
      drawn({b, a}),
      drawn({{1, 0, a.ch, a.color}, b}),
      drawn({{0, 1, a.ch, a.color}, b}),
      drawn({{0, 0, U'A', a.color}, b}),
      drawn({{0, 0, a.ch, df::RED}, b}),
      drawn({a, {256, 0, b.ch, df::RED}}),
      [&](ObjectState& s) {
        s.look.sequence = {before, before};
      },
      [&](ObjectState& s) {
        s.look.sequence = {{}, before};
      },
      chosen(Selector::fixed(0)),
      chosen(Selector::fixed(1)),
      chosen(Selector::clock(0, 1)),
      chosen(Selector::clock(1, 1)),
      chosen(Selector::clock(0, 2)),
      chosen(Selector::clock(0, 1, false)),
      chosen(Selector::clock(5, 1, false)),
      chosen(Selector::clock(0, 2, false)),
      chosen(Selector::turning(0, 0, 0)),
      chosen(Selector::turning(0, 1, 0)),
      chosen(Selector::turning(0, 0, 1)),
      chosen(Selector::turning(0, 1, -1)),
      [](ObjectState& s) { s.body.box.corner.x += 1; },
      [](ObjectState& s) { s.body.box.corner.y += 1; },
      [](ObjectState& s) { s.body.box.size.x += 1; },
      [](ObjectState& s) { s.body.box.size.y += 1; },
      [](ObjectState& s) { s.body.solidness = df::SOFT; },
      [](ObjectState& s) { s.body.solidness = df::SPECTRAL; },
      [](ObjectState& s) { s.body.no_soft = true; },
      [](ObjectState& s) {
        s.body = {s.body.box, df::SPECTRAL, s.body.no_soft, true};
      },
  };
  std::set<std::uint64_t> sums;
  for (const auto& change : changes) {
    ObjectState changed = state;
    change(changed);
    sums.insert(sumOf(5, 1, changed));
  }
  EXPECT_EQ(sums.size(), std::size(changes));
  sums.insert(sumOf(6, 1, state));
  sums.insert(sumOf(5, 2, state));
  EXPECT_EQ(sums.size(), std::size(changes) + 2);
}

TEST(Checksum, SumDoesNotDependOnTheLooksSendTick) {
  RandomRecords random(3);
  for (int i = 0; i < 2000; ++i) {
    const Look look = random.look();
    if (look.selector.kind == Selector::kClockOnce) continue;
    const Look later = rebase(look, static_cast<std::uint32_t>(random.rng().below(1u << 30)));
    ASSERT_EQ(lookSum(5, look), lookSum(5, later));
  }
}

TEST(Checksum, IdsChangeTheSumOfEveryGroup) {
  const ObjectState state;
  EXPECT_NE(lifeSum(1, 0, 0), lifeSum(2, 0, 0));
  EXPECT_NE(motionSum(1, state.motion), motionSum(2, state.motion));
  EXPECT_NE(lookSum(1, state.look), lookSum(2, state.look));
  EXPECT_NE(bodySum(1, state.body), bodySum(2, state.body));
}

}  // namespace
}  // namespace naiad

#include <gtest/gtest.h>

#include <map>
#include <string>

#include "SimulatedWorld.h"
#include "host/snapshot/Interest.h"
#include "tests/support/Sanitizers.h"

namespace naiad {
namespace {

/// A window that stays, slides and jumps at random.
class Window {
 public:
  explicit Window(SplitMix64& rng) : m_rng(rng) {}

  CellRect next() {
    if (m_rng.below(40) == 0) m_dx = static_cast<std::int64_t>(m_rng.below(5)) - 2;
    if (m_rng.below(40) == 0) m_dy = static_cast<std::int64_t>(m_rng.below(3)) - 1;
    if (m_rng.below(20) == 0) m_dx = m_dy = 0;
    m_left += m_dx;
    m_top += m_dy;
    if (m_rng.below(60) == 0 || m_left < -60 || m_left > 160 || m_top < -40 || m_top > 80) {
      m_left = static_cast<std::int64_t>(m_rng.below(120)) - 20;
      m_top = static_cast<std::int64_t>(m_rng.below(60)) - 10;
    }
    return {m_left, m_top, m_left + 40, m_top + 20};
  }

 private:
  SplitMix64& m_rng;
  std::int64_t m_left = 10;
  std::int64_t m_top = 10;
  std::int64_t m_dx = 0;
  std::int64_t m_dy = 0;
};

// Checks in every tick: an object that isVisible() accepts is known, and an object that was not accepted,
// with kHysteresis, for more than kSearchInterval ticks is not known.
void expectPlain(const test::WorldConfig& config, std::uint64_t seed, bool stands, std::size_t& compared) {
  SplitMix64 rng(seed);
  test::SimulatedWorld world(config, seed);
  Publisher publisher;
  Interest interest;
  KnownObjects known;
  Window window(rng);
  CellRect rect = window.next();
  std::map<std::uint64_t, std::uint32_t> near;  // slot and generation -> last tick in which it was accepted
  for (int i = 0; i < 300; ++i) {
    world.tick(i % 100 > 60);
    publisher.update(world.view());
    if (!stands) rect = window.next();
    const std::uint32_t tick = publisher.tick();
    const df::ObjectKey own = world.view().players[0].followed;
    interest.update(publisher, {rect, {own, {}}, 4, static_cast<std::uint32_t>(seed)}, known);
    publisher.forEach([&](std::uint32_t slot, const Publisher::Model& model) {
      const std::uint32_t id = known.find(slot);
      const bool is_known = id != KnownObjects::kNone && known.at(id).generation == model.generation;
      const bool is_own = own == df::ObjectKey{slot, model.generation};
      if (is_own || Interest::isVisible(model, tick, 4, rect)) {
        ASSERT_TRUE(is_known) << "tick " << tick << ", slot " << slot;
      }
      std::uint32_t& last = near[std::uint64_t{slot} << 32 | model.generation];
      if (is_own || Interest::isVisible(model, tick, 4, rect.grownBy(Interest::kHysteresis))) last = tick;
      if (is_known) {
        ++compared;
        ASSERT_LE(tick - last, Interest::kSearchInterval) << "tick " << tick << ", slot " << slot;
      }
    });
    known.forEachAlive([&](std::uint32_t, const KnownObjects::Known& one) {
      const Publisher::Model* model = publisher.find(one.slot);
      ASSERT_TRUE(model != nullptr && model->generation == one.generation) << "tick " << tick;
    });
    if (testing::Test::HasFatalFailure()) return;
  }
}

TEST(Interest, EqualsThePlainRuleInEveryTick) {
  std::size_t compared = 0;
  for (std::uint64_t seed = 0; seed < 120 / test::kShare; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    test::WorldConfig config;
    config.objects = 20 + 5 * (seed % 30);
    config.turn = config.vanish = config.block = 0.02 * static_cast<double>(seed % 4);
    expectPlain(config, seed, seed % 3 == 0, compared);
    if (testing::Test::HasFatalFailure()) return;
  }
  EXPECT_GT(compared, 100'000u / test::kShare);
}

TEST(Interest, EqualsThePlainRuleWhereNothingEverTurns) {
  std::size_t compared = 0;
  for (std::uint64_t seed = 0; seed < 40 / test::kShare; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    test::WorldConfig config;
    config.objects = 150;
    config.turn = config.block = config.restyle = config.reshape = config.vanish = config.hide = 0;
    expectPlain(config, seed, seed % 2 == 0, compared);
    if (testing::Test::HasFatalFailure()) return;
  }
  EXPECT_GT(compared, 10'000u);
}

}  // namespace
}  // namespace naiad

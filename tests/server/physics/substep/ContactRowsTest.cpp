// Contact rows that are solved in parallel: each has the result that it would have alone, only pushes, and
// its friction stays within the cone.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <vector>

#include "physics/substep/ContactRows.h"
#include "tests/server/physics/SceneRandom.h"

namespace naiad::physics {
namespace {

constexpr float kSubstep = 0.25f;

struct Trial {
  ContactRow row;
  Manifold manifold;
  KnownImpulses known;
  SubstepState a, b;
  float kick = 0;  // speed that a sub-step adds to b along y
};

Trial trialOf(std::uint64_t seed) {
  test::SceneRandom numbers{seed};
  const auto number = [&](double low, double high) { return static_cast<float>(numbers.between(low, high)); };
  const auto chance = [&](double part) { return numbers() < part; };
  Trial trial;
  ContactRow& row = trial.row;
  row.is_held = chance(0.4);
  if (!row.is_held) {
    row.inverse_mass_a = number(0.1, 3);
    row.inverse_inertia_a = number(0.1, 9);
    row.spin_a = number(-0.1, 0.1);
  }
  row.inverse_mass_b = number(0.1, 3);
  row.inverse_inertia_b = number(0.1, 9);
  row.spin_b = number(-0.1, 0.1);
  row.velocity = {numbers.between(-0.3, 0.3), numbers.between(-0.3, 0.3)};
  row.friction = number(0, 1);
  row.restitution = chance(0.5) ? number(0.1, 1) : 0;
  row.max_push = 0.1f;
  row.rest = 0.02f;
  const double angle = numbers.between(-3, 3);
  trial.manifold.normal = {std::cos(angle), std::sin(angle)};
  trial.manifold.count = chance(0.6) ? 2 : 1;
  for (std::size_t i = 0; i < 2; ++i) {
    ManifoldPoint& point = trial.manifold.points[i];
    point.anchor_a = {numbers.between(-0.5, 0.5), numbers.between(-0.5, 0.5)};
    point.anchor_b = {numbers.between(-0.5, 0.5), numbers.between(-0.5, 0.5)};
    point.separation = numbers.between(-0.05, 0.05);
    if (static_cast<int>(i) >= trial.manifold.count || chance(0.3)) continue;
    trial.known.normal[i].kept = number(0, 0.05);
    trial.known.friction[i].kept = number(-0.01, 0.01);
  }
  trial.a.spin = row.spin_a;
  trial.b.spin = row.spin_b;
  row.is_lasting = chance(0.5);
  if (!row.is_lasting) return trial;
  row.fast = 0.1f;
  for (std::size_t i = 0; i < 2; ++i) {
    trial.known.normal[i].trend = number(-0.02, 0.02);
    trial.known.friction[i].trend = number(-0.01, 0.01);
  }
  return trial;
}

struct Outcome {
  std::vector<std::uint32_t> bits;  // bits of both bodies and the impulses
  KnownImpulses known;
  ContactPush pushed;
};

void moveState(SubstepState& s) {
  s.x += kSubstep * s.vx, s.y += kSubstep * s.vy;
  s.c = std::cos(kSubstep * s.spin), s.s = std::sin(kSubstep * s.spin);
}

// Solves all trials in one step. The rows of a colour are divided into blocks of `in_block` rows.
std::vector<Outcome> stepOf(const std::vector<Trial>& trials, std::size_t in_block) {
  std::vector<SubstepState> states(1);
  ContactRows rows;
  rows.clear(trials.size(), kSubstep);
  std::vector<std::int32_t> places;
  std::vector<ContactRow> packed;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    ContactRow row = trials[i].row;
    if (!row.is_held) {
      row.a = static_cast<std::int32_t>(states.size());
      states.push_back(trials[i].a);
    }
    row.b = static_cast<std::int32_t>(states.size());
    states.push_back(trials[i].b);
    if (i % in_block == 0) rows.beginBlock();
    places.push_back(rows.add(row, trials[i].manifold, trials[i].known));
    packed.push_back(row);
    if ((i + 1) % in_block == 0 || i + 1 == trials.size()) rows.finishBlock();
  }
  float time = 0;
  for (int i = 0; i < 4; ++i) {
    for (std::size_t k = 0; k < trials.size(); ++k) {
      states[static_cast<std::size_t>(packed[k].b)].vy += trials[k].kick;
    }
    rows.warmStart(states);
    rows.solve(states, kSubstep, time, true);
    for (std::size_t s = 1; s < states.size(); ++s) moveState(states[s]);
    time += kSubstep;
    rows.solve(states, kSubstep, time, false);
  }
  rows.bounce(states);
  std::vector<Outcome> outcomes;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    Outcome outcome;
    outcome.pushed = rows.read(places[i], outcome.known);
    const auto note = [&](float x) { outcome.bits.push_back(std::bit_cast<std::uint32_t>(x + 0.0f)); };
    for (const std::int32_t s : {packed[i].a, packed[i].b}) {
      const SubstepState& state = states[static_cast<std::size_t>(s)];
      for (const float x : {state.vx, state.vy, state.spin, state.x, state.y}) note(x);
    }
    const KnownImpulses& j = outcome.known;
    for (const auto& known : {j.normal[0], j.normal[1], j.friction[0], j.friction[1]}) {
      note(known.kept);
      note(known.trend);
    }
    for (const float x : {outcome.pushed.total, outcome.pushed.first}) note(x);
    outcomes.push_back(outcome);
  }
  return outcomes;
}

TEST(ContactRows, BatchedRowsMatchSingleRows) {
  std::vector<Trial> trials;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) trials.push_back(trialOf(seed));
  const std::vector<Outcome> alone = stepOf(trials, 1);
  for (const std::size_t in_block : {2U, 3U, 4U}) {
    const std::vector<Outcome> beside = stepOf(trials, in_block);
    int different = 0;
    for (std::size_t i = 0; i < trials.size(); ++i) different += alone[i].bits == beside[i].bits ? 0 : 1;
    EXPECT_EQ(different, 0) << in_block << " in a block";
  }
}

TEST(ContactRows, ContactsOnlyPushAndFrictionStaysInCone) {
  int pushing = 0, sliding = 0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    const Trial trial = trialOf(seed);
    const Outcome outcome = stepOf({trial}, 1)[0];
    EXPECT_GE(outcome.pushed.total, 0) << seed;
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_GE(outcome.known.normal[i].kept, 0) << seed;
      pushing += outcome.known.normal[i].kept > 0 ? 1 : 0;
    }
  }
  EXPECT_GT(pushing, 50);
  // The bodies are pressed together by 0.2 per tick: the limit of friction is given by this normal impulse.
  for (const float slip : {0.0f, 0.1f, 1.0f}) {
    Trial trial;
    ContactRow& row = trial.row;
    row.is_held = true;
    row.inverse_mass_b = 1, row.inverse_inertia_b = 0;
    row.friction = 0.5f;
    row.max_push = 0.1f;
    row.velocity = {slip, 0};
    trial.kick = 0.05f;
    trial.known.normal[0].kept = 0.05f;
    trial.manifold.normal = {0, -1};  // b lies above
    trial.manifold.count = 1;
    trial.manifold.points[0].anchor_b = {0, 0.5};
    const Outcome outcome = stepOf({trial}, 1)[0];
    const float most = 0.5f * outcome.known.normal[0].kept;
    EXPECT_NEAR(outcome.known.normal[0].kept, 0.05f, 1e-4f) << slip;
    EXPECT_NEAR(outcome.pushed.total, 0.2f, 1e-3f) << slip;
    EXPECT_LE(std::fabs(outcome.known.friction[0].kept), most * 1.001f) << slip;
    sliding += slip > 0.5f && std::fabs(outcome.known.friction[0].kept) > 0.99f * most ? 1 : 0;
  }
  EXPECT_EQ(sliding, 1);
}

// Makes a body on a floor, pressed by `kick` in each sub-step. The known impulse is smaller by a tenth.
Trial lyingOne(float kick) {
  Trial trial;
  trial.row.is_held = true;
  trial.row.inverse_mass_b = 1;
  trial.row.max_push = 0.1f;
  trial.kick = -kick;
  trial.manifold.normal = {0, 1};  // b lies above
  trial.manifold.count = 1;
  trial.known.normal[0].kept = 0.9f * kick;
  trial.known.normal[0].trend = 0.1f * kick;
  return trial;
}

TEST(ContactRows, TrendFadesUnderConstantPush) {
  Trial trial = lyingOne(0.05f);
  trial.row.is_lasting = true;
  float most = trial.known.normal[0].trend;
  for (int step = 0; step < 20; ++step) {
    trial.known = stepOf({trial}, 1)[0].known;
    most *= 0.5f;
    EXPECT_LE(std::fabs(trial.known.normal[0].trend), most + 1e-7f) << step;
  }
  EXPECT_NEAR(trial.known.normal[0].kept, 0.05f, 1e-6f);
}

TEST(ContactRows, OnlyLastingContactsUseTheTrend) {
  for (const bool is_lasting : {false, true}) {
    Trial trial = lyingOne(0.05f), flat = trial;
    trial.row.is_lasting = flat.row.is_lasting = is_lasting;
    flat.known.normal[0].trend = 0;
    EXPECT_EQ(stepOf({trial}, 1)[0].bits == stepOf({flat}, 1)[0].bits, !is_lasting);
  }
}

// A contact that did not push before ignores its stored trend.
TEST(ContactRows, NewImpactIgnoresAStoredTrend) {
  Trial trial = lyingOne(0), flat;
  trial.row.is_lasting = true;
  trial.row.velocity = {0, -0.3};
  trial.known.normal[0] = {};
  flat = trial;
  trial.known.normal[0].trend = 0.01f;
  EXPECT_EQ(stepOf({trial}, 1)[0].bits[6], stepOf({flat}, 1)[0].bits[6]);
}

TEST(ContactRows, FastImpactIsNotSoftened) {
  for (const float fast : {0.1f, 1.0f}) {
    Trial trial = lyingOne(0);
    trial.row.is_lasting = true;
    trial.row.fast = fast;
    trial.row.velocity = {0, -0.3};
    trial.known.normal[0] = {};
    const float y = std::bit_cast<float>(stepOf({trial}, 1)[0].bits[9]) - 0.3f;
    if (fast < 0.3f)
      EXPECT_NEAR(y, 0, 1e-6f);
    else
      EXPECT_LT(y, -1e-3f);
  }
}

TEST(ContactRows, GapClosesButNoFurther) {
  for (const float speed : {0.05f, 0.5f, 5.0f}) {
    Trial trial;
    ContactRow& row = trial.row;
    row.is_held = true;
    row.inverse_mass_b = 1;
    row.velocity = {0, -speed};
    trial.manifold.normal = {0, 1};
    trial.manifold.count = 1;
    trial.manifold.points[0].separation = 0.1;
    const Outcome outcome = stepOf({trial}, 1)[0];
    const float y = std::bit_cast<float>(outcome.bits[9]);  // movement of b, less that by its first velocity
    EXPECT_NEAR(y - speed, speed < 0.1f ? -0.05f : -0.1f, 1e-5f) << speed;
  }
}

TEST(ContactRows, OverlapIsResolvedWithinTheSpeedLimit) {
  Trial trial = lyingOne(0);
  trial.manifold.points[0].separation = -5;
  const Outcome outcome = stepOf({trial}, 1)[0];
  const float y = std::bit_cast<float>(outcome.bits[9]);
  EXPECT_GT(y, 0.01f);
  EXPECT_LE(y, 0.1f * 1.001f);
  EXPECT_NEAR(std::bit_cast<float>(outcome.bits[6]), 0, 1e-6f);  // no speed remains
}

}  // namespace
}  // namespace naiad::physics

// SOFT bodies: they get every begin and end of a contact on their path, and distant bodies need no work.
#include <algorithm>
#include <set>
#include <tuple>

#include "tests/server/physics/BodyScene.h"

namespace df {
namespace {

using test::Listener;

class BodySensorScene : public test::BodyScene {};

// A circle on a straight path, moved by the test itself.
struct Track {
  Listener* p_body = nullptr;
  double x = 0, y = 0, vx = 0, vy = 0, radius = 0;
  bool is_soft = false;
};

// Returns the smallest gap of two tracks during a tick, and the gap at the end of the tick.
std::pair<double, double> gapsOf(const Track& a, const Track& b) {
  const double x = b.x - a.x, y = b.y - a.y, vx = b.vx - a.vx, vy = b.vy - a.vy, square = vx * vx + vy * vy;
  const double when = square > 0 ? std::clamp(-(x * vx + y * vy) / square, 0.0, 1.0) : 0;
  const auto gapAt = [&](double t) { return std::hypot(x + t * vx, y + t * vy) - a.radius - b.radius; };
  return {gapAt(when), gapAt(1)};
}

TEST_F(BodySensorScene, ContactEventsMatchEveryPairsPaths) {
  std::uint32_t seed = 1;
  const auto part = [&] { return ((seed = seed * 1664525 + 1013904223) >> 8) / 16777216.0; };
  std::vector<Track> tracks(80);
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    Track& t = tracks[i];
    t = {nullptr, 40 * part() - 20, 40 * part() - 20, 0, 0, 0.3 + part(), i % 4 != 0};
    const double speed = i % 5 == 0 ? 0 : i % 7 == 0 ? 30 : 1;
    t.vx = speed * (2 * part() - 1), t.vy = speed * (2 * part() - 1);
    t.p_body = ball<Listener>(Vector(t.x, t.y), Vector(30 * t.vx, 30 * t.vy), t.radius);
    t.p_body->setContactEnds();
    t.p_body->setKinematic(true);
    if (t.is_soft) t.p_body->setSolidness(SOFT);
  }
  std::set<std::pair<std::size_t, std::size_t>> touching;
  int begins = 0, ends = 0;
  for (int tick = 0; tick < 60; ++tick) {
    using Note = std::tuple<const Object*, const Object*, bool>;
    std::vector<Note> expected, heard;
    for (std::size_t i = 0; i < tracks.size(); ++i) {
      for (std::size_t j = i + 1; j < tracks.size(); ++j) {
        if (!tracks[i].is_soft && !tracks[j].is_soft) continue;
        const auto [least, last] = gapsOf(tracks[i], tracks[j]);
        ASSERT_GT(std::min(std::fabs(least), std::fabs(last)), 1e-7) << "another seed would be clearer";
        const bool was = touching.count({i, j}) > 0;
        if (!was && least <= 0) expected.emplace_back(tracks[i].p_body, tracks[j].p_body, true);
        if ((was || least <= 0) && last > 0) expected.emplace_back(tracks[i].p_body, tracks[j].p_body, false);
        last <= 0 ? void(touching.insert({i, j})) : void(touching.erase({i, j}));
      }
    }
    ticks(1);
    for (Track& t : tracks) {
      for (const Listener::Note& note : t.p_body->notes) {
        if (note.p_first == t.p_body) heard.emplace_back(note.p_first, note.p_second, note.is_begin);
        note.is_begin ? ++begins : ++ends;
      }
      t.p_body->notes.clear();
      t.x += t.vx, t.y += t.vy;
    }
    std::sort(expected.begin(), expected.end());
    std::sort(heard.begin(), heard.end());
    ASSERT_EQ(heard, expected) << "tick " << tick;
  }
  EXPECT_GT(begins, 150);
  EXPECT_GT(ends, 150);
}

TEST_F(BodySensorScene, TeleportedObjectEndsItsContacts) {
  auto* p_soft = ball<Listener>(Vector(0, 0), Vector(0, 0));
  p_soft->setSolidness(SOFT);
  p_soft->setContactEnds();
  auto* p_ball = ball<Listener>(Vector(0.5, 0), Vector(0, 0));
  Object* p_mist = wall(Vector(-0.5, 0), Vector(0.5, 0.5));
  ticks(2);
  ASSERT_EQ(p_soft->notes.size(), 2u);
  p_ball->setPosition(Vector(1000, 0));
  p_mist->setPosition(Vector(-1000, 0));
  ticks(1);
  ASSERT_EQ(p_soft->notes.size(), 4u);
  EXPECT_FALSE(p_soft->notes[2].is_begin);
  EXPECT_FALSE(p_soft->notes[3].is_begin);
}

// The scene has more than three hundred slots and two thousand pairs.
TEST_F(BodySensorScene, CrowdedSensorsGetEachBeginAndEndOnce) {
  constexpr std::size_t kCount = 66;
  for (int i = 0; i < 250; ++i) ball(Vector(-10 - 2 * i, 0), Vector(0, 0));
  std::vector<Listener*> bodies;
  for (std::size_t i = 0; i < kCount; ++i) {
    auto* p_soft = ball<Listener>(Vector(0.01 * static_cast<double>(i % 8), 0), Vector(0, 0));
    p_soft->setSolidness(SOFT);
    p_soft->setContactEnds();
    bodies.push_back(p_soft);
  }
  ticks(3);
  for (const Listener* p_body : bodies) {
    ASSERT_EQ(p_body->notes.size(), kCount - 1);
    std::set<const Object*> others;
    for (const Listener::Note& note : p_body->notes) {
      EXPECT_TRUE(note.is_begin);
      others.insert(note.p_first == p_body ? note.p_second : note.p_first);
    }
    EXPECT_EQ(others.size(), kCount - 1);
  }
  for (std::size_t i = 0; i < kCount / 2; ++i) bodies[i]->setPosition(Vector(5, 0));
  ticks(3);
  for (const Listener* p_body : bodies) {
    EXPECT_EQ(p_body->ends(), static_cast<int>(kCount / 2));
    EXPECT_EQ(p_body->notes.size(), kCount - 1 + kCount / 2);
  }
}

TEST_F(BodySensorScene, DistantSensorsCheckFewPairs) {
  for (int i = 0; i < 1024; ++i) ball(Vector(3 * (i % 32), 3 * (i / 32)), Vector(3, 0))->setSolidness(SOFT);
  ticks(3);
  EXPECT_LE(naiad::physics::BodyLayer::of(world).sensorPairs(), 3 * 2 * 1024);
}

}  // namespace
}  // namespace df

// Crowds in one place. If no handler gets the collisions of a move, the move is decided without listing the
// Objects that it touches. The result must equal the result with handlers.
#include <cstdint>
#include <sstream>

#include "shared/values/SplitMix64.h"
#include "tests/server/engine/Probe.h"

namespace df::test {
namespace {

/// An Object with a handler that does nothing.
struct Listener : Object {
  int eventHandler(const Event*) override { return 0; }
};

/// An Object that records its collisions, with the positions of both Objects.
struct Diary : Object {
  explicit Diary(std::ostringstream& its_pages) : pages(its_pages) {}
  int eventHandler(const Event* p_e) override {
    if (p_e->getType() != COLLISION_EVENT) return 0;
    const auto* p_c = static_cast<const EventCollision*>(p_e);
    for (const Object* p_o : {p_c->getObject1(), p_c->getObject2()})
      pages << p_o->getId() << "@" << p_o->getPosition().getX() << "," << p_o->getPosition().getY() << " ";
    return 1;
  }
  std::ostringstream& pages;
};

struct Crowd {
  int objects = 200;
  int diaries = 0;          ///< how many of the Objects are Diaries
  double spread = 1;        ///< Objects are spread over this many cells on each axis
  double speed = 1;         ///< cells per tick; each component is at most half of it, in either direction
  bool mixed = false;       ///< SOFT, SPECTRAL and no-soft Objects, accelerations, and larger boxes
  bool options = false;     ///< some Objects may move out of each other
  int odd_every = 0;        ///< nonzero: every n-th Object is odd and passes through the others
  bool odd_is_hard = true;  ///< odd: HARD among SOFT Objects; else no-soft SOFT among HARD Objects
};

/// Runs a crowd. Returns positions, velocities and Diary entries after each tick. `ears`: every Object has a
/// handler.
std::vector<std::string> play(const Crowd& crowd, std::uint64_t seed, bool ears,
                              MoverStats* p_stats = nullptr) {
  naiad::SplitMix64 random(seed);
  std::ostringstream pages;
  LoggedWorld own;
  std::vector<Object*> all;
  const auto place = [&] { return crowd.spread * random.unit(); };
  for (int i = 0; i < crowd.objects; ++i) {
    Object* p_o = nullptr;
    if (i * crowd.diaries / crowd.objects != (i + 1) * crowd.diaries / crowd.objects) {
      p_o = new Diary(pages);
    } else {
      p_o = ears ? new Listener : new Object;
    }
    p_o->setPosition(Vector(40 + place(), 12 + place()));
    p_o->setVelocity(Vector(crowd.speed * (random.unit() - 0.5), crowd.speed * (random.unit() - 0.5)));
    if (crowd.mixed) {
      const std::uint64_t kind = random.below(10);
      p_o->setSolidness(kind < 5 ? HARD : kind < 9 ? SOFT : SPECTRAL);
      if (random.below(4) == 0) p_o->setNoSoft();
      if (random.below(8) == 0) p_o->setAcceleration(Vector(0.01, 0));
      if (random.below(8) == 0) p_o->setBox(df::Box(Vector(-1, -0.5), 2 + static_cast<float>(place()), 1));
    }
    if (crowd.odd_every > 0) {
      const bool odd = i % crowd.odd_every == 0;
      p_o->setSolidness(odd == crowd.odd_is_hard ? HARD : SOFT);
      p_o->setNoSoft(odd && !crowd.odd_is_hard);
    }
    if (crowd.options && random.below(3) == 0) p_o->setMayMoveOut();
    all.push_back(p_o);
  }
  std::vector<std::string> said;
  for (int tick = 0; tick < 20; ++tick) {
    own.world.tick();
    std::ostringstream line;
    line.precision(17);
    for (const Object* p_o : all) {
      line << p_o->getPosition().getX() << "," << p_o->getPosition().getY() << " "
           << p_o->getVelocity().getX() << ";";
    }
    line << pages.str();
    pages.str({});
    said.push_back(line.str());
  }
  if (p_stats != nullptr) *p_stats = own.world.store().moverStats();
  return said;
}

void expectTheSame(const Crowd& crowd) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const std::vector<std::string> unheard = play(crowd, seed, false);
    const std::vector<std::string> heard = play(crowd, seed, true);
    for (std::size_t tick = 0; tick < heard.size(); ++tick)
      ASSERT_EQ(unheard[tick], heard[tick]) << "seed " << seed << ", tick " << tick;
  }
}

TEST(Crowd, MovesMatchACrowdWithHandlersEverywhere) {
  const std::pair<const char*, Crowd> kCrowds[] = {
      {"hard ones", {}},
      {"that moves apart", {.spread = 12}},
      {"all kinds", {.spread = 2, .mixed = true}},
      {"a few hear", {.diaries = 3, .spread = 4, .mixed = true}},
      {"many hear", {.diaries = 100, .spread = 4, .mixed = true}},
      {"some may move out", {.diaries = 1, .spread = 2, .mixed = true, .options = true}},
  };
  for (const auto& [name, crowd] : kCrowds) {
    SCOPED_TRACE(name);
    expectTheSame(crowd);
  }
  for (const bool is_hard : {true, false}) {
    SCOPED_TRACE(is_hard ? "a hard one among soft ones" : "a soft one among hard ones");
    expectTheSame({.spread = 2, .speed = 0.1, .odd_every = 200, .odd_is_hard = is_hard});
    expectTheSame({.spread = 3, .speed = 0.1, .odd_every = 40, .odd_is_hard = is_hard});
    expectTheSame({.diaries = 2, .spread = 3, .speed = 0.1, .odd_every = 10, .odd_is_hard = is_hard});
  }
}

// The move of an odd Object needs no list of the crowd, whether or not other odd Objects are near.
TEST(Crowd, SoftCrowdIsNotListedForAHardObject) {
  for (const bool is_hard : {true, false}) {
    for (const int every : {1000, 20}) {
      MoverStats stats;
      const Crowd crowd = {
          .objects = 1000, .spread = 3, .speed = 0.01, .odd_every = every, .odd_is_hard = is_hard};
      play(crowd, 1, false, &stats);
      EXPECT_EQ(stats.met, 0u);
      EXPECT_GT(stats.unheard, 15'000u);
    }
  }
}

using WorldOfACrowd = WorldTest;

TEST_F(WorldOfACrowd, CountsStayCorrectWhenObjectsChangeOrLeave) {
  std::vector<Object*> soft;
  for (int i = 0; i < 200; ++i) {
    soft.push_back(new Object);
    soft.back()->setSolidness(SOFT);
    soft.back()->setPosition(Vector(40, 12));
  }
  auto* p_hard = new PlacedObject(Vector(40, 12));
  p_hard->setVelocity(Vector(0.001, 0));
  const auto moves = [&] {
    const Vector before = p_hard->getPosition();
    world.tick();
    return !(p_hard->getPosition() == before);
  };
  EXPECT_TRUE(moves());
  soft[0]->setSolidness(HARD);
  EXPECT_FALSE(moves());
  soft[0]->setSolidness(SPECTRAL);
  EXPECT_TRUE(moves());
  soft[0]->setSolidness(HARD);
  soft[0]->setActive(false);
  EXPECT_TRUE(moves());
  soft[0]->setActive(true);
  EXPECT_FALSE(moves());
  for (int i = 80; i < 200; ++i) WM.markForDelete(soft[static_cast<std::size_t>(i)]);  // closeGaps() runs
  EXPECT_FALSE(moves());
  WM.markForDelete(soft[0]);
  EXPECT_FALSE(moves());  // deletions come after the moves
  EXPECT_TRUE(moves());
  for (int i = 1; i < 80; ++i) soft[static_cast<std::size_t>(i)]->setPosition(Vector(10, 12));
  EXPECT_TRUE(moves());
  EXPECT_EQ(world.store().moverStats().met, 0u);
}

// An Object with a handler that is far away does not make the crowd slower.
TEST_F(WorldOfACrowd, DistantHandlerDoesNotSlowTheCrowd) {
  std::ostringstream pages;
  auto* p_far = new Diary(pages);
  p_far->setPosition(Vector(2, 2));
  for (int i = 0; i < 500; ++i) {
    auto* p_o = new PlacedObject(Vector(40, 12));
    p_o->setVelocity(Vector(0.1, 0));
  }
  world.tick();
  EXPECT_EQ(world.store().moverStats().unheard, 500u);
  p_far->setPosition(Vector(41, 12));
  world.tick();
  EXPECT_EQ(world.store().moverStats().unheard, 500u) << "it is touched, and has to hear of each";
  EXPECT_EQ(world.store().moverStats().met, 500u);
  EXPECT_FALSE(pages.str().empty());
}

}  // namespace
}  // namespace df::test

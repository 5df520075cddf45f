// Crowds in one place. Where nobody hears of a collision, a move in a crowd is decided without listing whom
// it touches; it must end as if all had been asked.
#include <cstdint>
#include <sstream>
#include <vector>

#include "shared/values/SplitMix64.h"
#include "tests/server/engine/Probe.h"

namespace df::test {
namespace {

/// It hears of everything, and does nothing.
struct Listener : Object {
  int eventHandler(const Event*) override { return 0; }
};

/// It writes down whom it collides with, and where they are then.
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
  int diaries = 0;       ///< of these, that hear of their collisions
  double spread = 1;     ///< cells that they are spread over, on each axis
  bool mixed = false;    ///< SOFT, SPECTRAL and no-soft ones, accelerations, and larger boxes
  bool options = false;  ///< and such as may move out of each other
};

/// After each tick, where all are, how fast, and what the diaries say. `ears`: everybody hears.
std::vector<std::string> play(const Crowd& crowd, std::uint64_t seed, bool ears,
                              MoverStats* p_stats = nullptr) {
  naiad::SplitMix64 random(seed);
  World world;
  const World::Scope scope(world);
  std::ostringstream pages;
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
    p_o->setVelocity(Vector(random.unit() - 0.5, random.unit() - 0.5));
    if (crowd.mixed) {
      const std::uint64_t kind = random.below(10);
      p_o->setSolidness(kind < 5 ? HARD : kind < 9 ? SOFT : SPECTRAL);
      if (random.below(4) == 0) p_o->setNoSoft();
      if (random.below(8) == 0) p_o->setAcceleration(Vector(0.01, 0));
      if (random.below(8) == 0) p_o->setBox(df::Box(Vector(-1, -0.5), 2 + static_cast<float>(place()), 1));
    }
    if (crowd.options && random.below(3) == 0) p_o->setMayMoveOut();
    all.push_back(p_o);
  }
  std::vector<std::string> said;
  for (int tick = 0; tick < 20; ++tick) {
    world.tick();
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
  if (p_stats != nullptr) *p_stats = world.moverStats();
  world.shutDown();
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

TEST(Crowd, OfHardObjects) {
  expectTheSame({});
}

TEST(Crowd, ThatMovesApart) {
  expectTheSame({.spread = 12});
}

TEST(Crowd, OfAllKinds) {
  expectTheSame({.spread = 2, .mixed = true});
}

TEST(Crowd, WithSomeWhoHear) {
  expectTheSame({.diaries = 3, .spread = 4, .mixed = true});
  expectTheSame({.diaries = 100, .spread = 4, .mixed = true});
}

TEST(Crowd, WithSomeWhoMayMoveOut) {
  expectTheSame({.diaries = 1, .spread = 2, .mixed = true, .options = true});
}

TEST(Crowd, OfManyHearsNothingOneByOne) {
  MoverStats stats;
  play({.objects = 2000}, 1, false, &stats);
  EXPECT_EQ(stats.met, 0u);
  EXPECT_GT(stats.unheard, 30'000u);
}

// Somebody elsewhere who hears does not make the crowd dearer.
TEST(Crowd, IsNotListedBecauseOfAHearerElsewhere) {
  World world;
  const World::Scope scope(world);
  std::ostringstream pages;
  auto* p_far = new Diary(pages);
  p_far->setPosition(Vector(2, 2));
  for (int i = 0; i < 500; ++i) {
    auto* p_o = new Object;
    p_o->setPosition(Vector(40, 12));
    p_o->setVelocity(Vector(0.1, 0));
  }
  world.tick();
  EXPECT_EQ(world.moverStats().unheard, 500u);
  p_far->setPosition(Vector(41, 12));
  world.tick();
  EXPECT_EQ(world.moverStats().unheard, 500u) << "it is touched, and has to hear of each";
  EXPECT_EQ(world.moverStats().met, 500u);
  EXPECT_FALSE(pages.str().empty());
  world.shutDown();
}

}  // namespace
}  // namespace df::test

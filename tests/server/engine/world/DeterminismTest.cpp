// A world is a pure function of its seed, inputs and tick count: a long run that uses everything the engine
// can do to Objects must have the expected hash with every compiler and optimisation level, and on every
// machine.
#include <gtest/gtest.h>

#include <cinttypes>
#include <cstdio>

#include "engine/events/EventOut.h"
#include "engine/events/EventStep.h"
#include "engine/managers/WorldManager.h"
#include "engine/world/EventCollision.h"
#include "shared/values/SplitMix64.h"
#include "tests/support/LoggedWorld.h"

namespace df::test {
namespace {

constexpr int kTicks = 3000;
constexpr std::uint64_t kHash = 0xbbf0e9000aa30fba;

class Recording : public LoggedWorld {
 public:
  Recording() {
    world.setSeed(20261121);
    WM.setBoundary(Box(Vector(-40, -20), 160, 60));
    for (int i = 0; i < 250; ++i) spawn();
  }

  void take(std::uint64_t value) { hash = (hash ^ value) * 0x9E3779B97F4A7C15ull + (hash >> 29); }
  void take(Vector v) {
    const FixedVector fixed = toFixed(v).value_or(FixedVector{});
    take(static_cast<std::uint64_t>(fixed.x));
    take(static_cast<std::uint64_t>(fixed.y));
  }
  double number(double low, double high) { return low + (high - low) * WM.randomInt(1 << 20) / (1 << 20); }
  /// Draws the coordinates one by one, because the order of evaluation of arguments is unspecified.
  Vector within(double left, double right, double top, double bottom) {
    const double x = number(left, right);
    return Vector(x, number(top, bottom));
  }
  void spawn();

  std::uint64_t hash = 1;
};

class Wanderer : public Object {
 public:
  explicit Wanderer(Recording& run) : m_run(run) {
    registerInterest(STEP_EVENT);
    setPosition(run.within(-40, 120, -20, 40));
    setVelocity(run.within(-2, 2, -1, 1));
    const int kind = WM.randomInt(20);
    setSolidness(kind < 9 ? HARD : kind < 16 ? SOFT : SPECTRAL);
    if (kind % 5 == 0) setBox(Box(Vector(-3, -1), 6, 2));
    if (kind % 7 == 0) setAcceleration(Vector(0, 0.02));
    if (kind == 3 || kind == 8) setSwept();
    if (kind == 3) setVelocity(run.within(-40, 40, -40, 40));
    if (kind == 5 || kind == 8) setMask({"#  # #", " ## # "});
    if (kind == 5 || kind == 11) setPrecise();
    if (kind == 12) setRestContacts();
    if (kind == 12) setVelocity(Vector());
    setMayMoveOut(kind % 3 == 0);
    setNoSoft(kind % 4 == 0);
  }

  int eventHandler(const Event* p_e) override {
    m_run.take(static_cast<std::uint64_t>(getId()));
    if (p_e->getType() == COLLISION_EVENT) {
      const auto* p_c = static_cast<const EventCollision*>(p_e);
      m_run.take(static_cast<std::uint64_t>(p_c->getObject1()->getId()) << 32 |
                 static_cast<std::uint64_t>(p_c->getObject2()->getId()));
      m_run.take(p_c->getPosition());
      const int what = WM.randomInt(40);
      if (what == 0) WM.markForDelete(this);
      if (what == 1) m_run.spawn();
      if (what == 2) WM.moveObject(this, getPosition() + Vector(1, 0.5));
      if (what < 8 && p_c->getObject1() == this) setVelocity(m_run.within(-2, 2, -1, 1));
      if (what == 9) setDirection(Vector(1, 1));
      if (what == 10) setSpeed(m_run.number(0, 3));
    } else if (p_e->getType() == OUT_EVENT) {
      setPosition(m_run.within(-40, 120, -20, 40));
      setVelocity(m_run.within(-2, 2, -1, 1));
    } else if (WM.getAllObjects().getCount() < 200 && WM.randomInt(50) == 0) {
      m_run.spawn();
    }
    return 1;
  }

 private:
  Recording& m_run;
};

void Recording::spawn() {
  new Wanderer(*this);
}

TEST(Determinism, LongRunHashIsTheSameForEveryCompiler) {
  Recording run;
  for (int tick = 0; tick < kTicks; ++tick) {
    run.world.tick();
    const ObjectList all = WM.getAllObjects(true);
    for (int i = 0; i < all.getCount(); ++i) {
      run.take(all[i]->getPosition());
      run.take(all[i]->getVelocity());
    }
  }
  run.take(static_cast<std::uint64_t>(WM.randomInt(1 << 30)));
  std::printf("determinism hash=%016" PRIx64 "\n", run.hash);
  EXPECT_EQ(run.hash, kHash);
}

}  // namespace
}  // namespace df::test

// Spinning boxes are shot at walls. At any speed, spin and length of the wall, no box passes through the
// wall, misses it, gains energy or is frozen.
#include <algorithm>
#include <array>
#include <set>

#include "physics/body/BodyLimits.h"
#include "shared/values/SplitMix64.h"
#include "tests/server/physics/BodyScene.h"
#include "tests/server/physics/SceneRandom.h"

namespace df::test {
namespace {

constexpr double kWidth = 0.6, kHeight = 0.1;  // size of the box
constexpr double kWallAt = 50, kHalfWall = 0.5;
constexpr double kHeavy = 100;

enum class WallKind { kStatic, kKinematic, kDynamic };
constexpr std::array<const char*, 3> kNames = {"static", "kinematic", "dynamic"};

struct Shot {
  WallKind kind = WallKind::kStatic;
  double length = 10;
  double speed = 1, spin = 0, angle = 0, y = 0;
  double restitution = 0, friction = 0;
  bool ends_inside = false;  // without contacts, the box would be in the wall at the end of the tick
};

std::ostream& operator<<(std::ostream& out, const Shot& shot) {
  out.precision(17);
  return out << kNames[static_cast<std::size_t>(shot.kind)] << " wall of " << shot.length << ", speed "
             << shot.speed << ", spin " << shot.spin << ", angle " << shot.angle << ", y " << shot.y
             << ", restitution " << shot.restitution << ", friction " << shot.friction
             << (shot.ends_inside ? ", ends a tick inside" : "");
}

Shot shotOf(int i) {
  constexpr std::array<double, 4> kSpins = {0, 1, 100, 1e5};
  constexpr std::array<double, 3> kBounces = {0, 0.3, 1};
  constexpr std::array<double, 5> kLengths = {10, 200, 3000, 40'000, 200'000};
  naiad::SplitMix64 random(static_cast<std::uint64_t>(i) + 1);
  const auto one = [&random] { return static_cast<double>(random.next() >> 11) * 0x1p-53; };
  const auto of = [&](const auto& all) {
    return all[static_cast<std::size_t>(one() * static_cast<double>(all.size()))];
  };
  Shot shot;
  shot.kind = of(std::array{WallKind::kStatic, WallKind::kKinematic, WallKind::kDynamic});
  shot.length = of(kLengths);
  shot.speed = std::pow(10, 6 * one());
  shot.spin = of(kSpins) * (one() < 0.5 ? 1 : -1);
  shot.angle = 0.37 * (i % 1000);
  shot.y = one() < 0.5 ? 0 : 0.4 * shot.length * (2 * one() - 1);
  shot.restitution = of(kBounces);
  shot.friction = one() < 0.5 ? 0 : 0.6;
  shot.ends_inside = one() < 0.3;
  return shot;
}

// True if the box is behind the wall, and within the wall's length.
bool isThrough(const Body* p_box, const Object* p_wall, double angle, double length) {
  const Vector d = p_box->getPosition() - p_wall->getPosition();
  const double c = std::cos(angle), s = std::sin(angle);
  const double across = c * d.x() + s * d.y(), along = c * d.y() - s * d.x();
  return across > kHalfWall && std::fabs(along) < 0.5 * length;
}

// Returns what is wrong; empty if nothing is.
std::set<std::string> shoot(const Shot& shot) {
  OwnWorld own;
  Object* p_wall = nullptr;
  Body* p_body = nullptr;
  if (shot.kind == WallKind::kStatic) {
    p_wall = BodyScene::wall(Vector(kWallAt, 0), Vector(kHalfWall, 0.5 * shot.length));
  } else {
    p_wall = p_body = new Body;
    p_body->setBoxShape(2 * kHalfWall, shot.length);
    p_body->setPosition(Vector(kWallAt, 0));
    p_body->setFriction(shot.friction);
    p_body->setRestitution(shot.restitution);
    if (shot.kind == WallKind::kKinematic) {
      p_body->setKinematic();
      p_body->setVelocity(Vector(-0.5 * shot.speed, 0));
    } else {
      p_body->setTurning();
      p_body->setMass(kHeavy);
    }
  }
  const double closing = shot.speed * (shot.kind == WallKind::kKinematic ? 1.5 : 1);
  const double room =
      shot.ends_inside ? closing * std::ceil(2 / closing) : std::min(kWallAt, 2 + 3 * closing);
  auto* p_box = new Listener;
  p_box->setBoxShape(kWidth, kHeight);
  p_box->setTurning();
  p_box->setPosition(Vector(kWallAt - room, shot.y));
  p_box->setAngle(shot.angle);
  p_box->setSpin(shot.spin);
  p_box->setVelocity(Vector(shot.speed, 0));
  p_box->setFriction(shot.friction);
  p_box->setRestitution(shot.restitution);
  const bool is_dynamic = shot.kind == WallKind::kDynamic;
  const auto energy = [&] {
    return BodyScene::kineticOf(p_box) + (is_dynamic ? BodyScene::kineticOf(p_body) : 0);
  };
  const double before = energy();
  const int arrival = static_cast<int>(std::ceil((room - kHalfWall) / closing));
  std::set<std::string> found;
  bool has_turned = false;  // the wall has turned so far that it shows its other side
  bool is_limited = false;  // the box's spin was limited, which reduces the energy
  for (int tick = 0; tick < arrival + 2; ++tick) {
    own.world.update();
    const double angle = is_dynamic ? p_body->getAngle() : 0;
    has_turned = has_turned || std::fabs(angle) > 0.5 || (is_dynamic && std::fabs(p_body->getSpin()) > 0.5);
    if (!has_turned && isThrough(p_box, p_wall, angle, shot.length)) found.insert("through");
    if (p_box->isFrozen() || (is_dynamic && p_body->isFrozen())) found.insert("frozen");
    is_limited = is_limited || std::fabs(p_box->getSpin()) >= kMaxSpin;
    const bool is_kept = shot.restitution == 1 && shot.friction == 0 && !is_limited;
    if (shot.kind == WallKind::kKinematic || found.contains("frozen")) continue;
    if (energy() > before * (1 + 1e-9)) found.insert("gained");
    if (is_kept && energy() < 0.99 * before) found.insert("lost");
  }
  if (p_box->notes.empty()) found.insert("unmet");
  return found;
}

TEST(BodyShot, ShotsDoNotPassThroughWalls) {
  int failures = 0;
  for (int i = 0; i < 2000 && failures < 10; ++i) {
    const Shot shot = shotOf(i);
    const std::set<std::string> found = shoot(shot);
    if (found.empty()) continue;
    ++failures;
    ADD_FAILURE() << "shot " << i << ": " << shot << ": " << testing::PrintToString(found);
  }
}

// A rotating rod that hits something is thrown by its own spin, farther than its speed would take it.
TEST(BodyShot, SpinningRodsStayInTheirRoom) {
  constexpr double kHalf = 30;
  naiad::physics::test::SceneRandom random;
  for (const double thickness : {0.2, 1.0}) {
    for (int scene = 0; scene < 16; ++scene) {
      OwnWorld own;
      for (const double side : {-1.0, 1.0}) {
        const double far = side * (kHalf + 0.5 * thickness);
        BodyScene::wall(Vector(0, far), Vector(kHalf + thickness, 0.5 * thickness));
        BodyScene::wall(Vector(far, 0), Vector(0.5 * thickness, kHalf + thickness));
      }
      std::vector<Body*> rods;
      for (int i = 0; i < 40; ++i) {
        Body* p_rod =
            BodyScene::turningCrate(Vector(-23.5 + 6.7 * (i % 8), -21 + 10.5 * (i / 8)), Vector(3, 0.05));
        p_rod->setRestitution(scene % 2);
        p_rod->setAngle(random.between(0, 6));
        p_rod->setSpin((i % 2 == 0 ? 1 : -1) * random.between(5, 15));
        p_rod->setVelocity(Vector(random.between(-1, 1), random.between(-1, 1)));
        rods.push_back(p_rod);
      }
      for (int tick = 0; tick < 10; ++tick) own.world.update();
      for (const Body* p_rod : rods) {
        EXPECT_LT(std::abs(p_rod->getPosition().x()), kHalf) << thickness << ' ' << scene;
        EXPECT_LT(std::abs(p_rod->getPosition().y()), kHalf) << thickness << ' ' << scene;
      }
    }
  }
}

}  // namespace
}  // namespace df::test

#include "SceneDraw.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace hunt {
namespace {

using Kind = Action::Kind;

constexpr std::array kBodySetters = {Kind::MASS,    Kind::RESTITUTION, Kind::FRICTION,  Kind::FRICTION,
                                     Kind::TURNING, Kind::KINEMATIC,   Kind::SOLIDNESS, Kind::VELOCITY,
                                     Kind::SPIN,    Kind::POSITION,    Kind::ANGLE,     Kind::GRAVITY_SCALE,
                                     Kind::DRAG,    Kind::SPRING,      Kind::CIRCLE,    Kind::BOX,
                                     Kind::IMPULSE, Kind::FORCE,       Kind::MARK_BODY, Kind::DELETE_BODY};
constexpr std::array kObstacleSetters = {Kind::DELETE_OBSTACLE, Kind::MOVE_OBSTACLE,
                                         Kind::OBSTACLE_SOLIDNESS};
constexpr std::array kJointSetters = {Kind::REMOVE_JOINT, Kind::JOINT_LENGTH,   Kind::JOINT_STIFFNESS,
                                      Kind::JOINT_SPEED,  Kind::JOINT_STRENGTH, Kind::JOINT_LIMITS,
                                      Kind::JOINT_TARGET};
constexpr std::array kWorldSetters = {Kind::GRAVITY, Kind::OBSTACLE_FRICTION, Kind::OBSTACLE_RESTITUTION,
                                      Kind::LEVEL, Kind::SLEEPING};

}  // namespace

TargetKind targetOf(Kind kind) {
  if (kind <= Kind::DELETE_BODY) return TargetKind::BODY;
  if (kind <= Kind::OBSTACLE_SOLIDNESS) return TargetKind::OBSTACLE;
  return kind <= Kind::JOINT_TARGET ? TargetKind::JOINT : TargetKind::WORLD;
}

bool displaces(Kind kind) {
  // Bodies that were joined may overlap, and collide when the joint is removed.
  constexpr std::array kDisplacing = {Kind::TURNING,       Kind::KINEMATIC,
                                      Kind::SOLIDNESS,     Kind::POSITION,
                                      Kind::ANGLE,         Kind::SPRING,
                                      Kind::CIRCLE,        Kind::BOX,
                                      Kind::MOVE_OBSTACLE, Kind::OBSTACLE_SOLIDNESS,
                                      Kind::REMOVE_JOINT,  Kind::JOINT_LENGTH,
                                      Kind::JOINT_LIMITS,  Kind::JOINT_TARGET,
                                      Kind::LEVEL};
  return std::find(kDisplacing.begin(), kDisplacing.end(), kind) != kDisplacing.end();
}

int SceneData::groupOf(const Action& action) const {
  const auto index = static_cast<std::size_t>(action.target);
  switch (targetOf(action.kind)) {
    case TargetKind::BODY:
      return bodies[index].group;
    case TargetKind::OBSTACLE:
      return obstacles[index].group;
    case TargetKind::JOINT:
      return groupOf(joints[index]);
    case TargetKind::WORLD:
      break;
  }
  return kNothing;
}

std::vector<Part> circle(double radius) {
  return {{.kind = Part::Kind::CIRCLE, .size = {radius, radius}}};
}

std::vector<Part> box(double width, double height) {
  return {{.kind = Part::Kind::BOX, .size = {width, height}}};
}

double SceneDraw::speed() {
  const double decade = oneOf({.01, .03, .1, .1, .1, .3, .3, 1, 3, 10});
  return decade * between(1, 3);
}

double SceneDraw::anyMass() {
  if (chance(.5)) return 1;
  const double decade = oneOf({1e-3, 1e-2, .1, 1, 1, 10, 100, 1e3, 1e4, 1e5});
  return decade * static_cast<double>(1 + below(10));
}

void SceneDraw::drawWorld() {
  m_scene.aspect = oneOf({1, 1, 1, 1, 2, 2, 2, 2, .5, 1.5});
  m_scene.level = chance(.5) ? df::ACCURACY_DEFAULT : df::ACCURACY_FAST;
  m_scene.sleeping = chance(.8);
  m_scene.gravity = {0, oneOf({0, .01, .01, .0111, .02, .05})};
  m_scene.obstacle_friction = oneOf({.5, .5, .5, 0, .1, 1});
  m_scene.obstacle_restitution = oneOf({0, 0, 0, 0, .3, 1});
  m_scene.ticks = 40 + below(61);
  m_material = below(5);
}

void SceneDraw::drawFamily(bool is_small) {
  struct Family {
    const char* name;
    int weight;
    void (SceneDraw::*draw)();
  };
  constexpr std::array<Family, 13> kFamilies = {{{"contact", 150, &SceneDraw::drawContact},
                                                 {"tiles", 120, &SceneDraw::drawTiles},
                                                 {"chain", 150, &SceneDraw::drawChain},
                                                 {"motor", 60, &SceneDraw::drawMotor},
                                                 {"fields", 70, &SceneDraw::drawFields},
                                                 {"zone", 80, &SceneDraw::drawZone},
                                                 {"shot", 60, &SceneDraw::drawShot},
                                                 {"elastic", 90, &SceneDraw::drawElastic},
                                                 {"mix", 120, &SceneDraw::drawMix},
                                                 {"push", 60, &SceneDraw::drawPush},
                                                 {"bars", 40, &SceneDraw::drawBars},
                                                 {"heap", 30, &SceneDraw::drawHeap},
                                                 {"planks", 4, &SceneDraw::drawPlanks}}};
  constexpr std::size_t kSmall = 6;  // the first families
  const std::span<const Family> families(kFamilies.data(), is_small ? kSmall : kFamilies.size());
  int chosen = below(std::accumulate(families.begin(), families.end(), 0,
                                     [](int sum, const Family& family) { return sum + family.weight; }));
  for (const Family& family : families) {
    chosen -= family.weight;
    if (chosen >= 0) continue;
    m_scene.family = family.name;
    (this->*family.draw)();
    return;
  }
}

int SceneDraw::addBody(Vec2 place, std::vector<Part> parts) {
  BodyData added;
  added.place = place;
  added.parts = std::move(parts);
  setMaterial(added);
  m_scene.bodies.push_back(std::move(added));
  return static_cast<int>(m_scene.bodies.size()) - 1;
}

int SceneDraw::addObstacle(Vec2 centre, Vec2 half, int row) {
  ObstacleData added;
  added.centre = centre;
  added.half = half;
  added.row = row;
  m_scene.obstacles.push_back(added);
  return static_cast<int>(m_scene.obstacles.size()) - 1;
}

JointData& SceneDraw::addJoint(JointData::Kind kind, int a, int b, Vec2 point) {
  JointData joint;
  joint.kind = kind;
  joint.a = a;
  joint.b = b;
  joint.point_a = joint.point_b = point;
  if (chance(.02)) joint.break_force = oneOf({.01, .1, 1});
  m_scene.joints.push_back(joint);
  return m_scene.joints.back();
}

JointData& SceneDraw::addLink(JointData::Kind kind, int a, int b, Vec2 world_point) {
  JointData& joint = addJoint(kind, a, b, {});
  joint.point_a = a == kNothing ? world_point : body(a).place;
  joint.point_b = body(b).place;
  return joint;
}

void SceneDraw::setSpring(JointData& joint, double mass) {
  joint.first = oneOf({.01, .1, 1, 10, 64, 1e3, 1e4, 1e6, 1e8, 1e12});
  const double critical = 2 * std::sqrt(joint.first * mass);
  joint.second = oneOf({0, 0, 0, .1, 1}) * critical;
}

void SceneDraw::setMaterial(BodyData& body) {
  switch (m_material) {
    case 1:
      body.restitution = 1;
      body.friction = 0;
      break;
    case 2:
      body.friction = 0;
      break;
    case 3:
      body.restitution = oneOf({0, .2, .5, .8, 1});
      body.friction = oneOf({0, .1, .3, .5, .8, 1.5});
      body.mass = anyMass();
      break;
    default:
      break;
  }
}

std::vector<Part> SceneDraw::anyPolygon(double radius) {
  // Corners in the directions of a regular polygon, each at its own distance: convex if these are similar.
  constexpr std::array<Vec2, 8> kDirections = {
      {{1, 0}, {.75, .66}, {0, 1}, {-.75, .66}, {-1, 0}, {-.75, -.66}, {0, -1}, {.75, -.66}}};
  Part part;
  part.kind = Part::Kind::POLYGON;
  const int step = chance(.5) ? 1 : 2;
  for (std::size_t i = 0; i < kDirections.size(); i += static_cast<std::size_t>(step)) {
    if (part.corners.size() > 3 && chance(.2)) continue;
    const double stretch = step == 1 ? between(.97, 1) : between(.6, 1);
    part.corners.push_back(radius * stretch * kDirections[i]);
  }
  return {part};
}

std::vector<Part> SceneDraw::anyShape(double radius) {
  switch (below(8)) {
    case 0:
    case 1:
      return circle(radius);
    case 2:
    case 3:
      return box(1.4 * radius, 1.4 * radius);
    case 4: {
      const double height = oneOf({.1, .3, .6}) * radius;
      return box(1.8 * radius, height);
    }
    case 5:
    case 6:
      return anyPolygon(radius);
    default: {  // a compound
      std::vector<Part> parts = box(1.2 * radius, .4 * radius);
      Part second;
      if (chance(.5)) {
        second = {.kind = Part::Kind::CIRCLE, .size = {.3 * radius, .3 * radius}, .centre = {.5 * radius, 0}};
      } else {
        second = {.kind = Part::Kind::BOX, .size = {.4 * radius, .4 * radius}, .centre = {0, -.4 * radius}};
        second.angle = between(-1, 1);
      }
      parts.push_back(second);
      return parts;
    }
  }
}

void SceneDraw::addFloor(double half_width) {
  addObstacle({0, .5}, {half_width, .5});
  m_scene.boundaries.push_back({Boundary::Kind::WALL_Y, {-half_width, 0}, {half_width, 1}, {}});
}

int SceneDraw::addTiles(Vec2 from, int count, double size, double gap, bool as_bodies, Vec2 velocity) {
  int row = 0;
  for (const ObstacleData& obstacle : m_scene.obstacles) row = std::max(row, obstacle.row + 1);
  for (const BodyData& other : m_scene.bodies) row = std::max(row, other.row + 1);
  for (int i = 0; i < count; ++i) {
    const Vec2 centre = from + Vec2{(i + .5) * size + i * gap, .5 * size};
    if (as_bodies) {
      const int tile = addBody(centre, box(size, size));
      body(tile).kinematic = true;
      body(tile).row = row;
      body(tile).velocity = velocity;
    } else {
      addObstacle(centre, {.5 * size, .5 * size}, row);
    }
  }
  return row;
}

void SceneDraw::addRoom(Vec2 half, double thickness, bool as_bodies, Vec2 velocity) {
  const double t = .5 * thickness;
  for (const Vec2 side : {Vec2{-1, 0}, Vec2{1, 0}, Vec2{0, -1}, Vec2{0, 1}}) {
    const Vec2 centre = {side.x * (half.x + t), side.y * (half.y + t)};
    const Vec2 size = side.x != 0 ? Vec2{t, half.y + thickness} : Vec2{half.x + thickness, t};
    if (as_bodies) {
      const int wall = addBody(centre, box(2 * size.x, 2 * size.y));
      body(wall).kinematic = true;
      body(wall).velocity = velocity;
    } else {
      addObstacle(centre, size);
    }
  }
  const Vec2 outside = half + Vec2{thickness, thickness};
  m_scene.boundaries.push_back({Boundary::Kind::ROOM, -outside, outside, velocity});
}

void SceneDraw::transpose() {
  const auto turn = [](Vec2& v) { std::swap(v.x, v.y); };
  turn(m_scene.gravity);
  for (BodyData& its : m_scene.bodies) {
    for (Vec2* p_v : {&its.place, &its.velocity, &its.anchor, &its.field_origin}) turn(*p_v);
    for (Part& part : its.parts) {
      turn(part.size);
      turn(part.centre);
      for (Vec2& corner : part.corners) turn(corner);
    }
  }
  for (ObstacleData& its : m_scene.obstacles) {
    turn(its.centre);
    turn(its.half);
  }
  for (Boundary& its : m_scene.boundaries) {
    for (Vec2* p_v : {&its.lower, &its.upper, &its.velocity}) turn(*p_v);
    if (its.kind != Boundary::Kind::ROOM)
      its.kind = its.kind == Boundary::Kind::WALL_X ? Boundary::Kind::WALL_Y : Boundary::Kind::WALL_X;
  }
}

void SceneDraw::turnOver() {
  const auto turn = [](Vec2& v) { v.y = -v.y; };
  turn(m_scene.gravity);
  for (BodyData& its : m_scene.bodies) {
    for (Vec2* p_v : {&its.place, &its.velocity, &its.anchor, &its.field_origin}) turn(*p_v);
    for (Part& part : its.parts) {
      turn(part.centre);
      for (Vec2& corner : part.corners) turn(corner);
    }
  }
  for (ObstacleData& its : m_scene.obstacles) turn(its.centre);
  for (Boundary& its : m_scene.boundaries) {
    for (Vec2* p_v : {&its.lower, &its.upper, &its.velocity}) turn(*p_v);
    std::swap(its.lower.y, its.upper.y);
  }
}

void SceneDraw::drawActions() {
  if (!chance(.35)) return;
  const int count = 1 + below(3);
  for (int i = 0; i < count; ++i) {
    const int tick = 2 + below(std::min(m_scene.ticks, 60));
    const int which = below(10);
    if (which < 2 && !m_scene.obstacles.empty()) {
      addAction(kObstacleSetters, tick);
    } else if (which < 4 && !m_scene.joints.empty()) {
      addAction(kJointSetters, tick);
    } else if (which < 5) {
      addAction(kWorldSetters, tick);
    } else {
      addAction(kBodySetters, tick);
    }
  }
}

void SceneDraw::addAction(std::span<const Kind> kinds, int tick) {
  Action action;
  action.tick = tick;
  action.kind = kinds[static_cast<std::size_t>(below(static_cast<int>(kinds.size())))];
  std::size_t targets = 1;
  if (targetOf(action.kind) == TargetKind::BODY) targets = m_scene.bodies.size();
  if (targetOf(action.kind) == TargetKind::OBSTACLE) targets = m_scene.obstacles.size();
  if (targetOf(action.kind) == TargetKind::JOINT) targets = m_scene.joints.size();
  if (targets == 0) return;
  action.target = below(static_cast<int>(targets));
  if (chance(.2)) {
    action.when = chance(.7) ? Action::When::BEGIN : Action::When::END;
    action.receiver = below(static_cast<int>(m_scene.bodies.size()));
    body(action.receiver).contact_ends = true;
  }
  drawValues(action);
  m_scene.actions.push_back(action);
}

void SceneDraw::drawValues(Action& action) {
  const Kind kind = action.kind;
  const Vec2 value = vectorUpTo(oneOf({.1, .3, 1}));  // velocities, displacements, forces, impulses
  action.x = value.x;
  action.y = value.y;
  if (kind == Kind::MASS) action.x = anyMass();
  if (kind == Kind::RESTITUTION || kind == Kind::OBSTACLE_RESTITUTION) action.x = oneOf({0, .3, 1});
  if (kind == Kind::FRICTION || kind == Kind::OBSTACLE_FRICTION) action.x = oneOf({0, 0, .1, .5, 1});
  if (kind == Kind::TURNING || kind == Kind::KINEMATIC || kind == Kind::SLEEPING || kind == Kind::LEVEL)
    action.x = below(2);
  if (kind == Kind::SOLIDNESS || kind == Kind::OBSTACLE_SOLIDNESS)
    action.x = oneOf({df::HARD, df::SOFT, df::SPECTRAL});
  if (kind == Kind::GRAVITY_SCALE) action.x = oneOf({0, .5, 1, -1, 2});
  if (kind == Kind::DRAG) action.x = oneOf({0, .01, .1});
  if (kind == Kind::SPRING || kind == Kind::JOINT_STIFFNESS)
    action.x = oneOf({0, .01, 1, 100, 1e6}), action.y = oneOf({0, 0, .1});
  if (kind == Kind::JOINT_STRENGTH || kind == Kind::JOINT_LENGTH) action.x = between(.5, 2);
  if (kind == Kind::JOINT_SPEED) action.x = oneOf({-.1, 0, .03, .1});
  if (kind == Kind::CIRCLE) action.x = between(.2, .6);
  if (kind == Kind::BOX) action.x = between(.3, 1.2);
  if (kind == Kind::BOX || kind == Kind::JOINT_LIMITS) action.y = between(.3, 1.2);
  if (kind == Kind::JOINT_LIMITS) action.x = -between(0, 1);
  if (kind == Kind::GRAVITY) action.x = 0;
  if (kind == Kind::GRAVITY) action.y = oneOf({0, .01, -.01, .05});
}

SceneData drawScene(std::uint64_t seed) {
  SceneData scene;
  scene.seed = seed;
  SceneDraw draw(scene, seed);
  draw.drawWorld();
  draw.drawFamily(false);
  if (scene.ticks < 1000) draw.drawActions();
  return scene;
}

void addDistantGroup(SceneData& scene) {
  constexpr Vec2 kFar = {4000, 300};
  SceneData other;
  SceneDraw draw(other, ~scene.seed);
  draw.drawWorld();
  draw.drawFamily(true);
  const int bodies = static_cast<int>(scene.bodies.size());
  const int fields = static_cast<int>(scene.fields.size());
  const double drift = scene.seed % 5 == 0 ? 1000 : 0;  // some groups fly away
  for (BodyData& its : other.bodies) {
    its.group = 1;
    its.velocity.x += drift;
    for (Vec2* p_v : {&its.place, &its.anchor, &its.field_origin}) *p_v += kFar;
    if (its.field != kNothing) its.field += fields;
    scene.bodies.push_back(its);
  }
  for (ObstacleData& its : other.obstacles) {
    its.group = 1;
    its.centre += kFar;
    scene.obstacles.push_back(its);
  }
  for (JointData& its : other.joints) {
    for (Vec2* p_v : {&its.point_a, &its.point_b, &its.target}) *p_v += kFar;
    for (int* p_index : {&its.a, &its.b}) {
      if (*p_index != kNothing) *p_index += bodies;
    }
    scene.joints.push_back(its);
  }
  scene.fields.insert(scene.fields.end(), other.fields.begin(), other.fields.end());
  scene.later_groups_first = scene.seed % 2 == 0;
}

SceneData withoutSeams(const SceneData& scene) {
  SceneData merged = scene;
  const auto merge = [](auto& list, auto centreOf, auto halfOf, auto setTo) {
    for (std::size_t i = 0; i < list.size(); ++i) {
      if (list[i].row == kNothing || !list[i].present) continue;
      Vec2 lower = centreOf(list[i]) - halfOf(list[i]), upper = centreOf(list[i]) + halfOf(list[i]);
      for (std::size_t j = i + 1; j < list.size(); ++j) {
        if (list[j].row != list[i].row || !list[j].present) continue;
        const Vec2 low = centreOf(list[j]) - halfOf(list[j]), high = centreOf(list[j]) + halfOf(list[j]);
        lower = {std::min(lower.x, low.x), std::min(lower.y, low.y)};
        upper = {std::max(upper.x, high.x), std::max(upper.y, high.y)};
        list[j].present = false;
      }
      setTo(list[i], .5 * (lower + upper), .5 * (upper - lower));
    }
  };
  merge(
      merged.obstacles, [](const ObstacleData& its) { return its.centre; },
      [](const ObstacleData& its) { return its.half; },
      [](ObstacleData& its, Vec2 centre, Vec2 half) {
        its.centre = centre;
        its.half = half;
      });
  merge(
      merged.bodies, [](const BodyData& its) { return its.place; },
      [](const BodyData& its) { return .5 * its.parts[0].size; },
      [](BodyData& its, Vec2 centre, Vec2 half) {
        its.place = centre;
        its.parts = box(2 * half.x, 2 * half.y);
      });
  return merged;
}

}  // namespace hunt

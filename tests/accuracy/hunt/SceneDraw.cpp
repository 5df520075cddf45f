#include "SceneDraw.h"

#include <cmath>
#include <stdexcept>

namespace hunt {
namespace {

using enum TargetKind;

// Returns the names of the setters of a target in their order; friction is as likely as two others.
std::vector<const char*> namesOf(TargetKind target) {
  std::vector<const char*> names;
  for (const Setter& setter : setters()) {
    if (setter.target != target) continue;
    names.insert(names.end(), setter.name == "friction" ? 2 : 1, setter.name.data());
  }
  return names;
}

}  // namespace

const std::vector<Setter>& setters() {
  static const std::vector<double> kSwitch = {0, 1}, kFriction = {0, 0, .1, .5, 1}, kRestitution = {0, .3, 1};
  static const std::vector<double> kSolidness = {df::HARD, df::SOFT, df::SPECTRAL};
  static const std::vector<double> kStiffness = {0, .01, 1, 100, 1e6}, kDamping = {0, 0, .1};
  static const std::vector<Setter> kSetters = {
      {"mass", BODY, false},
      {"restitution", BODY, false, kRestitution},
      {"friction", BODY, false, kFriction},
      {"turning", BODY, true, kSwitch},
      {"kinematic", BODY, true, kSwitch},
      {"solidness", BODY, true, kSolidness},
      {"velocity", BODY, false},
      {"spin", BODY, false},
      {"position", BODY, true},
      {"angle", BODY, true},
      {"gravity scale", BODY, false, {0, .5, 1, -1, 2}},
      {"drag", BODY, false, {0, .01, .1}},
      {"spring", BODY, true, kStiffness, kDamping},
      {"circle", BODY, true, {.2, .6}, {}, true},
      {"box", BODY, true, {.3, 1.2}, {.3, 1.2}, true},
      {"impulse", BODY, false},
      {"force", BODY, false},
      {"mark", BODY, false},
      {"delete", BODY, false},
      {"delete obstacle", OBSTACLE, false},
      {"move obstacle", OBSTACLE, true},
      {"change obstacle", OBSTACLE, true, kSolidness},
      {"remove joint", JOINT, true},  // bodies that were joined may overlap
      {"length", JOINT, true, {.5, 2}, {}, true},
      {"stiffness", JOINT, false, kStiffness, kDamping},
      {"speed", JOINT, false, {-.1, 0, .03, .1}},
      {"strength", JOINT, false, {.5, 2}, {}, true},
      {"limits", JOINT, true, {.3, 1.2}, {0, -1}, true},  // upper, lower
      {"target", JOINT, true},
      {"gravity", WORLD, false, {}, {0, .01, -.01, .05}},
      {"all friction", WORLD, false, kFriction},  // of obstacles
      {"all restitution", WORLD, false, kRestitution},
      {"level", WORLD, true, kSwitch},
      {"sleeping", WORLD, false, kSwitch}};
  return kSetters;
}

const Setter& setterNamed(std::string_view name) {
  for (const Setter& setter : setters()) {
    if (setter.name == name) return setter;
  }
  throw std::logic_error("there is no setter " + std::string(name));
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

double SceneDraw::mass() {
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

BodyData& SceneDraw::addBody(Vec2 place, std::vector<Part> parts) {
  BodyData& added = m_scene.bodies.emplace_back();
  added.place = place;
  added.parts = std::move(parts);
  if (m_material == 1) added.restitution = 1;
  if (m_material == 1 || m_material == 2) added.friction = 0;
  if (m_material == 3) {
    added.restitution = oneOf({0, .2, .5, .8, 1});
    added.friction = oneOf({0, .1, .3, .5, .8, 1.5});
    added.mass = mass();
  }
  return added;
}

BodyData& SceneDraw::addObstacle(Vec2 centre, Vec2 half) {
  BodyData& added = m_scene.obstacles.emplace_back();
  added.place = centre;
  added.parts = box(2 * half.x, 2 * half.y);
  added.kinematic = true;
  return added;
}

BodyData& SceneDraw::addWall(Vec2 centre, Vec2 half, bool as_body, Vec2 velocity) {
  if (!as_body) return addObstacle(centre, half);
  BodyData& wall = addBody(centre, box(2 * half.x, 2 * half.y));
  wall.kinematic = true;
  wall.velocity = velocity;
  return wall;
}

void SceneDraw::addFloor(double half_width, double top) {
  addObstacle({0, .5 + top}, {half_width, .5});
  addBoundary(Boundary::Kind::WALL_Y, {-half_width, top}, {half_width, 1 + top});
}

void SceneDraw::addTiles(Vec2 from, int count, double size, double gap, bool as_bodies, Vec2 velocity) {
  int row = 0;
  for (const auto* p_list : {&m_scene.obstacles, &m_scene.bodies}) {
    for (const BodyData& its : *p_list) row = std::max(row, its.row + 1);
  }
  for (int i = 0; i < count; ++i) {
    const Vec2 centre = from + Vec2{(i + .5) * size + i * gap, .5 * size};
    addWall(centre, {.5 * size, .5 * size}, as_bodies, velocity).row = row;
  }
}

void SceneDraw::addRoom(Vec2 half, double thickness, bool as_bodies, Vec2 velocity) {
  const double t = .5 * thickness;
  for (const Vec2 side : {Vec2{-1, 0}, Vec2{1, 0}, Vec2{0, -1}, Vec2{0, 1}}) {
    const Vec2 size = side.x != 0 ? Vec2{t, half.y + thickness} : Vec2{half.x + thickness, t};
    addWall({side.x * (half.x + t), side.y * (half.y + t)}, size, as_bodies, velocity);
  }
  const Vec2 outside = half + Vec2{thickness, thickness};
  addBoundary(Boundary::Kind::ROOM, -outside, outside, velocity);
}

JointData& SceneDraw::addJoint(JointData::Kind kind, int a, int b, Vec2 point) {
  JointData& joint = m_scene.joints.emplace_back();
  joint.kind = kind;
  joint.a = a;
  joint.b = b;
  joint.point_a = joint.point_b = point;
  if (chance(.02)) joint.break_force = oneOf({.01, .1, 1});
  return joint;
}

JointData& SceneDraw::addLink(JointData::Kind kind, int a, int b, Vec2 world_point) {
  JointData& joint = addJoint(kind, a, b, body(b).place);
  joint.point_a = a == kNothing ? world_point : body(a).place;
  return joint;
}

void SceneDraw::setSpring(JointData& joint) {
  joint.first = oneOf({.01, .1, 1, 10, 64, 1e3, 1e4, 1e6, 1e8, 1e12});
  joint.second = oneOf({0, 0, 0, .1, 1}) * 2 * std::sqrt(joint.first);
}

std::vector<Part> SceneDraw::anyPolygon(double radius) {
  // Corners in the directions of a regular polygon, each at its own distance: convex if these are similar.
  constexpr Vec2 kDirections[] = {{1, 0},  {.75, .66},   {0, 1},  {-.75, .66},
                                  {-1, 0}, {-.75, -.66}, {0, -1}, {.75, -.66}};
  Part part{.kind = Part::Kind::POLYGON};
  const int step = chance(.5) ? 1 : 2;
  for (int i = 0; i < 8; i += step) {
    if (part.corners.size() > 3 && chance(.2)) continue;
    const double stretch = step == 1 ? between(.97, 1) : between(.6, 1);
    part.corners.push_back(radius * stretch * at(kDirections, i));
  }
  return {part};
}

std::vector<Part> SceneDraw::anyShape(double radius) {
  const int kind = below(8);
  if (kind < 2) return circle(radius);
  if (kind < 4) return box(1.4 * radius, 1.4 * radius);
  if (kind == 4) return box(1.8 * radius, oneOf({.1, .3, .6}) * radius);
  if (kind < 7) return anyPolygon(radius);
  std::vector<Part> compound = box(1.2 * radius, .4 * radius);
  if (chance(.5)) {
    compound.push_back(circle(.3 * radius)[0]);
    compound[1].centre.x = .5 * radius;
  } else {
    compound.push_back(box(.4 * radius, .4 * radius)[0]);
    compound[1].centre.y = -.4 * radius;
    compound[1].angle = between(-1, 1);
  }
  return compound;
}

template <class Change>
void SceneDraw::changeVectors(Change change) {
  change(m_scene.gravity);
  for (auto* p_list : {&m_scene.bodies, &m_scene.obstacles}) {
    for (BodyData& its : *p_list) {
      for (Vec2* p_v : {&its.place, &its.velocity, &its.anchor, &its.field_origin}) change(*p_v);
      for (Part& part : its.parts) {
        change(part.centre);
        for (Vec2& corner : part.corners) change(corner);
      }
    }
  }
  for (Boundary& its : m_scene.boundaries) {
    for (Vec2* p_v : {&its.lower, &its.upper, &its.velocity}) change(*p_v);
  }
}

void SceneDraw::transpose() {
  const auto turn = [](Vec2& v) { std::swap(v.x, v.y); };
  changeVectors(turn);
  for (auto* p_list : {&m_scene.bodies, &m_scene.obstacles}) {
    for (BodyData& its : *p_list) {
      for (Part& part : its.parts) turn(part.size);
    }
  }
  for (Boundary& its : m_scene.boundaries)
    its.kind = its.kind == Boundary::Kind::WALL_X ? Boundary::Kind::WALL_Y : Boundary::Kind::WALL_X;
}

void SceneDraw::turnOver() {
  changeVectors([](Vec2& v) { v.y = -v.y; });
  for (Boundary& its : m_scene.boundaries) std::swap(its.lower.y, its.upper.y);
}

void SceneDraw::drawActions() {
  if (!chance(.35)) return;
  const int count = 1 + below(3);
  for (int i = 0; i < count; ++i) {
    const int tick = 2 + below(std::min(m_scene.ticks, 60)), which = below(10);
    const TargetKind target = which < 2 && !m_scene.obstacles.empty() ? OBSTACLE
                              : which < 4 && !m_scene.joints.empty()  ? JOINT
                              : which < 5                             ? WORLD
                                                                      : BODY;
    addAction(namesOf(target), tick);
  }
}

void SceneDraw::addAction(const std::vector<const char*>& names, int tick) {
  Action action;
  action.tick = tick;
  action.p_setter = &setterNamed(oneOf(names));
  const TargetKind kind = action.p_setter->target;
  const std::size_t targets = kind == BODY       ? m_scene.bodies.size()
                              : kind == OBSTACLE ? m_scene.obstacles.size()
                              : kind == JOINT    ? m_scene.joints.size()
                                                 : 1;
  if (targets == 0) return;
  action.target = below(static_cast<int>(targets));
  if (chance(.2)) {
    action.when = chance(.7) ? Action::When::BEGIN : Action::When::END;
    action.receiver = below(static_cast<int>(m_scene.bodies.size()));
    body(action.receiver).contact_ends = true;
  }
  const Vec2 vector = vectorUpTo(oneOf({.1, .3, 1}));  // of velocities, displacements, forces, impulses
  const auto draw = [&](const std::vector<double>& from, double otherwise) {
    if (from.empty()) return otherwise;
    return action.p_setter->is_range ? between(from[0], from[1]) : oneOf(from);
  };
  action.x = action.is("mass") ? mass() : draw(action.p_setter->x, vector.x);
  action.y = draw(action.p_setter->y, vector.y);
  m_scene.actions.push_back(action);
}

SceneData withoutSeams(const SceneData& scene) {
  SceneData merged = scene;
  for (auto* p_list : {&merged.obstacles, &merged.bodies}) {
    for (std::size_t i = 0; i < p_list->size(); ++i) {
      BodyData& first = (*p_list)[i];
      if (first.row == kNothing || !first.present) continue;
      Vec2 lower = first.place - first.half(), upper = first.place + first.half();
      for (std::size_t j = i + 1; j < p_list->size(); ++j) {
        BodyData& next = (*p_list)[j];
        if (next.row != first.row || !next.present) continue;
        const Vec2 low = next.place - next.half(), high = next.place + next.half();
        lower = {std::min(lower.x, low.x), std::min(lower.y, low.y)};
        upper = {std::max(upper.x, high.x), std::max(upper.y, high.y)};
        next.present = false;
      }
      first.place = .5 * (lower + upper);
      first.parts = box(upper.x - lower.x, upper.y - lower.y);
    }
  }
  return merged;
}

}  // namespace hunt

// The families of scenes. Each contains the scenes of NUMERICS.md of its kind, and their neighbours.
#include <algorithm>
#include <cmath>
#include <limits>

#include "SceneDraw.h"

namespace hunt {

using Kind = JointData::Kind;

// A body that slides on tiles or falls onto them: floors, walls, ceilings, corners, stairs, rafts.
void SceneDraw::drawTiles() {
  const double size = oneOf({1, 1, 1, .5, 2});
  const bool as_bodies = chance(.2);
  if (chance(.12)) return drawStairs(size, as_bodies);
  const int count = 10 + below(12);
  const double gap = chance(.75) ? 0 : between(0, 1.0 / 64);
  const Vec2 velocity = as_bodies && chance(.5) ? Vec2{oneOf({.05, -.1, .3}), 0} : Vec2{};
  const double length = count * size + (count - 1) * gap;
  addTiles({-.5 * length, 0}, count, size, gap, as_bodies, velocity);
  if (velocity.x == 0)
    m_scene.boundaries.push_back({Boundary::Kind::WALL_Y, {-.5 * length, 0}, {.5 * length, size}, {}});
  if (chance(.15)) addObstacle({.5 * length + .5, -2}, {.5, 2});  // the wall of an inner corner
  if (chance(.3)) m_scene.gravity.x = oneOf({.001, .003, -.003});
  drawSlider(-.5 * length, size);
  if (chance(.2)) drawSlider(0, size);
  if (chance(.2)) transpose();
  if (chance(.1)) turnOver();
}

void SceneDraw::drawSlider(double from, double size) {
  const double width = oneOf({1, 1, 2, 3, 4, .9, 1.5}) * size;
  const double height = oneOf({1, 1, .5, 2});
  const bool is_round = chance(.15);
  const Vec2 half = is_round ? Vec2{.5, .5} : Vec2{.5 * width, .5 * height};
  const double above = chance(.2) ? between(0, 1) : 0;
  const double along = chance(.5) ? 0 : between(0, 2);
  const int index =
      addBody({from + half.x + along, -half.y - above}, is_round ? circle(.5) : box(width, height));
  BodyData& slider = body(index);
  slider.velocity.x = oneOf({.05, .1, .3, .9, 1.9});
  slider.turning = chance(.5);
  if (chance(.4)) slider.friction = 0;
  if (m_scene.aspect == 1 && half == Vec2{.5, .5} && chance(.3)) slider.parts.clear();
}

// Steps of two tiles each, down to the right.
void SceneDraw::drawStairs(double size, bool as_bodies) {
  for (int step = 0; step < 6; ++step)
    addTiles({2 * step * size, step * .5 * size}, 2, size, 0, as_bodies, {});
  drawSlider(0, size);
}

// A heavy body that pushes a row of light ones along a floor.
void SceneDraw::drawPush() {
  addFloor();
  const int count = 2 + below(5);
  const double spacing = oneOf({1, 1.1, 1.1, 1.5});
  for (int i = 0; i < count; ++i) body(addBody({i * spacing, -.5}, box(1, 1))).turning = chance(.9);
  const int heavy = addBody({-3, -2}, chance(.6) ? circle(2) : box(4, 4));
  body(heavy).mass = oneOf({100, 1e3, 2e3, 5e3, 1e4, 3e4, 1e5, 1e6});
  body(heavy).turning = chance(.9);
  body(heavy).velocity.x = oneOf({.05, .2, .2, .5});
  m_scene.ticks = 100;
}

// Links one after another: hanging, lying or free, on joints of one kind or of any.
void SceneDraw::drawChain() {
  const int count = 1 + below(chance(.8) ? 8 : 24);
  const Vec2 direction = chance(.5) ? Vec2{0, 1} : chance(.6) ? Vec2{1, 0} : Vec2{.6, .8};
  const double spacing = oneOf({1, 1, .5, 2});
  const bool is_fixed = chance(.75), is_spectral = chance(.5), turns = chance(.6), is_mixed = chance(.15);
  constexpr std::array kKinds = {Kind::SPRING, Kind::SPRING, Kind::DISTANCE, Kind::ROPE,
                                 Kind::HINGE,  Kind::WELD,   Kind::HINGE};
  const auto anyKind = [&] { return kKinds[static_cast<std::size_t>(below(kKinds.size()))]; };
  Kind kind = anyKind();
  JointData spring;
  setSpring(spring, 1);
  int previous = kNothing;
  for (int i = 0; i < count; ++i) {
    const Vec2 place = (i + 1) * spacing * direction;
    const int link = addBody(place, chance(.7) ? box(.6 * spacing, .25 * spacing) : circle(.3 * spacing));
    body(link).turning = turns;
    if (is_spectral) body(link).solidness = df::SPECTRAL;
    if (is_mixed) kind = anyKind();
    if (previous != kNothing || is_fixed) {
      const bool is_point = kind == Kind::HINGE || kind == Kind::WELD;
      JointData& joint = is_point ? addJoint(kind, previous, link, place - .5 * spacing * direction)
                                  : addLink(kind, previous, link);
      joint.first = spring.first;
      joint.second = spring.second;
    }
    previous = link;
  }
  body(previous).mass = oneOf({1, 1, 1, 10, 100, 1e3, 1e4, 1e5, 1e6});
  if (chance(.3)) body(previous).velocity = vectorUpTo(.3);
  if (chance(.1) && count > 2)
    addJoint(kind == Kind::ROPE ? Kind::ROPE : Kind::DISTANCE, kNothing, previous, body(previous).place)
        .point_a = body(previous).place + Vec2{1, -1};
  if (chance(.2)) addFloor();
  if (chance(.2) && m_scene.obstacles.empty()) addObstacle({-3, 3}, {1, 1});
  for (ObstacleData& floor : m_scene.obstacles) floor.centre.y += (count + 2) * spacing;
  for (Boundary& floor : m_scene.boundaries) {
    floor.lower.y += (count + 2) * spacing;
    floor.upper.y += (count + 2) * spacing;
  }
}

// An arm on a hinge of the world, turned by a motor.
void SceneDraw::drawMotor() {
  const double arm = oneOf({0, 2, 5, 5, 20});
  const int index = addBody({arm, 0}, box(2, 2));
  body(index).turning = true;
  body(index).solidness = chance(.5) ? df::HARD : df::SPECTRAL;
  addJoint(Kind::HINGE, kNothing, index, {0, 0});
  JointData& motor = addJoint(Kind::MOTOR, kNothing, index, body(index).place);
  motor.first = oneOf({0, .01, .03, .1, .1, .5});
  motor.second = oneOf({1, 10, 100, 1e3, 1e6, std::numeric_limits<double>::infinity()});
  if (chance(.2)) addJoint(Kind::LIMIT, kNothing, index, body(index).place).second = 1;
  if (chance(.3)) {
    const int load = addBody({arm + 2.5, 0}, chance(.5) ? box(1, 1) : circle(.5));
    body(load).turning = true;
    addJoint(chance(.5) ? Kind::HINGE : Kind::WELD, index, load, {arm + 1.5, 0});
  }
  if (chance(.2)) addObstacle({.5 * arm, arm + 4}, {arm + 5, .5});
  m_scene.ticks = 100;
}

// Bodies that bounce without loss, in empty space or in a room.
void SceneDraw::drawElastic() {
  m_material = 1;
  m_scene.gravity = {};
  m_scene.obstacle_restitution = 1;
  m_scene.obstacle_friction = 0;
  if (chance(.15)) m_scene.gravity.y = .01;
  const bool is_in_room = chance(.35);
  const int count = is_in_room ? 1 + below(8) : 2 + below(4);
  const double fastest = speed(), spin = chance(.3) ? 0 : fastest;
  const bool turns = chance(.75), is_light = chance(.6);
  for (int i = 0; i < count; ++i) {
    // Places on a lattice of width 3, which is crossed towards the origin.
    const Vec2 place = {3.0 * (i % 4) - 4.5 + between(-.4, .4), 3.0 * (i / 4) - 3 + between(-.4, .4)};
    const int index = addBody(place, chance(.4) ? circle(between(.2, 1)) : anyShape(between(.2, 1)));
    BodyData& its = body(index);
    its.turning = turns;
    its.mass = is_light ? oneOf({1, 1, 2, 5}) : anyMass();
    its.spin = between(-spin, spin);
    its.velocity = fastest * (-.2 * place + vectorUpTo(.3));
  }
  if (is_in_room) addRoom({8, 6}, 1, chance(.2), {});
}

// One or two bodies that touch something, and setters called on them.
void SceneDraw::drawContact() {
  if (chance(.8)) {
    addFloor(chance(.8) ? 500 : 2);
  } else {
    body(addBody({0, .5}, box(40, 1))).kinematic = true;
    body(0).velocity.x = oneOf({0, .05, .2});
  }
  if (chance(.2)) addObstacle({4, -2}, {oneOf({.05, .5}), 2});
  const int count = 1 + below(2);
  for (int i = 0; i < count; ++i) {
    const double half = oneOf({.25, .5, .5, 1});
    const double above = chance(.6) ? 0 : between(0, .5);
    const bool is_stacked = i > 0 && chance(.5);
    const Vec2 place = is_stacked ? body(m_scene.bodies.size() - 1).place - Vec2{0, 1.0 + half}
                                  : Vec2{i * 2.5 - 1, -half - above};
    const int index = addBody(place, chance(.7) ? box(2 * half, 2 * half) : circle(half));
    BodyData& its = body(index);
    its.turning = chance(.6);
    if (!is_stacked) its.velocity = {oneOf({0, .03, .1, .3, .9, -.2}), 0};
    if (chance(.2)) its.angle = between(-1, 1);
    if (its.angle != 0) its.place.y -= half;
    if (chance(.1)) {
      its.anchor = its.place + Vec2{1, -1};
      its.stiffness = oneOf({.01, .1, 1, 100});
    }
  }
  constexpr std::array kSetters = {Action::Kind::FRICTION,
                                   Action::Kind::FRICTION,
                                   Action::Kind::RESTITUTION,
                                   Action::Kind::MASS,
                                   Action::Kind::TURNING,
                                   Action::Kind::VELOCITY,
                                   Action::Kind::SPIN,
                                   Action::Kind::KINEMATIC,
                                   Action::Kind::GRAVITY_SCALE,
                                   Action::Kind::OBSTACLE_FRICTION,
                                   Action::Kind::SOLIDNESS,
                                   Action::Kind::CIRCLE,
                                   Action::Kind::BOX,
                                   Action::Kind::DRAG,
                                   Action::Kind::SPRING,
                                   Action::Kind::GRAVITY,
                                   Action::Kind::LEVEL,
                                   Action::Kind::SLEEPING,
                                   Action::Kind::DELETE_OBSTACLE,
                                   Action::Kind::MOVE_OBSTACLE};
  if (chance(.8)) addAction(kSetters, 5 + below(30));
  m_scene.ticks = std::max(m_scene.ticks, 75);
}

// Sensors that count the bodies in them, bodies that pass through, and some that are deleted inside.
void SceneDraw::drawZone() {
  if (chance(.5)) m_scene.gravity = {};
  const int zones = 1 + below(2);
  for (int i = 0; i < zones; ++i) {
    const Vec2 place = {6.0 * i, 0};
    if (chance(.3)) {
      m_scene.obstacles[static_cast<std::size_t>(addObstacle(place, {2, 2}))].solidness = df::SOFT;
    } else {
      const int zone = addBody(place, chance(.5) ? box(4, 4) : circle(2));
      body(zone).solidness = df::SOFT;
      body(zone).gravity_scale = 0;
      body(zone).contact_ends = true;
    }
  }
  const int movers = 1 + below(4);
  for (int i = 0; i < movers; ++i) {
    const bool starts_inside = chance(.15);
    const int mover =
        addBody({starts_inside ? 0.0 : -4.0, 1.2 * i - 1.5}, chance(.5) ? box(.5, .5) : circle(.3));
    BodyData& its = body(mover);
    its.velocity = {oneOf({0, .1, .2, .5, 3}), 0};
    its.turning = chance(.3);
    its.contact_ends = chance(.6);
    its.solidness = chance(.7) ? df::HARD : df::SOFT;
    if (chance(.3)) its.gravity_scale = 0;
  }
  if (chance(.2)) addObstacle({0, 4}, {20, .5});
  constexpr std::array kSetters = {Action::Kind::MARK_BODY, Action::Kind::DELETE_BODY,
                                   Action::Kind::SOLIDNESS, Action::Kind::OBSTACLE_SOLIDNESS,
                                   Action::Kind::POSITION,  Action::Kind::DELETE_OBSTACLE,
                                   Action::Kind::MARK_BODY};
  const int count = below(4);
  for (int i = 0; i < count; ++i) addAction(kSetters, 5 + below(40));
}

// Bodies of all kinds that fall into a tray.
void SceneDraw::drawHeap() {
  m_scene.gravity = {0, oneOf({.01, .02, .05})};
  const double half_width = 4;
  if (chance(.4)) {
    addTiles({-half_width - 1, 0}, 10, 1, 0, false, {});
    addTiles({-half_width - 1, -1}, 1, 1, 0, false, {});
    addTiles({half_width, -1}, 1, 1, 0, false, {});
    addObstacle({-half_width - .5, -11}, {.5, 10});
    addObstacle({half_width + .5, -11}, {.5, 10});
  } else {
    addObstacle({0, .5}, {half_width + 1, .5});
    addObstacle({-half_width - .5, -10}, {.5, 10});
    addObstacle({half_width + .5, -10}, {.5, 10});
  }
  m_scene.boundaries = {{Boundary::Kind::WALL_Y, {-half_width - 1, 0}, {half_width + 1, 1}, {}},
                        {Boundary::Kind::WALL_X, {-half_width - 1, -20}, {-half_width, 1}, {}},
                        {Boundary::Kind::WALL_X, {half_width, -20}, {half_width + 1, 1}, {}}};
  const int count = 3 + below(12);
  const bool turns = chance(.8);
  for (int i = 0; i < count; ++i) {
    const Vec2 place = {2.1 * (i % 4) - 3.15 + between(-.1, .1), -1.2 - 2.1 * (i / 4)};
    const int index = addBody(place, chance(.5) ? box(1, 1) : anyShape(.9));
    body(index).turning = turns;
    body(index).spin = chance(.3) ? between(-.1, .1) : 0;
  }
}

// Planks and other polygons in a tray, until they should rest.
void SceneDraw::drawPlanks() {
  m_scene.gravity = {0, .0111};
  m_scene.aspect = 1;
  m_material = 0;
  m_scene.obstacle_friction = .5;
  m_scene.obstacle_restitution = 0;
  const double length = oneOf({2, 6, 12, 30}), height = oneOf({.1, .4});
  const double inside = 3.5 * length;
  addObstacle({0, .5}, {inside + 2, .5});
  addObstacle({-inside - .5, -100}, {.5, 100});
  addObstacle({inside + .5, -100}, {.5, 100});
  const int count = 5 + below(6);
  for (int i = 0; i < count; ++i) {
    const Vec2 place = {(i % 5 - 2) * 1.15 * length + between(-.5, .5), -length - 1.2 * length * (i / 5)};
    const int index = addBody(place, chance(.8) ? box(length, height) : anyPolygon(.4 * length));
    BodyData& its = body(index);
    its.turning = true;
    its.restitution = .2;
    its.friction = oneOf({.5, .5, .5, .2, .8});
    its.angle = between(0, 6);
    its.spin = oneOf({0, .1, -.1, .05, .15});
  }
  m_scene.ticks = 1000;
}

// Rods that spin fast in a room.
void SceneDraw::drawBars() {
  if (chance(.5)) m_scene.gravity = {};
  const double length = oneOf({6, 6, 3, 1}), height = oneOf({.1, .1, .3});
  const int count = 1 + below(8);
  const Vec2 half = {2.4 * length, 1.3 * length};
  const bool as_bodies = chance(.2);
  const Vec2 velocity = as_bodies && chance(.5) ? vectorUpTo(.2) : Vec2{};
  addRoom(half, oneOf({.01, .05, .2, .2, 1}), as_bodies, velocity);
  const double spin = oneOf({.3, 1, 5, 10, 15});
  for (int i = 0; i < count; ++i) {
    const Vec2 place = {(i % 4 - 1.5) * 1.1 * length, (i / 4 - .5) * 1.1 * length};
    const int rod = addBody(place, box(length, height));
    body(rod).turning = true;
    body(rod).spin = chance(.5) ? spin : -spin;
    body(rod).velocity = vectorUpTo(oneOf({.03, .3, 1}));
  }
}

// A body that is shot at a wall.
void SceneDraw::drawShot() {
  m_scene.gravity = {};
  const double thickness = oneOf({.01, .1, .5, 1, 1});
  const int kind = below(4);
  const Vec2 half = {.5 * thickness, oneOf({20, 1000, 1e5})};
  const Vec2 centre = {50 + half.x, 0};
  if (kind < 3) {
    addObstacle(centre, half);
    m_scene.boundaries.push_back({Boundary::Kind::WALL_X, centre - half, centre + half, {}});
  } else {
    const int wall = addBody(centre, box(2 * half.x, 2 * half.y));
    body(wall).kinematic = true;
    body(wall).velocity.x = oneOf({0, -.1, .1});
    m_scene.boundaries.push_back({Boundary::Kind::WALL_X, centre - half, centre + half, body(wall).velocity});
  }
  const int shots = 1 + below(2);
  for (int i = 0; i < shots; ++i) {
    const int shot = addBody({0, 3.0 * i}, chance(.6) ? box(.6, .1) : anyShape(between(.1, 1)));
    BodyData& its = body(shot);
    its.turning = chance(.8);
    its.angle = between(-1.5, 1.5);
    its.velocity = {oneOf({.7, 2, 10, 100, 1e4, 1e6}), 0};
    its.velocity.y = its.velocity.x * oneOf({0, 0, .1, -.1});
    its.spin = oneOf({0, 0, 1, 100});
    its.restitution = oneOf({0, .3, 1});
    its.friction = oneOf({0, .6});
  }
  m_scene.ticks = 80;
}

// Bodies in force fields and on springs, free, on a floor or on a rod.
void SceneDraw::drawFields() {
  const bool has_floor = chance(.4);
  if (has_floor) addFloor();
  constexpr std::array kKinds = {FieldData::Kind::LINEAR, FieldData::Kind::TANH, FieldData::Kind::MAGNET};
  const int count = 1 + below(3);
  for (int i = 0; i < count; ++i) {
    const Vec2 place = {2.0 * i, has_floor ? -.5 : 0};
    const int index = addBody(place, chance(.6) ? box(1, 1) : circle(.5));
    BodyData& its = body(index);
    its.turning = chance(.5);
    if (chance(.5)) its.velocity = vectorUpTo(.3);
    if (chance(.5)) {
      its.anchor = chance(.5) ? place + vectorUpTo(2) : Vec2{place.x - 1, place.y};
      its.stiffness = oneOf({.001, .01, .1, 1, 100, 1e4, 1e8, 1e12});
      its.damping = oneOf({0, 0, 0, .1, 1}) * 2 * std::sqrt(its.stiffness);
    } else {
      FieldData field;
      field.kind = kKinds[static_cast<std::size_t>(below(kKinds.size()))];
      field.strength = oneOf({.001, .01, .1, 1, 100, 1e4});
      field.steepness = oneOf({.5, 5, 50});
      its.field = static_cast<int>(m_scene.fields.size());
      its.field_origin = place + vectorUpTo(2);
      m_scene.fields.push_back(field);
    }
    if (chance(.2)) its.linear_drag = oneOf({.001, .05, 1});
    if (chance(.1)) its.quadratic_drag = oneOf({.001, .1});
    if (chance(.2)) addLink(chance(.5) ? Kind::DISTANCE : Kind::ROPE, kNothing, index, place - Vec2{0, 3});
  }
}

// Anything on a lattice of width 2.2, some of it joined with its left neighbour.
void SceneDraw::drawMix() {
  const int columns = 2 + below(4), count = 2 + below(10);
  const bool turns = chance(.7);
  const double fastest = std::min(speed(), 3.0);
  int previous = kNothing;
  for (int i = 0; i < count; ++i) {
    const Vec2 place = {2.2 * (i % columns), -2.2 * (i / columns)};
    if (chance(.12)) {
      addObstacle(place, {between(.2, 1), between(.2, 1)});
      previous = kNothing;
      continue;
    }
    const int index = addBody(place, anyShape(between(.3, 1)));
    BodyData& its = body(index);
    its.turning = turns || chance(.1);
    its.velocity = fastest * vectorUpTo(1);
    if (its.turning && chance(.3)) its.spin = between(-.3, .3);
    if (chance(.06)) its.kinematic = true;
    if (chance(.06)) its.solidness = chance(.5) ? df::SOFT : df::SPECTRAL;
    if (chance(.1)) its.linear_drag = oneOf({.001, .05, .3});
    if (chance(.3)) its.contact_ends = true;
    if (i % columns != 0 && previous != kNothing && chance(.35)) drawMixJoint(previous, index);
    if (chance(.05)) drawMixJoint(kNothing, index);
    previous = index;
  }
  if (chance(.6)) {
    addFloor(chance(.7) ? 500 : 6);
    for (ObstacleData& its : m_scene.obstacles) {
      if (its.half.x > 5) its.centre.y += 1.5;
    }
    for (Boundary& its : m_scene.boundaries) {
      its.lower.y += 1.5;
      its.upper.y += 1.5;
    }
  }
}

void SceneDraw::drawMixJoint(int a, int b) {
  const Vec2 place = body(b).place;
  const Vec2 middle = a == kNothing ? place - Vec2{1, 0} : .5 * (body(a).place + place);
  switch (below(9)) {
    case 0:
      addLink(Kind::DISTANCE, a, b, middle);
      break;
    case 1:
      addLink(Kind::ROPE, a, b, middle);
      break;
    case 2:
    case 3:
      addJoint(Kind::HINGE, a, b, middle);
      if (chance(.3)) {
        JointData& motor = addJoint(Kind::MOTOR, a, b, place);
        motor.first = oneOf({-.05, .02, .1});
        motor.second = oneOf({.01, 1, 100});
      }
      break;
    case 4:
      addJoint(Kind::WELD, a, b, middle);
      break;
    case 5:
      addJoint(Kind::SLIDER, a, b, middle).axis = chance(.5) ? Vec2{1, 0} : Vec2{.6, .8};
      break;
    case 6:
      setSpring(addLink(Kind::SPRING, a, b, middle), 1);
      break;
    case 7: {
      addJoint(Kind::HINGE, a, b, middle);
      JointData& limit = addJoint(Kind::LIMIT, a, b, place);
      limit.first = -between(0, 1);
      limit.second = between(0, 1);
      break;
    }
    default: {
      JointData& mouse = addJoint(Kind::MOUSE, kNothing, b, place);
      mouse.first = oneOf({.01, .1, 10});
      mouse.has_target = true;
      mouse.target = place + vectorUpTo(3);
      break;
    }
  }
}

}  // namespace hunt

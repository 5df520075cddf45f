// The families of scenes. Each contains the scenes of NUMERICS.md of its kind, and their neighbours.
#include <cmath>
#include <limits>

#include "SceneDraw.h"

namespace hunt {
namespace {

class FamilyDraw : public SceneDraw {
 public:
  using SceneDraw::SceneDraw;

  /// Draws bodies, obstacles and joints of a family, by weight; `is_small` excludes costly families.
  void drawFamily(bool is_small) {
    struct Family {
      const char* name;
      int weight;
      void (FamilyDraw::*draw)();
    };
    static const std::vector<Family> kFamilies = {
        {"contact", 150, &FamilyDraw::drawContact}, {"tiles", 120, &FamilyDraw::drawTiles},
        {"chain", 150, &FamilyDraw::drawChain},     {"motor", 60, &FamilyDraw::drawMotor},
        {"fields", 70, &FamilyDraw::drawFields},    {"zone", 80, &FamilyDraw::drawZone},
        {"shot", 60, &FamilyDraw::drawShot},        {"elastic", 90, &FamilyDraw::drawElastic},
        {"mix", 120, &FamilyDraw::drawMix},         {"push", 60, &FamilyDraw::drawPush},
        {"bars", 40, &FamilyDraw::drawBars},        {"heap", 30, &FamilyDraw::drawHeap},
        {"planks", 4, &FamilyDraw::drawPlanks}};
    constexpr int kSmall = 630, kAll = 1034;  // weight of the first six families, and of all
    int chosen = below(is_small ? kSmall : kAll);
    auto family = kFamilies.begin();
    while (chosen >= family->weight) chosen -= (family++)->weight;
    m_scene.family = family->name;
    (this->*family->draw)();
  }

 private:
  using Kind = JointData::Kind;

  // A body that slides on tiles or falls onto them: floors, walls, ceilings, corners, stairs, rafts.
  void drawTiles() {
    const double size = oneOf({1, 1, 1, .5, 2});
    const bool as_bodies = chance(.2);
    if (chance(.12)) {  // stairs of two tiles each, down to the right
      for (int step = 0; step < 6; ++step)
        addTiles({2 * step * size, step * .5 * size}, 2, size, 0, as_bodies);
      return drawSlider(0, size);
    }
    const int count = 10 + below(12);
    const double gap = chance(.75) ? 0 : between(0, 1.0 / 64);
    const Vec2 velocity = as_bodies && chance(.5) ? Vec2{oneOf({.05, -.1, .3}), 0} : Vec2{};
    const double length = count * size + (count - 1) * gap;
    addTiles({-.5 * length, 0}, count, size, gap, as_bodies, velocity);
    if (velocity.x == 0) addBoundary(Boundary::Kind::WALL_Y, {-.5 * length, 0}, {.5 * length, size});
    if (chance(.15)) addObstacle({.5 * length + .5, -2}, {.5, 2});  // the wall of an inner corner
    if (chance(.3)) m_scene.gravity.x = oneOf({.001, .003, -.003});
    drawSlider(-.5 * length, size);
    if (chance(.2)) drawSlider(0, size);
    if (chance(.2)) transpose();
    if (chance(.1)) turnOver();
  }

  void drawSlider(double from, double size) {
    const double width = oneOf({1, 1, 2, 3, 4, .9, 1.5}) * size;
    const double height = oneOf({1, 1, .5, 2});
    const bool is_round = chance(.15);
    const Vec2 half = is_round ? Vec2{.5, .5} : Vec2{.5 * width, .5 * height};
    const double above = chance(.2) ? between(0, 1) : 0;
    const double along = chance(.5) ? 0 : between(0, 2);
    BodyData& slider =
        addBody({from + half.x + along, -half.y - above}, is_round ? circle(.5) : box(width, height));
    slider.velocity.x = oneOf({.05, .1, .3, .9, 1.9});
    slider.turning = chance(.5);
    if (chance(.4)) slider.friction = 0;
    if (m_scene.aspect == 1 && half == Vec2{.5, .5} && chance(.3)) slider.parts.clear();
  }

  // A heavy body that pushes a row of light ones along a floor.
  void drawPush() {
    addFloor();
    const int count = 2 + below(5);
    const double spacing = oneOf({1, 1.1, 1.1, 1.5});
    for (int i = 0; i < count; ++i) {
      BodyData& crate = addBody({i * spacing, -.5}, box(1, 1));
      crate.turning = chance(.9);
    }
    BodyData& heavy = addBody({-3, -2}, chance(.6) ? circle(2) : box(4, 4));
    heavy.mass = oneOf({100, 1e3, 2e3, 5e3, 1e4, 3e4, 1e5, 1e6});
    heavy.turning = chance(.9);
    heavy.velocity.x = oneOf({.05, .2, .2, .5});
    m_scene.ticks = 100;
  }

  // Links one after another: hanging, lying or free, on joints of one kind or of any.
  void drawChain() {
    const int count = 1 + below(chance(.8) ? 8 : 24);
    const Vec2 direction = chance(.5) ? Vec2{0, 1} : chance(.6) ? Vec2{1, 0} : Vec2{.6, .8};
    const double spacing = oneOf({1, 1, .5, 2});
    const bool is_fixed = chance(.75), is_spectral = chance(.5), turns = chance(.6), is_mixed = chance(.15);
    static const std::vector<Kind> kKinds = {Kind::SPRING, Kind::SPRING, Kind::DISTANCE, Kind::ROPE,
                                             Kind::HINGE,  Kind::WELD,   Kind::HINGE};
    Kind kind = oneOf(kKinds);
    JointData spring;
    setSpring(spring);
    int previous = kNothing;
    for (int i = 0; i < count; ++i) {
      const Vec2 place = (i + 1) * spacing * direction;
      BodyData& link = addBody(place, chance(.7) ? box(.6 * spacing, .25 * spacing) : circle(.3 * spacing));
      link.turning = turns;
      if (is_spectral) link.solidness = df::SPECTRAL;
      if (is_mixed) kind = oneOf(kKinds);
      if (previous != kNothing || is_fixed) {
        const bool is_point = kind == Kind::HINGE || kind == Kind::WELD;
        JointData& joint = is_point ? addJoint(kind, previous, lastBody(), place - .5 * spacing * direction)
                                    : addLink(kind, previous, lastBody());
        joint.first = spring.first;
        joint.second = spring.second;
      }
      previous = lastBody();
    }
    BodyData& end = body(previous);
    end.mass = oneOf({1, 1, 1, 10, 100, 1e3, 1e4, 1e5, 1e6});
    if (chance(.3)) end.velocity = vectorUpTo(.3);
    if (chance(.1) && count > 2)
      addJoint(kind == Kind::ROPE ? Kind::ROPE : Kind::DISTANCE, kNothing, previous, end.place).point_a +=
          Vec2{1, -1};
    const double below_all = (count + 2) * spacing;
    if (chance(.2)) addFloor(500, below_all);
    if (chance(.2) && m_scene.obstacles.empty()) addObstacle({-3, 3 + below_all}, {1, 1});
  }

  // An arm on a hinge of the world, turned by a motor.
  void drawMotor() {
    const double arm = oneOf({0, 2, 5, 5, 20});
    BodyData& its = addBody({arm, 0}, box(2, 2));
    its.turning = true;
    its.solidness = chance(.5) ? df::HARD : df::SPECTRAL;
    addJoint(Kind::HINGE, kNothing, 0, {0, 0});
    JointData& motor = addJoint(Kind::MOTOR, kNothing, 0, its.place);
    motor.first = oneOf({0, .01, .03, .1, .1, .5});
    motor.second = oneOf({1, 10, 100, 1e3, 1e6, std::numeric_limits<double>::infinity()});
    if (chance(.2)) addJoint(Kind::LIMIT, kNothing, 0, its.place).second = 1;
    if (chance(.3)) {
      addBody({arm + 2.5, 0}, chance(.5) ? box(1, 1) : circle(.5)).turning = true;
      addJoint(chance(.5) ? Kind::HINGE : Kind::WELD, 0, 1, {arm + 1.5, 0});
    }
    if (chance(.2)) addObstacle({.5 * arm, arm + 4}, {arm + 5, .5});
    m_scene.ticks = 100;
  }

  // Bodies that bounce without loss, in empty space or in a room.
  void drawElastic() {
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
      BodyData& its = addBody(place, chance(.4) ? circle(between(.2, 1)) : anyShape(between(.2, 1)));
      its.turning = turns;
      its.mass = is_light ? oneOf({1, 1, 2, 5}) : mass();
      its.spin = between(-spin, spin);
      its.velocity = fastest * (-.2 * place + vectorUpTo(.3));
    }
    if (is_in_room) addRoom({8, 6}, 1, chance(.2), {});
  }

  // One or two bodies that touch something, and setters called on them.
  void drawContact() {
    if (chance(.8)) {
      addFloor(chance(.8) ? 500 : 2);
    } else {
      BodyData& belt = addBody({0, .5}, box(40, 1));
      belt.kinematic = true;
      belt.velocity.x = oneOf({0, .05, .2});
    }
    if (chance(.2)) addObstacle({4, -2}, {oneOf({.05, .5}), 2});
    const int count = 1 + below(2);
    for (int i = 0; i < count; ++i) {
      const double half = oneOf({.25, .5, .5, 1});
      const double above = chance(.6) ? 0 : between(0, .5);
      const bool is_stacked = i > 0 && chance(.5);
      const Vec2 place =
          is_stacked ? body(lastBody()).place - Vec2{0, 1.0 + half} : Vec2{i * 2.5 - 1, -half - above};
      BodyData& its = addBody(place, chance(.7) ? box(2 * half, 2 * half) : circle(half));
      its.turning = chance(.6);
      if (!is_stacked) its.velocity = {oneOf({0, .03, .1, .3, .9, -.2}), 0};
      if (chance(.2)) its.angle = between(-1, 1);
      if (its.angle != 0) its.place.y -= half;
      if (chance(.1)) {
        its.anchor = its.place + Vec2{1, -1};
        its.stiffness = oneOf({.01, .1, 1, 100});
      }
    }
    static const std::vector<const char*> kSetters = {
        "friction",  "friction",      "restitution",  "mass",      "turning",         "velocity",     "spin",
        "kinematic", "gravity scale", "all friction", "solidness", "circle",          "box",          "drag",
        "spring",    "gravity",       "level",        "sleeping",  "delete obstacle", "move obstacle"};
    if (chance(.8)) addAction(kSetters, 5 + below(30));
    m_scene.ticks = std::max(m_scene.ticks, 75);
  }

  // Sensors that count the bodies in them, bodies that pass through, and some that are deleted inside.
  void drawZone() {
    if (chance(.5)) m_scene.gravity = {};
    const int zones = 1 + below(2);
    for (int i = 0; i < zones; ++i) {
      const Vec2 place = {6.0 * i, 0};
      if (chance(.3)) {
        addObstacle(place, {2, 2}).solidness = df::SOFT;
      } else {
        BodyData& zone = addBody(place, chance(.5) ? box(4, 4) : circle(2));
        zone.solidness = df::SOFT;
        zone.gravity_scale = 0;
        zone.contact_ends = true;
      }
    }
    const int movers = 1 + below(4);
    for (int i = 0; i < movers; ++i) {
      const bool starts_inside = chance(.15);
      BodyData& its =
          addBody({starts_inside ? 0.0 : -4.0, 1.2 * i - 1.5}, chance(.5) ? box(.5, .5) : circle(.3));
      its.velocity = {oneOf({0, .1, .2, .5, 3}), 0};
      its.turning = chance(.3);
      its.contact_ends = chance(.6);
      its.solidness = chance(.7) ? df::HARD : df::SOFT;
      if (chance(.3)) its.gravity_scale = 0;
    }
    if (chance(.2)) addObstacle({0, 4}, {20, .5});
    static const std::vector<const char*> kSetters = {
        "mark", "delete", "solidness", "change obstacle", "position", "delete obstacle", "mark"};
    const int count = below(4);
    for (int i = 0; i < count; ++i) addAction(kSetters, 5 + below(40));
  }

  // Bodies of all kinds that fall into a tray.
  void drawHeap() {
    m_scene.gravity = {0, oneOf({.01, .02, .05})};
    const double half_width = 4;
    const bool is_tiled = chance(.4);
    if (is_tiled) {
      addTiles({-half_width - 1, 0}, 10, 1);
      addTiles({-half_width - 1, -1}, 1, 1);
      addTiles({half_width, -1}, 1, 1);
    } else {
      addObstacle({0, .5}, {half_width + 1, .5});
    }
    for (const double side : {-1, 1})
      addObstacle({side * (half_width + .5), is_tiled ? -11.0 : -10.0}, {.5, 10});
    addBoundary(Boundary::Kind::WALL_Y, {-half_width - 1, 0}, {half_width + 1, 1});
    addBoundary(Boundary::Kind::WALL_X, {-half_width - 1, -20}, {-half_width, 1});
    addBoundary(Boundary::Kind::WALL_X, {half_width, -20}, {half_width + 1, 1});
    const int count = 3 + below(12);
    const bool turns = chance(.8);
    for (int i = 0; i < count; ++i) {
      const Vec2 place = {2.1 * (i % 4) - 3.15 + between(-.1, .1), -1.2 - 2.1 * (i / 4)};
      BodyData& its = addBody(place, chance(.5) ? box(1, 1) : anyShape(.9));
      its.turning = turns;
      its.spin = chance(.3) ? between(-.1, .1) : 0;
    }
  }

  // Planks and other polygons in a tray, until they should rest.
  void drawPlanks() {
    m_scene.gravity = {0, .0111};
    m_scene.aspect = 1;
    m_material = 0;
    m_scene.obstacle_friction = .5;
    m_scene.obstacle_restitution = 0;
    const double length = oneOf({2, 6, 12, 30}), height = oneOf({.1, .4});
    const double inside = 3.5 * length;
    addObstacle({0, .5}, {inside + 2, .5});
    for (const double side : {-1, 1}) addObstacle({side * (inside + .5), -100}, {.5, 100});
    const int count = 5 + below(6);
    for (int i = 0; i < count; ++i) {
      const Vec2 place = {(i % 5 - 2) * 1.15 * length + between(-.5, .5), -length - 1.2 * length * (i / 5)};
      BodyData& its = addBody(place, chance(.8) ? box(length, height) : anyPolygon(.4 * length));
      its.turning = true;
      its.restitution = .2;
      its.friction = oneOf({.5, .5, .5, .2, .8});
      its.angle = between(0, 6);
      its.spin = oneOf({0, .1, -.1, .05, .15});
    }
    m_scene.ticks = 1000;
  }

  // Rods that spin fast in a room.
  void drawBars() {
    if (chance(.5)) m_scene.gravity = {};
    const double length = oneOf({6, 6, 3, 1}), height = oneOf({.1, .1, .3});
    const int count = 1 + below(8);
    const bool as_bodies = chance(.2);
    const Vec2 velocity = as_bodies && chance(.5) ? vectorUpTo(.2) : Vec2{};
    addRoom({2.4 * length, 1.3 * length}, oneOf({.01, .05, .2, .2, 1}), as_bodies, velocity);
    const double spin = oneOf({.3, 1, 5, 10, 15});
    for (int i = 0; i < count; ++i) {
      const Vec2 place = {(i % 4 - 1.5) * 1.1 * length, (i / 4 - .5) * 1.1 * length};
      BodyData& rod = addBody(place, box(length, height));
      rod.turning = true;
      rod.spin = chance(.5) ? spin : -spin;
      rod.velocity = vectorUpTo(oneOf({.03, .3, 1}));
    }
  }

  // A body that is shot at a wall.
  void drawShot() {
    m_scene.gravity = {};
    const double thickness = oneOf({.01, .1, .5, 1, 1});
    const bool is_body = below(4) == 3;
    const Vec2 half = {.5 * thickness, oneOf({20, 1000, 1e5})}, centre = {50 + half.x, 0};
    BodyData& wall = addWall(centre, half, is_body);
    if (is_body) wall.velocity.x = oneOf({0, -.1, .1});
    addBoundary(Boundary::Kind::WALL_X, centre - half, centre + half, wall.velocity);
    const int shots = 1 + below(2);
    for (int i = 0; i < shots; ++i) {
      BodyData& its = addBody({0, 3.0 * i}, chance(.6) ? box(.6, .1) : anyShape(between(.1, 1)));
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
  void drawFields() {
    const bool has_floor = chance(.4);
    if (has_floor) addFloor();
    static const std::vector<FieldData::Kind> kKinds = {FieldData::Kind::LINEAR, FieldData::Kind::TANH,
                                                        FieldData::Kind::MAGNET};
    const int count = 1 + below(3);
    for (int i = 0; i < count; ++i) {
      const Vec2 place = {2.0 * i, has_floor ? -.5 : 0};
      BodyData& its = addBody(place, chance(.6) ? box(1, 1) : circle(.5));
      its.turning = chance(.5);
      if (chance(.5)) its.velocity = vectorUpTo(.3);
      if (chance(.5)) {
        its.anchor = chance(.5) ? place + vectorUpTo(2) : Vec2{place.x - 1, place.y};
        its.stiffness = oneOf({.001, .01, .1, 1, 100, 1e4, 1e8, 1e12});
        its.damping = oneOf({0, 0, 0, .1, 1}) * 2 * std::sqrt(its.stiffness);
      } else {
        FieldData field;
        field.kind = oneOf(kKinds);
        field.strength = oneOf({.001, .01, .1, 1, 100, 1e4});
        field.steepness = oneOf({.5, 5, 50});
        its.field = static_cast<int>(m_scene.fields.size());
        its.field_origin = place + vectorUpTo(2);
        m_scene.fields.push_back(field);
      }
      if (chance(.2)) its.linear_drag = oneOf({.001, .05, 1});
      if (chance(.1)) its.quadratic_drag = oneOf({.001, .1});
      if (chance(.2))
        addLink(chance(.5) ? Kind::DISTANCE : Kind::ROPE, kNothing, lastBody(), place - Vec2{0, 3});
    }
  }

  // Anything on a lattice of width 2.2, some of it joined with its left neighbour.
  void drawMix() {
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
      BodyData& its = addBody(place, anyShape(between(.3, 1)));
      its.turning = turns || chance(.1);
      its.velocity = fastest * vectorUpTo(1);
      if (its.turning && chance(.3)) its.spin = between(-.3, .3);
      if (chance(.06)) its.kinematic = true;
      if (chance(.06)) its.solidness = chance(.5) ? df::SOFT : df::SPECTRAL;
      if (chance(.1)) its.linear_drag = oneOf({.001, .05, .3});
      if (chance(.3)) its.contact_ends = true;
      if (i % columns != 0 && previous != kNothing && chance(.35)) drawMixJoint(previous, lastBody());
      if (chance(.05)) drawMixJoint(kNothing, lastBody());
      previous = lastBody();
    }
    if (chance(.6)) addFloor(chance(.7) ? 500 : 6, 1.5);
  }

  void drawMixJoint(int a, int b) {
    static const std::vector<Kind> kKinds = {Kind::DISTANCE, Kind::ROPE,  Kind::MOTOR,
                                             Kind::MOTOR,    Kind::WELD,  Kind::SLIDER,
                                             Kind::SPRING,   Kind::LIMIT, Kind::MOUSE};
    const Vec2 place = body(b).place,
               middle = a == kNothing ? place - Vec2{1, 0} : .5 * (body(a).place + place);
    const Kind kind = oneOf(kKinds);
    if (kind == Kind::DISTANCE || kind == Kind::ROPE) addLink(kind, a, b, middle);
    if (kind == Kind::WELD) addJoint(kind, a, b, middle);
    if (kind == Kind::SLIDER) {
      JointData& slider = addJoint(kind, a, b, middle);
      slider.axis = chance(.5) ? Vec2{1, 0} : Vec2{.6, .8};
    }
    if (kind == Kind::SPRING) setSpring(addLink(kind, a, b, middle));
    if (kind == Kind::MOTOR || kind == Kind::LIMIT) addJoint(Kind::HINGE, a, b, middle);
    if (kind == Kind::MOTOR && chance(.3)) {
      JointData& motor = addJoint(kind, a, b, place);
      motor.first = oneOf({-.05, .02, .1});
      motor.second = oneOf({.01, 1, 100});
    } else if (kind == Kind::LIMIT) {
      JointData& limit = addJoint(kind, a, b, place);
      limit.first = -between(0, 1);
      limit.second = between(0, 1);
    } else if (kind == Kind::MOUSE) {
      JointData& mouse = addJoint(kind, kNothing, b, place);
      mouse.first = oneOf({.01, .1, 10});
      mouse.target = place + vectorUpTo(3);
    }
  }
};

}  // namespace

SceneData drawScene(std::uint64_t seed) {
  SceneData scene;
  scene.seed = seed;
  FamilyDraw draw(scene, seed);
  draw.drawWorld();
  draw.drawFamily(false);
  if (scene.ticks < 1000) draw.drawActions();
  return scene;
}

void addDistantGroup(SceneData& scene) {
  constexpr Vec2 kFar = {4000, 300};
  SceneData other;
  FamilyDraw draw(other, ~scene.seed);
  draw.drawWorld();
  draw.drawFamily(true);
  const int bodies = static_cast<int>(scene.bodies.size()), fields = static_cast<int>(scene.fields.size());
  const double drift = scene.seed % 5 == 0 ? 1000 : 0;  // some groups fly away
  for (const auto list : {&SceneData::bodies, &SceneData::obstacles}) {
    for (BodyData& its : other.*list) {
      its.group = 1;
      its.velocity.x += drift;
      for (Vec2* p_v : {&its.place, &its.anchor, &its.field_origin}) *p_v += kFar;
      if (its.field != kNothing) its.field += fields;
      (scene.*list).push_back(its);
    }
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

}  // namespace hunt

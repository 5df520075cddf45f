// The description of an experiment: bodies, shapes, joints, forces and duration. Every engine builds its
// world from this, so all start from equal states. Metres, seconds, kilograms, radians; y points up.
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "Vec.h"

namespace lab {

class Equations;

/// Length of a tick in seconds: the product has 30 ticks per second.
constexpr double kTick = 1.0 / 30;

enum class Motion {
  FIXED,      ///< never moves
  KINEMATIC,  ///< moves by its velocity; nothing can push it
  DYNAMIC,
};

struct Shape {
  enum class Kind { CIRCLE, BOX };
  Kind kind = Kind::CIRCLE;
  double radius = 0;  ///< radius of a circle
  Vec half;           ///< half width and half height of a box
  Vec centre{};       ///< relative to the body's centre; not (0, 0) only for bodies that nothing can push
};

struct Body {
  Motion motion = Motion::DYNAMIC;
  Vec position;  ///< position of the centre of mass, relative to the scene's origin
  double angle = 0;
  Vec velocity;
  double spin = 0;  ///< radians per second
  double mass = 1;
  bool rotates = false;       ///< false: infinite moment of inertia; true: that of its shapes together
  std::vector<Shape> shapes;  ///< empty: a point that touches nothing
  double friction = 0;        ///< that of a pair is the square root of the product
  double restitution = 0;     ///< that of a pair is the larger value
  bool fast = false;          ///< uses the engine's protection against tunnelling
  double linear_drag = 0;     ///< force per speed, in kg/s
};

/// Makes a dynamic body without a shape, which touches nothing.
Body point(Vec position, Vec velocity = {}, double mass = 1);
/// Make a dynamic body with one shape.
Body ball(Vec position, Vec velocity, double radius, double mass = 1);
Body box(Vec position, Vec half, double mass = 1);
/// Makes a box that rotates, with friction.
Body crate(Vec position, Vec half, double friction, double mass = 1);
/// Makes a box that never moves.
Body wall(Vec centre, Vec half, double angle = 0);
/// Makes a wall 10 m thick, with the middle of its top at 0.
Body ground(double half_width, double friction, double restitution = 0);
/// Returns the moment of inertia per mass.
double inertiaOf(const Shape& shape);

struct Joint {
  enum class Kind {
    ROD,     ///< keeps the initial distance of the anchors
    HINGE,   ///< keeps the anchors together
    SPRING,  ///< a force of stiffness × (distance − rest length) + damping × its rate
  };
  Kind kind = Kind::ROD;
  int a = -1;    ///< a body's index; −1: the ground
  int b = 0;     ///< another body's index
  Vec anchor_a;  ///< initial position, relative to the scene's origin
  Vec anchor_b;
  double stiffness = 0;    ///< N/m
  double damping = 0;      ///< N·s/m
  double rest_length = 0;  ///< m
};

/// Makes a rod between two bodies, or between one and the ground (−1).
Joint rod(int a, Vec from, int b, Vec to);
/// Makes a spring whose rest length is its initial length.
Joint spring(int a, Vec from, int b, Vec to, double stiffness);
Joint hinge(int a, int b, Vec at);

/// An elastic beam that lies along x and is clamped at x = 0. Its free end is the scene's body 0.
struct Beam {
  double length = 0;     ///< m
  double thickness = 0;  ///< m; its depth is 1 m
  double modulus = 0;    ///< Young's modulus in Pa
  double density = 0;    ///< kg/m³
  double tip_force = 0;  ///< N, downwards, from the start
  double damping = 0;    ///< fraction of the first mode's critical damping
  int elements = 0;      ///< number of elements along its length
};

/// A net of square meshes of threads, hung by its two upper corners. Each node is also the scene's body with
/// the index row × columns + column. Methods without cloths use these bodies, connected by rods.
struct Cloth {
  int columns = 0;       ///< number of columns of nodes
  int rows = 0;          ///< number of rows of nodes
  double mesh = 0;       ///< side of a mesh, m
  double mass = 0;       ///< total mass in kg
  double stiffness = 0;  ///< stiffness of the product's threads divided by their part of the mass, m/s²
};

struct BodyState {
  Vec position{};  ///< relative to the scene's origin
  Vec velocity{};
  double angle = 0;
  double spin = 0;
};

/// Region in which the centres of all dynamic bodies must be. A body outside has passed through a wall, or is
/// more than half inside a wall.
struct Room {
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Vec lower{-kInfinity, -kInfinity};
  Vec upper{kInfinity, kInfinity};
  int frame = -1;  ///< rotating body in whose axes the region is given; −1: the scene's axes
};

/// Returns the acceleration by a game's force field at time t, for a body in this state.
using Field = std::function<Vec(double t, const BodyState&)>;

struct Scene {
  std::vector<Body> bodies;
  std::vector<Joint> joints;
  std::vector<Beam> beams;
  std::vector<Cloth> cloths;
  Room room;
  Vec gravity;
  Field field;  ///< empty: none
  Vec origin;   ///< position of the scene in the world, in whole metres
  double tick = kTick;
  int ticks = 0;
  /// If true, bodies at rest may sleep, which is the default of each engine.
  bool may_sleep = false;
  /// If false, nothing touches anything.
  bool collides = true;
  /// If false, no handlers receive collisions, and Simulation::contacts() is 0.
  bool counts_contacts = true;
  /// If true, Box2D's boxes have their full sides, and its polygon skin adds to them; else they are smaller
  /// by the skin.
  bool has_full_sides = false;
  /// If true, the bodies are plain Objects, which have no mass and move by their velocities. For the product
  /// only.
  bool massless = false;
  /// If true, massless Objects are HARD and block each other. If this and `hearing` are false, they are
  /// SPECTRAL.
  bool blocks = false;
  /// If true, bodies receive collision events, and nothing pushes them. For the product only.
  bool hearing = false;
  /// The scene in generalised coordinates, for methods that solve ordinary differential equations; null for
  /// scenes with contacts.
  std::shared_ptr<const Equations> equations;
  /// True if there are no bodies, only equations.
  bool abstract() const { return bodies.empty() && beams.empty(); }
  /// True if there are only rigid bodies and joints.
  bool rigid() const { return !bodies.empty() && beams.empty() && !massless && !hearing; }
  double duration() const { return tick * ticks; }
  int countDynamic() const;
};

}  // namespace lab

// What an experiment consists of: bodies, shapes, joints, forces and how long it lasts. Every engine builds
// its world from this one description, so all of them start from the same state. Metres, seconds, kilograms,
// radians; y points up.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "Vec.h"

namespace lab {

class Equations;

/// How long a tick lasts: the product's 30 per second.
constexpr double kTick = 1.0 / 30;

enum class Motion {
  FIXED,      ///< never moves
  KINEMATIC,  ///< moves by its velocity, and nothing pushes it
  DYNAMIC,
};

struct Shape {
  enum class Kind { CIRCLE, BOX };
  Kind kind = Kind::CIRCLE;
  double radius = 0;  ///< of a circle
  Vec half;           ///< half width and half height of a box
  Vec centre{};       ///< from the body's; not (0, 0): of what nothing pushes
};

struct Body {
  Motion motion = Motion::DYNAMIC;
  Vec position;  ///< of the centre of mass, from the scene's origin
  double angle = 0;
  Vec velocity;
  double spin = 0;  ///< radians per second
  double mass = 1;
  bool rotates = false;  ///< if not, its inertia is infinite; if so, that of its shape, or of its shapes' sum
  std::vector<Shape> shapes;  ///< none: a point that touches nothing
  double friction = 0;        ///< of a pair: the square root of the product
  double restitution = 0;     ///< of a pair: the larger
  bool fast = false;          ///< asks for whatever the engine has against tunnelling
  double linear_drag = 0;     ///< force per speed, in kg/s
};

/// A dynamic body without a shape: it touches nothing.
Body point(Vec position, Vec velocity = {}, double mass = 1);
/// A dynamic body with one shape.
Body ball(Vec position, Vec velocity, double radius, double mass = 1);
Body box(Vec position, Vec half, double mass = 1);
/// A box that rotates, with friction.
Body crate(Vec position, Vec half, double friction, double mass = 1);
/// A box that never moves.
Body wall(Vec centre, Vec half, double angle = 0);
/// A wall 10 m thick, the middle of whose top is at 0.
Body ground(double half_width, double friction, double restitution = 0);
/// The moment of inertia per mass.
double inertiaOf(const Shape& shape);

struct Joint {
  enum class Kind {
    ROD,     ///< the anchors stay as far apart as they are at the start
    HINGE,   ///< the anchors stay where the other one is
    SPRING,  ///< a force of stiffness × (distance − rest length) + damping × its rate
  };
  Kind kind = Kind::ROD;
  int a = -1;    ///< a body's index; −1: the ground
  int b = 0;     ///< the same
  Vec anchor_a;  ///< at the start, from the scene's origin
  Vec anchor_b;
  double stiffness = 0;    ///< N/m
  double damping = 0;      ///< N·s/m
  double rest_length = 0;  ///< m
};

/// Of two bodies, or of one and the ground (−1).
Joint rod(int a, Vec from, int b, Vec to);
/// At rest as long as it is.
Joint spring(int a, Vec from, int b, Vec to, double stiffness);
Joint hinge(int a, int b, Vec at);

/// An elastic beam that lies along x and is clamped at x = 0; its free end counts as the scene's body 0.
struct Beam {
  double length = 0;     ///< m
  double thickness = 0;  ///< m; its depth is 1 m
  double modulus = 0;    ///< Young's, in Pa
  double density = 0;    ///< kg/m³
  double tip_force = 0;  ///< N, downwards, from the start on
  double damping = 0;    ///< part of critical damping of the first mode
  int elements = 0;      ///< how finely it is divided along its length
};

/// Square meshes of threads, hung by its two upper corners; its node in a row and a column is the scene's
/// body of number row × columns + column. Methods without cloths see these bodies, which rods hold together.
struct Cloth {
  int columns = 0;       ///< of nodes
  int rows = 0;          ///< the same
  double mesh = 0;       ///< m
  double mass = 0;       ///< of the whole, kg
  double stiffness = 0;  ///< m/s²: of the product's threads, per their part of the mass
};

struct BodyState {
  Vec position;  ///< from the scene's origin
  Vec velocity;
  double angle = 0;
  double spin = 0;
};

/// Acceleration by a force field that the game defines, at time t, for a body in a state.
using Field = std::function<Vec(double t, const BodyState&)>;

struct Scene {
  std::vector<Body> bodies;
  std::vector<Joint> joints;
  std::vector<Beam> beams;
  std::vector<Cloth> cloths;
  Vec gravity;
  Field field;  ///< none: empty
  Vec origin;   ///< where the scene is in the world: whole metres
  double tick = kTick;
  int ticks = 0;
  /// May bodies at rest sleep? If so, in each engine as it does by default.
  bool may_sleep = false;
  /// Or does nothing touch anything?
  bool collides = true;
  /// Box2D's boxes have their full sides, and its skin comes on top; else they are smaller by it.
  bool has_full_sides = false;
  /// The bodies are the book's Objects, which have no mass and move by themselves: for the product alone.
  bool massless = false;
  /// Massless Objects block each other: HARD. If not, and not `hearing`, they are SPECTRAL.
  bool blocks = false;
  /// Bodies hear of what they meet, and nothing pushes them: for the product alone.
  bool hearing = false;
  /// The same in generalised coordinates, for methods that solve ordinary differential equations; null where
  /// there are contacts.
  std::shared_ptr<const Equations> equations;
  /// There are no bodies, only equations.
  bool abstract() const { return bodies.empty() && beams.empty(); }
  /// Rigid bodies and joints and nothing else.
  bool rigid() const { return !bodies.empty() && beams.empty() && !massless && !hearing; }
  double duration() const { return tick * ticks; }
};

}  // namespace lab

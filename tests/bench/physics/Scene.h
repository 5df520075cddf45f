// A scene of rigid bodies, from which both engines build their worlds. Lengths are in metres, times in
// seconds, masses are areas times densities; y points down. All bodies start upright (angle 0).
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace bench::physics {

/// A box along its body's axes, or a circle.
struct Part {
  double half_width = 0;
  double half_height = 0;
  double radius = 0;  ///< if above 0, the part is a circle
  double x = 0;       ///< x of its centre, relative to the body's centre of mass
  double y = 0;

  bool isCircle() const { return radius > 0; }
  double area() const;
};

enum class Motion { STATIC, KINEMATIC, DYNAMIC };

struct Body {
  std::vector<Part> parts;
  double x = 0;
  double y = 0;
  Motion motion = Motion::DYNAMIC;
  double vx = 0;
  double vy = 0;
  double spin = 0;  ///< radians per second
  double density = 1;

  double mass() const;
};

/// A point at which two bodies are connected, and about which they can turn.
struct Hinge {
  int a = kWorld;
  int b = 0;
  double x = 0;  ///< x of the point at the start, in the world
  double y = 0;

  static constexpr int kWorld = -1;
};

/// Position of a body, and cosine and sine of its angle.
struct Pose {
  double x = 0;
  double y = 0;
  double cosine = 1;
  double sine = 0;

  /// Converts a point from the body's axes to the world's.
  Pose at(double local_x, double local_y) const {
    return {x + cosine * local_x - sine * local_y, y + sine * local_x + cosine * local_y, cosine, sine};
  }
};

/// Region in which the centres of all dynamic bodies must be. A body outside has passed through a wall, or is
/// more than half inside a wall.
struct Room {
  double left = -std::numeric_limits<double>::infinity();
  double right = std::numeric_limits<double>::infinity();
  double top = -std::numeric_limits<double>::infinity();
  double bottom = std::numeric_limits<double>::infinity();
  int frame = Hinge::kWorld;  ///< rotating body in whose axes the region is given; kWorld: the world's axes

  /// True if `pose` is inside the region. `poses` are the poses of all bodies.
  bool holds(const std::vector<Pose>& poses, const Pose& pose) const;
};

struct Scene {
  std::vector<Body> bodies;
  std::vector<Hinge> hinges;
  Room room;
  double gravity = 10;  ///< metres per second²
  int ticks = 0;        ///< number of measured ticks, each of kTick
  bool sleep = true;    ///< bodies at rest may sleep
  bool collide = true;  ///< false: nothing collides

  static constexpr double kTicksPerSecond = 30;
  static constexpr double kFriction = 0.6;  ///< for all bodies; restitution is 0

  int countDynamic() const;
};

}  // namespace bench::physics

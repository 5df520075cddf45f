// The everyday workload: n boxes in a square world, each with a position, a velocity and a solidness. Equal
// arguments give an equal scene everywhere.
//
// Boxes start on distinct whole cells, in no particular order, and fly in random directions at up to one cell
// per tick. All numbers are multiples of a grain so coarse that float, double and fixed point hold every
// position exactly, and each velocity is unchanged by the float arithmetic of the Dragonfly book (length ×
// normalised vector). So engines of all number types must send exactly equal events.
//
// In a tick, every engine moves the boxes with a velocity one after another in id order. A solid mover
// collides with all solid boxes that it would touch at its target (edges included). Each pair is reported to
// both, the mover first, pairs in id order. A pair of two HARD boxes blocks: the mover stays and reverses. If
// the target is outside [0, side) on an axis, the mover stays and reverses on that axis. Otherwise it moves.
#pragma once

#include <string>
#include <vector>

#include "shared/values/Solidness.h"

namespace bench {

enum class Mix {
  HARD_ONLY,    ///< HARD, 1×1
  MIXED,        ///< 60 % HARD, 30 % SOFT, 10 % SPECTRAL, 1×1
  SPRITES,      ///< kinds as in MIXED, 1 to 12 wide and 1 to 4 high
  MOVING,       ///< SPECTRAL, so there is only motion
  MOVING_HARD,  ///< HARD, 1×1, so far apart that there are no collisions for kLonelyTicks
  REST,         ///< HARD, 1×1, 99 % without velocity
};

/// Number of ticks without collisions in MOVING_HARD.
inline constexpr int kLonelyTicks = 48;

/// Returns the value of the key `mix`.
std::string nameOf(Mix mix);

/// A box at its start. Lengths are in cells, velocities in cells per tick; the position is the box's centre.
struct Body {
  double x = 0;
  double y = 0;
  double vx = 0;
  double vy = 0;
  int width = 1;
  int height = 1;
  df::Solidness solidness = df::HARD;

  bool isSolid() const { return solidness != df::SPECTRAL; }
  bool moves() const { return vx != 0 || vy != 0; }
};

struct Scene {
  Mix mix = Mix::HARD_ONLY;
  double density = 0;  ///< area of all boxes divided by the world's; for 1×1 boxes, boxes per cell
  double side = 0;     ///< width and height of the world, a whole number of cells
  std::vector<Body> bodies;

  /// Makes a scene of `n` boxes.
  Scene(Mix its_mix, int n, double its_density);

  int count() const { return static_cast<int>(bodies.size()); }
  int countMoving() const;
};

/// Puts an Object, of this engine or of the book's, that has left a square world back, and reflects its
/// velocity at the border.
template <class Object, class Number>
void turnBack(Object& object, Number side) {
  const auto p = object.getPosition();
  const auto v = object.getVelocity();
  const bool left_x = p.getX() < 0 || p.getX() >= side;
  const bool left_y = p.getY() < 0 || p.getY() >= side;
  object.setPosition(p - v);
  object.setVelocity({left_x ? -v.getX() : v.getX(), left_y ? -v.getY() : v.getY()});
}

/// Reverses the velocity of an Object of this engine or of the book's.
template <class Object>
void reverse(Object& object) {
  const auto v = object.getVelocity();
  object.setVelocity(decltype(v)() - v);
}

}  // namespace bench

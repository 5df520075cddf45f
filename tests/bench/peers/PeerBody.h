// An object in a game that uses a peer, that is, another library: position and velocity in the library's
// number type, and a virtual handler for collisions, like an Object's eventHandler.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "Engine.h"
#include "Scene.h"

namespace bench {

template <class Real>
struct PeerBody {
  struct Collision {
    PeerBody* mover;
    PeerBody* other;
    Real x;  ///< x of the mover's target
    Real y;
  };

  PeerBody(const Body& body, std::uint32_t its_id, Tally& its_tally)
      : x(static_cast<Real>(body.x)),
        y(static_cast<Real>(body.y)),
        vx(static_cast<Real>(body.vx)),
        vy(static_cast<Real>(body.vy)),
        half_width(static_cast<Real>(body.width) / 2),
        half_height(static_cast<Real>(body.height) / 2),
        id(its_id),
        solidness(body.solidness),
        tally(its_tally) {}
  virtual ~PeerBody() = default;

  virtual void onCollision(const Collision& collision) {
    tally.event(id);
    if (collision.mover != this || !blocks(*collision.other) || turned == tally.tick) return;
    turned = tally.tick;
    ++tally.blocked;
    vx = -vx;
    vy = -vy;
  }

  bool isSolid() const { return solidness != df::SPECTRAL; }
  bool blocks(const PeerBody& other) const { return solidness == df::HARD && other.solidness == df::HARD; }
  /// True if the two boxes would touch if this one was at (at_x, at_y).
  bool touches(const PeerBody& other, Real at_x, Real at_y) const {
    return std::abs(other.x - at_x) <= half_width + other.half_width &&
           std::abs(other.y - at_y) <= half_height + other.half_height;
  }

  Real x;
  Real y;
  Real vx;
  Real vy;
  Real half_width;
  Real half_height;
  std::uint32_t id;
  std::int32_t handle = 0;  ///< this object in a library with numeric handles
  void* shape = nullptr;    ///< this object in a library with pointers
  df::Solidness solidness;
  std::uint64_t turned = 0;  ///< last tick in which this object was blocked
  Tally& tally;
};

}  // namespace bench

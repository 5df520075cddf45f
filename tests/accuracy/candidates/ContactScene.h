// The common part of the contact candidates, so that they differ only in their solvers: bodies, their
// contacts, and the data that a contact keeps from step to step. In metres, seconds and kilograms.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "Method.h"
#include "physics/geometry/Manifold.h"

namespace lab {

using naiad::physics::Rotation;
using naiad::physics::Vec2;

struct ContactBody {
  Vec2 position;
  Vec2 velocity;
  Rotation rotation;
  double angle = 0;
  double spin = 0;
  double inverse_mass = 0;  ///< 0 for bodies that nothing can push, as is inverse_inertia
  double inverse_inertia = 0;
  Vec2 gravity;
  double drag = 0;  ///< 1/s
  double friction = 0;
  std::vector<naiad::physics::ConvexShape> shapes;
  std::vector<naiad::physics::RotatedShape> turned;
  Vec2 lower, upper;  ///< bounding box of the whole step's motion
  double room = 0;    ///< largest distance it may move in the step

  bool isPushed() const { return inverse_mass > 0; }
  void turnBy(double by) {
    angle += by;
    rotation = naiad::physics::turned(rotation, by);
  }
};

struct ContactArms {
  Vec2 a, b;  ///< contact point relative to each body's centre, in world axes
};

struct ContactPoint {
  Vec2 anchor_a, anchor_b;  ///< the contact point in each body's own axes, as found
  ContactArms found;        ///< the anchors in world axes, as found
  double gap = 0;           ///< gap as found
  double normal_mass = 0, tangent_mass = 0;
  double normal_impulse = 0, tangent_impulse = 0;  ///< impulse or force, depending on the solver
  double normal_penalty = 0, tangent_penalty = 0;
  bool sticks = false;
  std::uint32_t id = 0;
};

struct ContactPair {
  int a = 0, b = 0, shape_a = 0, shape_b = 0;
  Vec2 normal;  ///< points from a to b
  double friction = 0;
  int count = 0;
  std::array<ContactPoint, 2> points;  ///< only the first `count` are valid
  naiad::physics::ReferenceFace reference;

  std::span<ContactPoint> used() { return {points.data(), static_cast<std::size_t>(count)}; }
  std::span<const ContactPoint> used() const { return {points.data(), static_cast<std::size_t>(count)}; }
};

struct ContactScene {
  explicit ContactScene(const Scene& scene);

  /// True if the scene has only valid bodies with shapes, and no bounces, because impacts are a different
  /// problem from lasting contacts.
  static bool canExpress(const Scene& scene);

  /// Finds pairs that touch, or may do so within `h`, with gaps up to `reach`. Points that existed before
  /// keep their impulses.
  void find(double h, double reach);

  /// Changes all velocities by gravity and drag: v += h g.
  void kick(double h);
  /// Moves all bodies by their velocities: x += h v.
  void drift(double h);

  std::vector<ContactBody> bodies;
  std::vector<ContactPair> pairs;  ///< sorted by ids
  double gravity = 0;              ///< magnitude of the acceleration, in m/s²

 private:
  void findPair(int a, int b, double reach);
  std::vector<ContactPair> m_before;
  std::vector<int> m_order;  // indices of bodies, sorted by lower.x
};

/// Return the arms and the gap for the bodies' present positions.
ContactArms armsOf(const ContactScene& scene, const ContactPair& pair, const ContactPoint& point);
double gapOf(const ContactScene& scene, const ContactPair& pair, const ContactPoint& point,
             const ContactArms& arms);
/// Returns the velocity of b relative to a at the contact.
Vec2 speedOf(const ContactScene& scene, const ContactPair& pair, const ContactArms& arms);
/// Returns the effective mass: the impulse along `direction` per change of that velocity.
double massOf(const ContactScene& scene, const ContactPair& pair, const ContactArms& arms, Vec2 direction);
/// Apply an impulse to the velocities (push), or to the positions (shift).
void push(ContactScene& scene, const ContactPair& pair, const ContactArms& arms, Vec2 impulse);
void shift(ContactScene& scene, const ContactPair& pair, const ContactArms& arms, Vec2 impulse);

/// Adds a body's shapes. `up` is the direction of y in the scene: 1, or −1 if it points down in the
/// candidate. Returns the moment of inertia per mass. With several shapes it is that of the last one, because
/// no such body can be pushed here.
double addShapes(const Body& body, double up, std::vector<naiad::physics::ConvexShape>& shapes);

/// Common interface of the candidates.
class ContactSolver {
 public:
  virtual ~ContactSolver() = default;
  virtual void step(ContactScene& scene, double tick, int substeps) = 0;
};

SimulationPtr runContacts(const Scene& scene, std::unique_ptr<ContactSolver> solver);

/// Creates a simulation for RegisteredMethod; null if the scene cannot be expressed.
template <class Solver>
SimulationPtr makeContacts(const Scene& scene) {
  return ContactScene::canExpress(scene) ? runContacts(scene, std::make_unique<Solver>()) : nullptr;
}

}  // namespace lab

// What the candidates for contacts share, so that they differ in how they solve and in nothing else: bodies,
// which of them touch where, and what is remembered of a contact from step to step. Metres, seconds,
// kilograms.
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
  double inverse_mass = 0;  ///< both 0 for what nothing pushes
  double inverse_inertia = 0;
  Vec2 gravity;
  double drag = 0;  ///< 1/s
  double friction = 0;
  std::vector<naiad::physics::ConvexShape> shapes;
  std::vector<naiad::physics::TurnedShape> turned;
  Vec2 lower, upper;  ///< bounds, with room for the step
  double room = 0;    ///< how far it may get in the step

  bool isPushed() const { return inverse_mass > 0; }
  void turnBy(double by) {
    angle += by;
    rotation = naiad::physics::turned(rotation, by);
  }
};

struct ContactArms {
  Vec2 a, b;  ///< from the bodies' centres, in the axes of the world
};

struct ContactPoint {
  Vec2 anchor_a, anchor_b;  ///< in the bodies' own axes; the same place when it was found
  ContactArms found;        ///< the same then, in the axes of the world
  double gap = 0;           ///< then
  double normal_mass = 0, tangent_mass = 0;
  double normal_impulse = 0, tangent_impulse = 0;  ///< or force: as the solver likes
  double normal_penalty = 0, tangent_penalty = 0;
  bool sticks = false;
  std::uint32_t id = 0;
};

struct ContactPair {
  int a = 0, b = 0, shape_a = 0, shape_b = 0;
  Vec2 normal;  ///< from a to b
  double friction = 0;
  int count = 0;
  std::array<ContactPoint, 2> points;  ///< the first `count`
  naiad::physics::ReferenceFace reference;

  std::span<ContactPoint> used() { return {points.data(), static_cast<std::size_t>(count)}; }
  std::span<const ContactPoint> used() const { return {points.data(), static_cast<std::size_t>(count)}; }
};

struct ContactScene {
  explicit ContactScene(const Scene& scene);

  /// Has it nothing but sound bodies with shapes, and no bounces? Impacts are another question than contacts
  /// that last.
  static bool canExpress(const Scene& scene);

  /// Finds who touches whom, or may do so within `h`, with gaps up to `reach`. Points that were there before
  /// keep their impulses.
  void find(double h, double reach);

  /// v += h g, with drag.
  void kick(double h);
  /// x += h v.
  void drift(double h);

  std::vector<ContactBody> bodies;
  std::vector<ContactPair> pairs;  ///< by ids
  double gravity = 0;              ///< its amount

 private:
  void findPair(int a, int b, double reach);
  std::vector<ContactPair> m_before;
  std::vector<int> m_order;  // by lower x
};

/// At this moment.
ContactArms armsOf(const ContactScene& scene, const ContactPair& pair, const ContactPoint& point);
double gapOf(const ContactScene& scene, const ContactPair& pair, const ContactPoint& point,
             const ContactArms& arms);
/// Of b's against a's there.
Vec2 speedOf(const ContactScene& scene, const ContactPair& pair, const ContactArms& arms);
/// What 1 / (what an impulse along `direction` changes of that) is.
double massOf(const ContactScene& scene, const ContactPair& pair, const ContactArms& arms, Vec2 direction);
/// On velocities, and on places.
void push(ContactScene& scene, const ContactPair& pair, const ContactArms& arms, Vec2 impulse);
void shift(ContactScene& scene, const ContactPair& pair, const ContactArms& arms, Vec2 impulse);

/// The one interface of the candidates.
class ContactSolver {
 public:
  virtual ~ContactSolver() = default;
  virtual void step(ContactScene& scene, double tick, int substeps) = 0;
};

SimulationPtr runContacts(const Scene& scene, std::unique_ptr<ContactSolver> solver);

/// For RegisteredMethod.
template <class Solver>
SimulationPtr makeContacts(const Scene& scene) {
  return ContactScene::canExpress(scene) ? runContacts(scene, std::make_unique<Solver>()) : nullptr;
}

}  // namespace lab

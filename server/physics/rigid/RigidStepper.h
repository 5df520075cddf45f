// Common base of RigidWorld and SubstepWorld, which move rotating bodies step by step.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "physics/geometry/ConvexShape.h"
#include "physics/geometry/Manifold.h"
#include "physics/geometry/UnionFind.h"
#include "physics/joint/JointStore.h"
#include "physics/rigid/RigidBody.h"

namespace naiad::physics {

/// The start or end of a contact of two bodies, which is one contact even if several of their shapes touch.
struct RigidEvent {
  double time = 0;  ///< ticks since the start of the step: start of the sub-step, or moment of a fast impact
  int first = 0;    ///< the lower id
  int second = 0;
  bool is_begin = false;
  double impulse = 0;  ///< impulse on `second` along the normal in the whole step; 0 for an end
  Vec2 normal;         ///< direction from `first` to `second`; zero for an end
};

/// A part of a body that does not turn, with its own friction.
struct FrictionPart {
  Bounds bounds;  ///< relative to the body's place
  double friction = 0;
};

/// Not thread-safe.
class RigidStepper {
 public:
  virtual ~RigidStepper() = default;

  /// Reserves memory for this many bodies.
  virtual void expect(std::size_t /*bodies*/) {}
  /// Adds a body. `order` is unique. Shapes are relative to the centre of mass; a body without shapes touches
  /// nothing and is only for joints. Returns the id, or −1 if the body is invalid.
  virtual int addInOrder(std::uint64_t order, const RigidBody& body, std::span<const ConvexShape> shapes) = 0;
  /// Replaces a body's state, unfreezes it, and wakes it and its group. If it is immovable, its neighbours
  /// wake, too. Has no effect if the state is equal and the body is not frozen. Returns false and changes
  /// nothing if the id or `body` is invalid.
  virtual bool set(int id, const RigidBody& body) = 0;
  virtual bool setShapes(int id, std::span<const ConvexShape> shapes) = 0;
  /// Sets parts of a body with their own friction, until the body is removed. A contact that touches several
  /// of them has their mean.
  void setFrictionParts(int id, std::span<const FrictionPart> parts);
  /// Removes a body and its joints; its contacts end without events. Wakes the bodies that lay on it.
  virtual bool remove(int id) = 0;
  virtual const RigidBody& body(int id) const = 0;
  virtual bool exists(int id) const = 0;
  /// Returns a number that is larger than all ids.
  virtual int idLimit() const = 0;
  /// True if the body is in quarantine: it does not move and collides with nothing until set().
  virtual bool isFrozen(int id) const = 0;
  /// True if a contact pushed the body in the last step, or it sleeps. (The forces of joints do not count.)
  virtual bool isPushed(int id) const = 0;
  /// True if the body was stopped or diverted on its path in the last step, although nothing pushed it;
  /// always false in a RigidWorld.
  virtual bool isStopped(int id) const = 0;

  /// Adds a joint between existing bodies; `joint.a` and `joint.b` are ids. Joined bodies do not touch each
  /// other unless `may_touch`. Returns the joint's id, or −1 if it is invalid.
  int addJoint(const Joint& joint, bool may_touch = false);
  /// Changes target, speed, strength or length, and wakes the bodies. Returns false and changes nothing if
  /// the id or `joint` is invalid, or its kind or bodies differ.
  bool setJoint(int id, const Joint& joint);
  bool removeJoint(int id);
  bool jointExists(int id) const { return joints().exists(id); }
  /// Returns the joint with the results of the last step: force, torque, is_broken. A broken joint exists,
  /// without effect, until it is removed.
  const Joint& joint(int id) const { return joints().joint(id); }

  /// Sets whether groups at rest may sleep.
  virtual void setSleeping(bool may_sleep) = 0;
  /// True if the last step abandoned the body and all bodies that it touches: a SubstepWorld must move them.
  virtual bool isGivenUp(int id) const = 0;
  /// True if, since construction, pairs were left out in a crowd, so that some bodies may have passed through
  /// others.
  virtual bool hasThinned() const = 0;
  /// Advances by a tick.
  virtual void step() = 0;
  /// Returns the events of the last step, sorted by (time, ids).
  const std::vector<RigidEvent>& events() const { return m_events; }

 protected:
  void removeJointsOf(int body);
  bool hasFrictionParts() const { return !m_friction_parts.empty(); }
  /// Returns the friction of a contact of two bodies.
  double frictionOf(int a, int b, const Manifold& manifold) const;
  /// Call when the body was changed from outside. The next step of its group, if it is small, starts without
  /// known impulses, like that of a new world. Larger groups keep theirs, because their sweeps need them.
  void forget(int body) { m_forgotten.push_back(body); }
  /// Like forget(), for a body whose neighbour or joint was changed. This changes nothing on which other
  /// groups lie, so that an immovable body is left out.
  void forgetBeside(int id) {
    if (isMovable(body(id))) forget(id);
  }
  /// Finds the small groups of the bodies for which forget() was called, or that touch them. Drops the
  /// impulses of their joints, and calls drop(pair) for each pair of `pairs` with one of their bodies.
  template <class Pairs, class IsMovable, class Drop>
  void applyForget(Pairs& pairs, IsMovable isMovable, Drop drop);
  void sortEvents();

  std::vector<RigidEvent> m_events;
  bool m_joints_changed = false;
  std::vector<int> m_forgotten;  // bodies for which forget() was called

 private:
  struct PartOfBody {
    int id;
    FrictionPart part;
  };
  double frictionAt(int id, Vec2 point) const;
  std::vector<PartOfBody> m_friction_parts;
  // Only valid within applyForget():
  UnionFind m_linked;                      // the groups of movable bodies
  std::vector<std::uint8_t> m_is_changed;  // by root
  std::vector<int> m_group_bodies;         // by root: number of movable bodies
  virtual const JointStore& joints() const = 0;
  virtual JointStore& joints() = 0;
  /// Wakes the body and the bodies that fell asleep with it.
  virtual void wakeRing(int id) = 0;
  void wakeEnds(const Joint& joint);
};

template <class Pairs, class IsMovable, class Drop>
void RigidStepper::applyForget(Pairs& pairs, IsMovable isMovable, Drop drop) {
  constexpr int kSmall = 4;  // maximum number of movable bodies in a group that starts without impulses
  const auto count = static_cast<std::size_t>(idLimit());
  const auto rootOf = [&](int id) { return static_cast<std::size_t>(m_linked.rootOf(id)); };
  const auto visitLinks = [&](auto visit) {
    for (const auto& pair : pairs) {
      if (pair.first >= 0) visit(pair.a, pair.b);
    }
    joints().visitWorking([&](int a, int b) {
      if (a >= 0) visit(a, b);
    });
  };
  m_linked.reset(count);
  visitLinks([&](int a, int b) {
    if (isMovable(a) && isMovable(b)) m_linked.unite(a, b);
  });
  m_is_changed.assign(count, 0);
  for (const int id : m_forgotten) m_is_changed[rootOf(id)] = exists(id) ? 1 : 0;
  m_forgotten.clear();
  visitLinks([&](int a, int b) {  // immovable bodies belong to no group
    if (!isMovable(a) && isMovable(b) && m_is_changed[rootOf(a)] != 0) m_is_changed[rootOf(b)] = 1;
    if (!isMovable(b) && isMovable(a) && m_is_changed[rootOf(b)] != 0) m_is_changed[rootOf(a)] = 1;
  });
  m_group_bodies.assign(count, 0);
  for (int id = 0; id < idLimit(); ++id) m_group_bodies[rootOf(id)] += isMovable(id) ? 1 : 0;
  const auto forgets = [&](int id) {
    return isMovable(id) && m_is_changed[rootOf(id)] != 0 && m_group_bodies[rootOf(id)] <= kSmall;
  };
  for (auto& pair : pairs) {
    if (forgets(pair.a) || forgets(pair.b)) drop(pair);
  }
  joints().forget(forgets);
}

}  // namespace naiad::physics

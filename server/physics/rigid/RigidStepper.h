// Common base of RigidWorld and SubstepWorld, which move rotating bodies step by step.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "physics/geometry/ConvexShape.h"
#include "physics/geometry/Manifold.h"
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
  /// Call when the body was changed from outside: the next step finds its contacts and those of its group
  /// without memory, as in a new world. Larger groups keep it, because their sweeps need it.
  void forget(int body) { m_forgotten.push_back(body); }
  /// Finds the small groups of the bodies for which forget() was called, and calls drop(pair) for each pair
  /// of `pairs` with one of their bodies.
  template <class Pairs, class IsMovable, class Drop>
  void applyForget(Pairs& pairs, IsMovable isMovable, Drop drop);
  void sortEvents();

  std::vector<RigidEvent> m_events;
  bool m_joints_changed = false;
  std::vector<int> m_forgotten;         // bodies for which forget() was called
  std::vector<std::uint8_t> m_forgets;  // by id, only valid within applyForget()

 private:
  struct PartOfBody {
    int id;
    FrictionPart part;
  };
  double frictionAt(int id, Vec2 point) const;
  std::vector<PartOfBody> m_friction_parts;
  virtual const JointStore& joints() const = 0;
  virtual JointStore& joints() = 0;
  /// Wakes the body and the bodies that fell asleep with it.
  virtual void wakeRing(int id) = 0;
  void wakeEnds(const Joint& joint);
};

template <class Pairs, class IsMovable, class Drop>
void RigidStepper::applyForget(Pairs& pairs, IsMovable isMovable, Drop drop) {
  constexpr std::size_t kSmall = 4;              // bodies of a group that is solved without memory
  constexpr std::size_t kMaxVisits = 1'000'000;  // of pairs; bodies that come later keep their impulses
  std::size_t visits = 0;
  m_forgets.assign(static_cast<std::size_t>(idLimit()), 0);
  std::vector<int> group;
  const auto isIn = [&](int id) { return m_forgets[static_cast<std::size_t>(id)] == 1; };
  for (const int first : m_forgotten) {
    if (visits > kMaxVisits) break;
    if (!exists(first) || m_forgets[static_cast<std::size_t>(first)] != 0) continue;
    group.assign(1, first);
    m_forgets[static_cast<std::size_t>(first)] = 1;
    const auto add = [&](int from, int to) {
      if (!isIn(from) || !(isMovable(from) || from == first)) return;
      if (m_forgets[static_cast<std::size_t>(to)] != 0 || !isMovable(to)) return;
      m_forgets[static_cast<std::size_t>(to)] = 1;
      group.push_back(to);
    };
    for (std::size_t before = 0; before < group.size() && group.size() <= kSmall;) {
      before = group.size();
      visits += 2 * pairs.size();
      for (const auto& pair : pairs) {
        if (pair.first >= 0) add(pair.a, pair.b), add(pair.b, pair.a);
      }
      joints().visitWorking([&](int a, int b) {
        if (a >= 0) add(a, b), add(b, a);
      });
    }
    const bool is_small = group.size() <= kSmall;
    for (auto& pair : pairs) {
      if (is_small && ((isIn(pair.a) && isMovable(pair.a)) || (isIn(pair.b) && isMovable(pair.b))))
        drop(pair);
    }
    for (const int id : group) {
      if (is_small && isMovable(id)) joints().forget(id);
      m_forgets[static_cast<std::size_t>(id)] = 2;
    }
  }
  m_forgotten.clear();
}

}  // namespace naiad::physics

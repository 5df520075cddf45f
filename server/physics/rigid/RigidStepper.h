// What moves bodies that turn, a step at a time: RigidWorld or SubstepWorld.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "physics/geometry/ConvexShape.h"
#include "physics/joint/JointStore.h"
#include "physics/rigid/RigidBody.h"

namespace naiad::physics {

/// A contact of two bodies began or ended; however many of their shapes take part, it is one.
struct RigidEvent {
  double time = 0;  ///< since the start of the step: when the sub-step began, or the moment of a fast impact
  int first = 0;    ///< the lower id
  int second = 0;
  bool is_begin = false;
  double impulse = 0;  ///< when it begins: along the normal, on second, until the end of the step
  Vec2 normal;         ///< when it begins: from first to second
};

/// Not thread-safe.
class RigidStepper {
 public:
  virtual ~RigidStepper() = default;

  /// That many bodies will be there: memory is taken once.
  virtual void expect(std::size_t /*bodies*/) {}
  /// `order`: unique among the bodies. Shapes are relative to the centre of mass; none: a body that touches
  /// nothing, for joints. Returns the id, or −1 if the body is not sound.
  virtual int addInOrder(std::uint64_t order, const RigidBody& body, std::span<const ConvexShape> shapes) = 0;
  /// Replaces a body's state, wakes it and what it lies among, and thaws it. Equal to what there is: nothing
  /// happens. False if there is none, or `body` is not sound; then nothing changes.
  virtual bool set(int id, const RigidBody& body) = 0;
  virtual bool setShapes(int id, std::span<const ConvexShape> shapes) = 0;
  /// Its contacts end without an event; joints with it go, too. What it carried wakes.
  virtual bool remove(int id) = 0;
  virtual const RigidBody& body(int id) const = 0;
  virtual bool exists(int id) const = 0;
  /// Ids are below this.
  virtual int idLimit() const = 0;
  /// Is the body in quarantine? It is kept as it is and collides with nothing, until set().
  virtual bool isFrozen(int id) const = 0;
  /// Did it move only a part of its way in the last step, though nothing has pushed it?
  virtual bool isStopped(int id) const = 0;

  /// Between bodies that exist; `joint.a` and `joint.b` are ids. Bodies on a joint do not touch each other
  /// unless `may_touch`. Returns the joint's id, or −1 if it is not valid.
  int addJoint(const Joint& joint, bool may_touch = false);
  /// Changes targets, speeds, strengths and lengths: not the kind nor the bodies. Wakes the bodies.
  bool setJoint(int id, const Joint& joint);
  bool removeJoint(int id);
  bool jointExists(int id) const { return joints().exists(id); }
  /// As it was given, with what the last step wrote: force, torque, is_broken. A broken one stays, and does
  /// nothing, until it is removed.
  const Joint& joint(int id) const { return joints().joint(id); }

  /// May groups at rest sleep?
  virtual void setSleeping(bool may_sleep) = 0;
  /// Did the last step take what a SubstepWorld would do better, with all that it touches?
  virtual bool isGivenUp(int id) const = 0;
  /// Were ever so many in one place that some pass through others?
  virtual bool hasThinned() const = 0;
  /// Goes on by a tick.
  virtual void step() = 0;
  /// Of the last step, by (time, ids).
  const std::vector<RigidEvent>& events() const { return m_events; }

 protected:
  void removeJointsOf(int body);
  void sortEvents();

  std::vector<RigidEvent> m_events;
  bool m_joints_changed = false;

 private:
  virtual const JointStore& joints() const = 0;
  virtual JointStore& joints() = 0;
  /// The body, and what fell asleep with it.
  virtual void wakeRing(int id) = 0;
  void wakeEnds(const Joint& joint);
};

}  // namespace naiad::physics

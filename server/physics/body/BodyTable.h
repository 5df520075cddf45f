// The bodies of a world: their physical data, in addition to what the store has for all Objects.
//
// A scene without bodies has no table. A body has a row from construction to destruction; rows of deleted
// bodies are reused. The BodyLayer and each Body share ownership, because a Body may outlive its world.
#pragma once

#include <cstdint>
#include <vector>

#include "physics/body/BodyGeometry.h"
#include "physics/body/BodyJoints.h"
#include "physics/body/Metric.h"
#include "physics/body/WorldNames.h"
#include "physics/flight/FlightField.h"
#include "physics/flight/FlightSpring.h"
#include "physics/geometry/Place.h"
#include "physics/geometry/Vec2.h"
#include "physics/numerics/Integrator.h"

namespace naiad::physics {

/// The force law of a body in flight.
enum class FlightKind : std::uint8_t {
  kFree,  ///< a constant acceleration: gravity and the force applied in this tick
  kLinearDrag,
  kQuadraticDrag,
  kSpring,  ///< a spring to a point; linear drag is added to its damping
  kField,   ///< any mix: the game's field, both drags, or a spring with quadratic drag
};

/// Default friction of bodies and Objects without mass.
inline constexpr double kUsualFriction = 0.5;

/// Data of every body, read and written in each step.
struct BodyRow {
  ObjectKey key;
  const Object* p_object = nullptr;
  std::uint64_t order = 0;       ///< order of construction
  std::uint8_t last_solver = 0;  ///< the BodySolver that moved it in the last step
  Place place;                   ///< the Object's position
  Vec2 velocity;                 ///< metric cells per tick
  Vec2 force;                    ///< applied in the next step, mass · metric cells per tick²
  double mass = 1;
  double inverse_mass = 1;  ///< 0 if kinematic
  double gravity_scale = 1;
  double restitution = 0;
  double friction = kUsualFriction;
  FlightKind flight = FlightKind::kFree;
  bool used = false;
  bool is_kinematic = false;
  bool hears_ends = false;         ///< the body gets an EventContactEnd for its contacts
  bool touches_soft = false;       ///< a soft body pushed it in the last step: not for an ImpactWorld
  bool frozen = false;             ///< in quarantine: stands still until the game sets its place or velocity
  FixedVector published_position;  ///< last position given to the store; if it has another, the game moved it
  FixedVector published_velocity;
};

/// Data of bodies with drag, a spring or a field.
struct BodyMedium {
  double linear_drag = 0;     ///< drag force over velocity and mass, per tick
  double quadratic_drag = 0;  ///< drag force over velocity² and mass, per metric cell
  Spring spring;
  Place anchor;
  const ForceField* field = nullptr;  ///< not owned
  Place field_origin;
};

/// Settings of a world, set by its game (PhysicsManager).
struct BodySettings {
  Vec2 gravity;                               ///< metric cells per tick²
  double obstacle_friction = kUsualFriction;  ///< friction of HARD Objects without mass
  double obstacle_restitution = 0;            ///< restitution of HARD Objects without mass
  IntegratorOptions integrator;
  bool is_fast = false;   ///< a SubstepWorld moves all bodies
  bool may_sleep = true;  ///< groups at rest may sleep
};

/// Counters since the world was made.
struct BodyCounters {
  std::uint64_t quarantined = 0;  ///< number of times that a body was frozen
  std::uint64_t limited = 0;      ///< times that a push, speed, spin or place was reduced to the limit
  IntegratorCounters integrator;
};

class BodyTable {
 public:
  using Index = std::uint32_t;

  Index add(const Object* p_object, ObjectKey key);
  void remove(Index index);
  BodyRow& row(Index index) { return m_rows[index]; }
  const BodyRow& row(Index index) const { return m_rows[index]; }
  /// Returns the drag, spring and field of the row's body; creates them if needed.
  BodyMedium& medium(Index index);
  const BodyMedium& medium(Index index) const { return index < m_media.size() ? m_media[index] : kNoMedium; }
  /// Returns the geometry of the row's body; creates it if needed.
  BodyGeometry& form(Index index);
  const BodyGeometry& form(Index index) const { return index < m_forms.size() ? m_forms[index] : kNoForm; }
  /// Returns the moment of inertia per mass; `box` is the Object's box, used if the body has no other shape.
  double unitInertia(Index index, const FixedBox& box) const;
  /// Reads changes that the game made to position and velocity by the Object's own setters since the last
  /// step. The arguments are the store's present values.
  void syncFromStore(Index index, FixedVector position, FixedVector velocity);
  /// Sets the body's FlightKind from its medium.
  void classify(Index index);

  /// Returns the rows in use, by order of construction.
  const std::vector<Index>& inOrder() const { return m_order; }

  BodyJoints joints;
  Metric metric;
  BodySettings settings;
  BodyCounters counters;
  std::int64_t ticks = 0;  ///< number of steps since the table was made; also the time of fields
  int soft_bodies = 0;     ///< number of soft bodies; they use `metric`, too

 private:
  static const BodyMedium kNoMedium;
  static const BodyGeometry kNoForm;

  std::vector<BodyRow> m_rows;
  std::vector<BodyMedium> m_media;    ///< by row; may be shorter than m_rows
  std::vector<BodyGeometry> m_forms;  ///< by row; may be shorter than m_rows
  std::vector<Index> m_free;
  std::vector<Index> m_order;
  std::uint64_t m_next_order = 1;
};

}  // namespace naiad::physics

// The bodies of a world: what the physics knows of each, beside what the store knows of all Objects.
//
// A scene without bodies has no table. A body has a row from construction to destruction; rows of
// deleted bodies are used again; `order` is the order of construction. Counted: by the layer and by each
// Body, so that a Body that outlives its world goes on working.
#pragma once

#include <cstdint>
#include <vector>

#include "physics/body/BodyForm.h"
#include "physics/body/BodyJoints.h"
#include "physics/body/Metric.h"
#include "physics/body/WorldNames.h"
#include "physics/flight/FlightField.h"
#include "physics/flight/FlightSpring.h"
#include "physics/geometry/Place.h"
#include "physics/geometry/Vec2.h"
#include "physics/numerics/Integrator.h"

namespace naiad::physics {

/// What moves a body, beside forces.
enum class FlightKind : std::uint8_t {
  kFree,  ///< gravity and this tick's force: constant
  kLinearDrag,
  kQuadraticDrag,
  kSpring,  ///< to a point; linear drag adds to its damping
  kField,   ///< that the game defines; linear and quadratic drag count as well
};

/// Of bodies and of Objects without mass.
inline constexpr double kUsualFriction = 0.5;

/// Of every body, read and written in each step.
struct BodyRow {
  ObjectKey key;
  const Object* p_object = nullptr;
  std::uint64_t order = 0;       ///< of construction
  std::uint8_t last_solver = 0;  ///< the BodySolver that moved it in the last step
  Place place;                   ///< the Object's position
  Vec2 velocity;                 ///< metric cells per tick
  Vec2 force;                    ///< for the next step, mass · metric cells per tick²
  double mass = 1;
  double inverse_mass = 1;  ///< 0 for a kinematic one
  double gravity_scale = 1;
  double restitution = 0;
  double friction = kUsualFriction;
  FlightKind flight = FlightKind::kFree;
  bool used = false;
  bool is_kinematic = false;
  bool hears_ends = false;    ///< of contacts
  bool touches_soft = false;  ///< a soft body has pushed it since its last step: no case for event-exactness
  bool frozen = false;        ///< quarantined: stands until the game sets its place or velocity
  FixedVector
      published_position;  ///< as the store got it last; if it holds another now, the game moved the body
  FixedVector published_velocity;
};

/// Of those that use it.
struct BodyMedium {
  double linear_drag = 0;     ///< force over velocity and mass, per tick
  double quadratic_drag = 0;  ///< force over velocity² and mass, per metric cell
  Spring spring;
  Place anchor;
  const ForceField* field = nullptr;  ///< not owned
  Place field_origin;
};

/// Of a world, set by its game (PhysicsManager).
struct BodySettings {
  Vec2 gravity;                               ///< metric cells per tick²
  double obstacle_friction = kUsualFriction;  ///< of HARD Objects without mass
  double obstacle_restitution = 0;            ///< likewise
  IntegratorOptions integrator;
  bool is_fast = false;   ///< bodies are moved by a SubstepWorld
  bool may_sleep = true;  ///< groups at rest
};

/// Since the world was made.
struct BodyCounters {
  std::uint64_t quarantined = 0;  ///< bodies that were frozen
  std::uint64_t limited = 0;      ///< times that a push, speed, spin or place was cut to the largest there is
  IntegratorCounters integrator;
};

class BodyTable {
 public:
  using Index = std::uint32_t;

  Index add(const Object* p_object, ObjectKey key);
  void remove(Index index);
  BodyRow& row(Index index) { return m_rows[index]; }
  const BodyRow& row(Index index) const { return m_rows[index]; }
  /// Grows when it is asked for the first time.
  BodyMedium& medium(Index index);
  const BodyMedium& medium(Index index) const { return index < m_media.size() ? m_media[index] : kNoMedium; }
  /// Likewise.
  BodyForm& form(Index index);
  const BodyForm& form(Index index) const { return index < m_forms.size() ? m_forms[index] : kNoForm; }
  /// Moment of inertia per mass, of a body with this Object's box if it has no other shape.
  double unitInertia(Index index, const FixedBox& box) const;
  /// Take over what the game has done to position and velocity since the last step, by the Object's own
  /// setters: these are what the store holds now.
  void absorb(Index index, FixedVector position, FixedVector velocity);
  /// What kind of flight its medium asks for.
  void classify(Index index);

  /// Those in use, by order of construction.
  const std::vector<Index>& inOrder() const { return m_order; }

  BodyJoints joints;
  Metric metric;
  BodySettings settings;
  BodyCounters counters;
  std::int64_t ticks = 0;  ///< steps since the world was made: the time of fields
  int soft_bodies = 0;     ///< they live in the same metric

 private:
  static const BodyMedium kNoMedium;
  static const BodyForm kNoForm;

  std::vector<BodyRow> m_rows;
  std::vector<BodyMedium> m_media;  ///< by index; shorter than m_rows
  std::vector<BodyForm> m_forms;    ///< likewise
  std::vector<Index> m_free;
  std::vector<Index> m_order;
  std::uint64_t m_next_order = 1;
};

}  // namespace naiad::physics

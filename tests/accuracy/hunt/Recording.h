// The recorded course of a scene: the input of the judges.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "HuntScene.h"

namespace hunt {

struct BodyState {
  Vec2 place, velocity;
  double angle = 0, spin = 0;
  bool present = false;
  bool frozen = false;

  friend bool operator==(const BodyState&, const BodyState&) = default;
};

struct ContactEvent {
  int tick = 0;
  bool begins = true;
  int receiver = kNothing;
  int first = kNothing, second = kNothing;  ///< indices of bodies, or obstacleNumber()
  double gap = -1;  ///< least gap that the pair can have had in this tick; below 0 if unknown

  int gone = kNothing;  ///< the deleted partner, if an end event lacks it

  int other() const {
    const int its = first == receiver ? second : first;
    return its != kNothing ? its : gone;
  }
};

/// A contact that has begun and not ended, for a receiver that gets end events.
struct OpenContact {
  int receiver = kNothing;
  int other = kNothing;
  int since = 0;       ///< tick of its begin
  bool apart = false;  ///< it did not begin now, and the other is gone, or far away, or one is SPECTRAL
};

/// Sums over the present bodies of group 0 that are not kinematic.
struct Sums {
  double kinetic = 0;
  double potential = 0;  ///< energy in gravity, fields, springs and mouse joints
  double stiff = 0;      ///< energy in springs and fields that oscillate faster than a sub-step follows
  double pull = 0;       ///< sum of the amounts of these forces
  double rest = 0;       ///< kinetic energy of bodies with the speed that gravity adds in a quarter of a tick
  Vec2 momentum;
  Vec2 force;                 ///< gravity's
  double momentum_scale = 0;  ///< sum of the amounts of momentum
  double angular = 0;         ///< about the common centre of mass
  double angular_scale = 0;

  double energy() const { return kinetic + potential + stiff; }
};

/// State after a tick. All lengths are metric.
struct Tick {
  std::vector<BodyState> bodies;
  Sums sums;
  bool acted = false;      ///< an action was carried out in this tick
  bool displaced = false;  ///< a setter has displaced something, or bodies overlapped at the start
  double depth = 0;        ///< deepest overlap as a part of the thinner body's half width
  double opening = 0;      ///< widest opening of a joint as a part of its lever
  double shift = 0;        ///< sum of all overlaps and openings, in cells
  std::vector<OpenContact> open;
};

struct Recording {
  std::vector<Tick> ticks;  ///< the first is the start
  std::vector<ContactEvent> events;
  std::uint64_t frozen = 0;   ///< how often a body was frozen
  std::uint64_t limited = 0;  ///< how often a number was reduced to its limit
  SceneData end;              ///< the scene as the actions have changed it
};

/// Amount of what is recorded. STATES leaves out sums, overlaps and openings.
enum class Detail { STATES, ALL };

/// Runs the scene. With `p_start`, the bodies get these states before the first tick.
Recording run(const SceneData& scene, Detail detail, const std::vector<BodyState>* p_start = nullptr);

/// Returns a program that builds the scene through the public API and prints the bodies' states in each tick.
std::string programOf(const SceneData& scene, const std::string& comment);

}  // namespace hunt

#include "RerunJudges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

namespace hunt {
namespace {

struct Difference {
  int tick = 0;
  int body = kNothing;
  double size = 0;
};

// Returns where a body of the scene is first farther than `limit` from its place in another course; with
// limit 0, where any bit differs. Tick 0 of `other` is tick `shift` of `course`. Tiles are not compared.
Difference firstDifference(const Trial& trial, const Recording& other, std::size_t shift, std::size_t ticks,
                           double limit) {
  const std::vector<Tick>& course = trial.course.ticks;
  for (std::size_t i = 0; i <= ticks && i < other.ticks.size() && i + shift < course.size(); ++i) {
    for (std::size_t body = 0; body < trial.scene.bodies.size(); ++body) {
      const BodyData& data = trial.scene.bodies[body];
      if (data.row != kNothing || data.group != 0) continue;
      const BodyState &a = course[i + shift].bodies[body], &b = other.ticks[i].bodies[body];
      const double size = length(a.place - b.place);
      if (a.present != b.present || !(size <= limit) || (limit == 0 && !(a == b)))
        return {static_cast<int>(i + shift), static_cast<int>(body), size};
    }
  }
  return {};
}

std::optional<Finding> findingOf(const Difference& difference, double limit, const char* text) {
  if (difference.body == kNothing) return std::nullopt;
  return Finding{difference.tick, difference.size, limit,
                 std::string(text) + ", body " + std::to_string(difference.body)};
}

int countDynamic(const SceneData& scene) {
  return static_cast<int>(std::count_if(scene.bodies.begin(), scene.bodies.end(),
                                        [](const BodyData& body) { return body.isDynamic(); }));
}

bool hasAnyAction(const SceneData& scene) {
  return std::any_of(scene.actions.begin(), scene.actions.end(), [](auto& its) { return its.present; });
}

bool hasJoints(const SceneData& scene) {
  return std::any_of(scene.joints.begin(), scene.joints.end(), [](auto& its) { return its.present; });
}

bool areEqual(const ContactEvent& a, const ContactEvent& b) {
  return a.tick == b.tick && a.begins == b.begins && a.receiver == b.receiver && a.first == b.first &&
         a.second == b.second;
}

// Returns the events of bodies of group 0.
std::vector<ContactEvent> eventsOfFirst(const SceneData& scene, const Recording& course) {
  std::vector<ContactEvent> events;
  for (const ContactEvent& event : course.events) {
    if (scene.bodies[static_cast<std::size_t>(event.receiver)].group == 0) events.push_back(event);
  }
  return events;
}

bool hasDistantGroup(const SceneData& scene) {
  return std::any_of(scene.bodies.begin(), scene.bodies.end(), [](auto& its) { return its.group == 1; });
}

SceneData withoutDistantGroup(SceneData scene) {
  for (JointData& joint : scene.joints) joint.present = joint.present && scene.groupOf(joint) == 0;
  for (Action& action : scene.actions) action.present = action.present && scene.groupOf(action) < 1;
  for (BodyData& body : scene.bodies) body.present = body.present && body.group == 0;
  for (ObstacleData& obstacle : scene.obstacles) obstacle.present = obstacle.present && obstacle.group == 0;
  return scene;
}

}  // namespace

bool appliesIsolation(const Trial& trial) {
  constexpr double kNear = 1000;
  return std::all_of(trial.course.ticks.begin(), trial.course.ticks.end(), [](const Tick& tick) {
    return std::all_of(tick.bodies.begin(), tick.bodies.end(), [](const BodyState& state) {
      return length(state.place) + length(state.velocity) < kNear;
    });
  });
}

std::optional<Finding> findIsolation(const Trial& trial) {
  SceneData compared = trial.scene;
  const bool has_group = hasDistantGroup(compared);
  if (has_group) {
    compared = withoutDistantGroup(compared);
  } else {
    addDistantGroup(compared);
  }
  const Recording other = run(compared, Detail::STATES);
  const bool is_older = has_group ? trial.scene.later_groups_first : compared.later_groups_first;
  const Difference difference = firstDifference(trial, other, 0, trial.course.ticks.size(), 0);
  if (difference.body != kNothing)
    return findingOf(difference, 0,
                     is_older ? "moves otherwise with an older group far away"
                              : "moves otherwise with a younger group far away");
  const std::vector<ContactEvent> one = eventsOfFirst(trial.scene, trial.course);
  const std::vector<ContactEvent> two = eventsOfFirst(compared, other);
  const auto differ = std::mismatch(one.begin(), one.end(), two.begin(), two.end(), areEqual);
  if (differ.first == one.end() && differ.second == two.end()) return std::nullopt;
  return Finding{differ.first != one.end() ? differ.first->tick : differ.second->tick, 0, 0,
                 "gets other events with a group far away"};
}

bool appliesLevels(const Trial& trial) {
  const SceneData& scene = trial.scene;
  constexpr double kFastest = 1;
  if (hasAnyAction(scene) || hasJoints(scene) || countDynamic(scene) != 1) return false;
  return scene.obstacle_restitution == 0 &&
         std::all_of(scene.bodies.begin(), scene.bodies.end(), [](const BodyData& body) {
           if (!body.present) return true;
           if (body.kinematic) return body.velocity == Vec2{} && body.spin == 0;
           return body.restitution == 0 && body.stiffness == 0 && body.field == kNothing &&
                  length(body.velocity) <= kFastest && std::abs(body.spin) <= kFastest;
         });
}

std::optional<Finding> findLevels(const Trial& trial) {
  constexpr double kNear = .1;
  SceneData changed = trial.scene;
  changed.level = changed.level == df::ACCURACY_FAST ? df::ACCURACY_DEFAULT : df::ACCURACY_FAST;
  changed.ticks = std::min(changed.ticks, 60);
  const Recording other = run(changed, Detail::STATES);
  // A body that the fast level stops may lose the rest of a tick.
  double speed = 0;
  for (const BodyState& state : trial.course.ticks.front().bodies)
    speed = std::max(speed, length(state.velocity));
  const double limit = kNear + speed;
  return findingOf(firstDifference(trial, other, 0, 60, limit), limit, "moves otherwise at the other level");
}

std::optional<Finding> findOpening(const Trial& trial) {
  const double limit = trial.scene.level == df::ACCURACY_FAST ? .1 : .01;
  const auto widest = [](const Recording& course, std::size_t& tick) {
    double most = 0;
    for (std::size_t i = 0; i < course.ticks.size() && !course.ticks[i].displaced; ++i) {
      if (course.ticks[i].opening > most) {
        most = course.ticks[i].opening;
        tick = i;
      }
    }
    return most;
  };
  std::size_t tick = 0, other_tick = 0;
  const double opening = widest(trial.course, tick);
  if (opening <= limit) return std::nullopt;
  SceneData changed = trial.scene;
  changed.level = changed.level == df::ACCURACY_FAST ? df::ACCURACY_DEFAULT : df::ACCURACY_FAST;
  const double other = widest(run(changed, Detail::ALL), other_tick);
  // Joints to which nothing fits open at both levels.
  const double allowed = std::max(limit, 1.5 * other);
  if (opening <= allowed) return std::nullopt;
  return Finding{static_cast<int>(tick), opening, allowed, "opening of a joint, of its lever"};
}

bool appliesRebuild(const Trial& trial) {
  // A marked body still acts in the tick in which it is deleted, and a handler acts within a tick.
  const bool has_others =
      std::any_of(trial.scene.actions.begin(), trial.scene.actions.end(), [](const Action& action) {
        return action.present &&
               (action.when != Action::When::TICK || action.kind == Action::Kind::MARK_BODY);
      });
  return !has_others && countDynamic(trial.scene) <= 2 && trial.scene.ticks <= 100;
}

// Builds the world that a setter leaves, and compares 30 ticks. Actions that only change a state are
// repeated.
std::optional<Finding> findRebuild(const Trial& trial) {
  constexpr int kTicks = 30;
  constexpr double kNear = 1e-6, kFastNear = .02;
  constexpr std::array kRepeated = {Action::Kind::VELOCITY, Action::Kind::SPIN,    Action::Kind::POSITION,
                                    Action::Kind::ANGLE,    Action::Kind::IMPULSE, Action::Kind::FORCE};
  const SceneData& scene = trial.scene;
  int at = hasAnyAction(scene) ? scene.ticks + 1 : 10 + static_cast<int>(scene.seed % 20);
  for (const Action& action : scene.actions) {
    if (action.present) at = std::min(at, action.tick);
  }
  int end = std::min(at + kTicks, scene.ticks);
  for (const Action& action : scene.actions) {
    if (action.present && action.tick > at) end = std::min(end, action.tick - 1);
  }
  if (at < 1 || at > end) return std::nullopt;
  SceneData until = scene;
  until.ticks = at;
  SceneData rebuilt = run(until, Detail::STATES).end;
  rebuilt.ticks = end - at + 1;
  rebuilt.actions = scene.actions;
  for (Action& action : rebuilt.actions) {
    const bool is_repeated = std::find(kRepeated.begin(), kRepeated.end(), action.kind) != kRepeated.end();
    action.present = action.present && action.tick == at && is_repeated;
    action.tick = 1;
  }
  const auto before = static_cast<std::size_t>(at - 1);
  const Recording other = run(rebuilt, Detail::STATES, &trial.course.ticks[before].bodies);
  const bool is_fast = scene.level == df::ACCURACY_FAST || rebuilt.level == df::ACCURACY_FAST;
  const double limit = is_fast ? kFastNear : kNear;
  return findingOf(firstDifference(trial, other, before, static_cast<std::size_t>(rebuilt.ticks), limit),
                   limit, "moves otherwise than in a world that is built this way");
}

// True if the tiles of each row follow each other with gaps of at most 1/64 cell.
bool areRowsWhole(const SceneData& scene) {
  constexpr double kGap = 1.0 / 64 + 1e-9;
  std::map<int, Vec2> ends;  // of the last tile, by row
  const auto follows = [&](int row, Vec2 centre, Vec2 half) {
    const Vec2 lower = centre - half, upper = centre + half;
    const auto found = ends.find(row);
    const bool is_near = found == ends.end() || std::abs(lower.x - found->second.x) <= kGap ||
                         std::abs(lower.y - found->second.y) <= kGap;
    ends[row] = upper;
    return is_near;
  };
  for (const ObstacleData& its : scene.obstacles) {
    if (its.present && its.row != kNothing && !follows(its.row, its.centre, its.half)) return false;
  }
  for (const BodyData& its : scene.bodies) {
    if (its.present && its.row != kNothing && !follows(its.row, its.place, .5 * its.parts[0].size))
      return false;
  }
  return !ends.empty();
}

bool appliesTiles(const Trial& trial) {
  return areRowsWhole(trial.scene) && !hasAnyAction(trial.scene) && countDynamic(trial.scene) <= 2;
}

std::optional<Finding> findTiles(const Trial& trial) {
  constexpr double kNear = 1e-6;
  const Recording other = run(withoutSeams(trial.scene), Detail::STATES);
  return findingOf(firstDifference(trial, other, 0, 60, kNear), kNear, "moves otherwise than on one Object");
}

}  // namespace hunt

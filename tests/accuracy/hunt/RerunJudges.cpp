#include <array>
#include <cmath>
#include <map>

#include "Judges.h"

namespace hunt {
namespace {

// Returns where a body of the scene is first farther than `limit` from its place in another course; with
// limit 0, where any bit differs. Tick 0 of `other` is tick `shift` of `course`. Tiles are not compared.
Answer findDifference(const Trial& trial, const Recording& other, double limit, const char* text,
                      std::size_t ticks, std::size_t shift = 0) {
  const std::vector<Tick>& course = trial.course.ticks;
  for (std::size_t i = 0; i <= ticks && i < other.ticks.size() && i + shift < course.size(); ++i) {
    for (std::size_t body = 0; body < trial.scene.bodies.size(); ++body) {
      const BodyData& data = trial.scene.bodies[body];
      if (data.row != kNothing || data.group != 0) continue;
      const BodyState &a = course[i + shift].bodies[body], &b = other.ticks[i].bodies[body];
      const double size = length(a.place - b.place);
      if (a.present != b.present || !(size <= limit) || (limit == 0 && !(a == b)))
        return Finding{static_cast<int>(i + shift), size, limit, text + (", body " + std::to_string(body))};
    }
  }
  return {};
}

SceneData atOtherLevel(SceneData scene) {
  scene.level = scene.isFast() ? df::ACCURACY_DEFAULT : df::ACCURACY_FAST;
  return scene;
}

int countDynamic(const SceneData& scene) {
  return static_cast<int>(std::count_if(scene.bodies.begin(), scene.bodies.end(),
                                        [](const BodyData& its) { return its.isDynamic(); }));
}

Answer judgeIsolation(const Trial& trial) {
  constexpr double kNear = 1000;
  for (const Tick& tick : trial.course.ticks) {
    for (const BodyState& its : tick.bodies) {
      if (!(length(its.place) + length(its.velocity) < kNear)) return notAsked();
    }
  }
  SceneData compared = trial.scene;
  const bool has_group = std::any_of(compared.bodies.begin(), compared.bodies.end(),
                                     [](const BodyData& its) { return its.group == 1; });
  if (has_group) {  // a scene that is being made smaller
    for (JointData& its : compared.joints) its.present = its.present && compared.groupOf(its) == 0;
    for (BodyData& its : compared.bodies) its.present = its.present && its.group == 0;
    for (BodyData& its : compared.obstacles) its.present = its.present && its.group == 0;
  } else {
    addDistantGroup(compared);
  }
  const Recording other = run(compared, Detail::STATES);
  Answer answer =
      findDifference(trial, other, 0,
                     compared.later_groups_first ? "moves otherwise with an older group far away"
                                                 : "moves otherwise with a younger group far away",
                     trial.course.ticks.size());
  if (answer.finding) return answer;
  const auto eventsOf = [&](const Recording& course) {  // of bodies of group 0
    std::vector<std::array<int, 5>> events;
    for (const ContactEvent& its : course.events) {
      if (at(compared.bodies, its.receiver).group == 0)
        events.push_back({its.tick, its.begins, its.receiver, its.first, its.second});
    }
    return events;
  };
  const auto one = eventsOf(trial.course), two = eventsOf(other);
  const auto differ = std::mismatch(one.begin(), one.end(), two.begin(), two.end());
  if (differ.first == one.end() && differ.second == two.end()) return {};
  return Finding{(differ.first != one.end() ? *differ.first : *differ.second)[0], 0, 0,
                 "gets other events with a group far away"};
}

Answer judgeLevels(const Trial& trial) {
  constexpr double kFastest = 1;
  const SceneData& scene = trial.scene;
  if (hasActions(scene) || any(scene.joints, [](auto&) { return true; }) || countDynamic(scene) != 1 ||
      scene.obstacle_restitution != 0 || any(scene.bodies, [](const BodyData& its) {
        if (its.kinematic) return its.velocity != Vec2{} || its.spin != 0;
        return its.restitution != 0 || its.stiffness != 0 || its.field != kNothing ||
               length(its.velocity) > kFastest || std::abs(its.spin) > kFastest;
      }))
    return notAsked();
  const Recording other = run(atOtherLevel(scene), Detail::STATES);
  double speed = 0;
  for (std::size_t i = 0; i < std::min<std::size_t>(other.ticks.size(), 61); ++i) {
    for (std::size_t body = 0; body < scene.bodies.size(); ++body) {
      const BodyState &one = trial.course.ticks[i].bodies[body], &two = other.ticks[i].bodies[body];
      if (!scene.bodies[body].isDynamic()) continue;
      // A body that the fast level stops may lose the rest of a tick.
      speed = std::max(speed, length(one.velocity) + std::abs(one.spin));
      const double size = length(one.place - two.place), limit = .1 + speed;
      if (!(size <= limit))
        return Finding{static_cast<int>(i), size, limit, "moves otherwise at the other level"};
    }
  }
  return {};
}

Answer judgeOpening(const Trial& trial) {
  if (!isModerate(trial)) return notAsked();
  const auto widest = [](const Recording& course) {
    Finding most;
    for (std::size_t i = 0; i < course.ticks.size() && !course.ticks[i].displaced; ++i) {
      if (course.ticks[i].opening > most.value)
        most = {static_cast<int>(i), course.ticks[i].opening, 0, "opening of a joint, of its lever"};
    }
    return most;
  };
  Finding found = widest(trial.course);
  found.limit = trial.scene.isFast() ? .1 : .01;
  if (found.value <= found.limit) return {};
  // Joints to which nothing fits open at both levels.
  const double other = widest(run(atOtherLevel(trial.scene), Detail::ALL)).value;
  found.limit = std::max(found.limit, 1.5 * other);
  if (found.value <= found.limit) return {};
  return found;
}

// Builds the world that a setter leaves, and compares 30 ticks. Actions that only change a state are
// repeated.
Answer judgeRebuild(const Trial& trial) {
  // A marked body still acts in the tick in which it is deleted, and a handler acts within a tick.
  if (countDynamic(trial.scene) > 2 || trial.scene.ticks > 100 || actsOn(trial.scene, {"mark"}) ||
      any(trial.scene.actions, [](const Action& its) { return its.when != Action::When::TICK; }))
    return notAsked();
  constexpr int kTicks = 30;
  const SceneData& scene = trial.scene;
  int at = hasActions(scene) ? scene.ticks + 1 : 10 + static_cast<int>(scene.seed % 20);
  for (const Action& action : scene.actions) {
    if (action.present) at = std::min(at, action.tick);
  }
  int end = std::min(at + kTicks, scene.ticks);
  for (const Action& action : scene.actions) {
    if (action.present && action.tick > at) end = std::min(end, action.tick - 1);
  }
  if (at < 1 || at > end) return {};
  SceneData until = scene;
  until.ticks = at;
  SceneData rebuilt = run(until, Detail::STATES).end;
  rebuilt.ticks = end - at + 1;
  rebuilt.actions = scene.actions;
  for (Action& action : rebuilt.actions) {
    bool is_repeated = false;
    for (const char* p_name : {"velocity", "spin", "position", "angle", "impulse", "force"})
      is_repeated = is_repeated || action.is(p_name);
    action.present = action.present && action.tick == at && is_repeated;
    action.tick = 1;
  }
  const auto before = static_cast<std::size_t>(at - 1);
  const Recording other = run(rebuilt, Detail::STATES, &trial.course.ticks[before].bodies);
  return findDifference(trial, other, scene.isFast() || rebuilt.isFast() ? .02 : 1e-6,
                        "moves otherwise than in a world that is built this way",
                        static_cast<std::size_t>(rebuilt.ticks), before);
}

Answer judgeTiles(const Trial& trial) {
  // The tiles of each row are equal, and follow each other with gaps of at most 1/64 cell.
  constexpr double kGap = 1.0 / 64 + 1e-9;
  std::map<int, BodyData> rows;  // the last tile of each
  const auto isApart = [&](const BodyData& its) {
    if (its.row == kNothing) return false;
    const auto [at, is_first] = rows.try_emplace(its.row, its);
    const BodyData last = at->second;
    const Vec2 apart = its.place - its.half() - (last.place + last.half());
    at->second = its;
    return !is_first && ((std::abs(apart.x) > kGap && std::abs(apart.y) > kGap) ||
                         its.friction != last.friction || its.restitution != last.restitution);
  };
  if (any(trial.scene.obstacles, isApart) || any(trial.scene.bodies, isApart) || rows.empty() ||
      hasActions(trial.scene) || countDynamic(trial.scene) > 2)
    return notAsked();
  return findDifference(trial, run(withoutSeams(trial.scene), Detail::STATES), 1e-6,
                        "moves otherwise than on one Object", 60);
}

}  // namespace

std::vector<Judge> rerunJudges() {
  return {{"opening", judgeOpening},
          {"isolation", judgeIsolation, 40},
          {"levels", judgeLevels},
          {"rebuild", judgeRebuild},
          {"tiles", judgeTiles}};
}

}  // namespace hunt

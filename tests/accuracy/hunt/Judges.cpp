#include "Judges.h"

#include <cmath>
#include <map>

namespace hunt {

namespace {

using Kind = JointData::Kind;
using std::abs, std::max, std::min;

constexpr int kWindow = 30;

// True if anything is moved by the game: by motors, as kinematic bodies, or by a spin that nothing can
// change.
bool hasDriver(const SceneData& scene) {
  const bool is_pushed = actsOn(scene, {"velocity", "spin", "impulse"});
  return any(scene.joints, [](const JointData& its) { return its.kind == Kind::MOTOR; }) ||
         any(scene.bodies, [&](const BodyData& its) {
           const bool moves = is_pushed || its.spin != 0 || (its.kinematic && its.velocity != Vec2{});
           return (its.kinematic || !its.turning) && moves;
         });
}

// The greatest values in some ticks.
struct Greatest {
  void add(const Tick& tick) {
    kinetic = max(kinetic, tick.sums.kinetic);
    pull = max(pull, tick.sums.pull);
    shift = max(shift, tick.shift);
    size = max(size, abs(tick.sums.energy()));
  }
  // A displacement that removes an overlap or an opening is not work.
  double allowance(double part, const Tick& tick) const {
    return part * kinetic + pull * (shift + 1e-8) + tick.sums.rest;
  }

  double kinetic = 0, pull = 0, shift = 0, size = 0;
};

Answer judgeGain(const Trial& trial) {
  if (hasDriver(trial.scene)) return notAsked();
  const std::vector<Tick>& ticks = trial.course.ticks;
  std::size_t begin = 0;
  for (std::size_t i = 0; i < ticks.size() && !ticks[i].displaced; ++i) {
    if (ticks[i].acted) begin = i + 1;
    const std::size_t from = max(begin, i < kWindow ? 0 : i - kWindow);
    if (from >= i) continue;
    Greatest greatest;
    // The energy without what a stiff spring seems to store: its stretch is an error, like a joint's opening.
    // What it released counts.
    double least = ticks[i].sums.energy(), least_known = 1e300, known = 0, stored = 1e300;
    for (std::size_t j = from; j <= i; ++j) {
      const Sums& sums = ticks[j].sums;
      greatest.add(ticks[j]);
      stored = min(stored, sums.stiff);
      known = sums.kinetic + sums.potential + stored;
      least = min(least, sums.energy());
      least_known = min(least_known, known);
    }
    const double gain = min(ticks[i].sums.energy() - least, known - least_known);
    const double allowed =
        greatest.allowance(trial.scene.isFast() ? 1e-2 : 1e-3, ticks[i]) + 1e-11 * greatest.size;
    if (!(gain <= allowed)) return Finding{static_cast<int>(i), gain, allowed, "energy gained in 30 ticks"};
  }
  return {};
}

Answer judgeLoss(const Trial& trial) {
  const SceneData& scene = trial.scene;
  if (scene.isFast() || hasDriver(scene) || hasActions(scene)) return notAsked();
  const bool dissipates = any(scene.bodies, [](const BodyData& its) {
    return !its.kinematic && (its.restitution != 1 || its.friction != 0 || its.damping != 0 ||
                              its.linear_drag != 0 || its.quadratic_drag != 0);
  });
  const bool gives_way = any(scene.joints, [](const JointData& its) {
    const bool may_dissipate = its.kind == Kind::SPRING ? its.second != 0 : its.kind == Kind::ROPE;
    return may_dissipate || its.kind > Kind::SPRING || its.break_force != 0;
  });
  if (dissipates || gives_way ||
      std::any_of(trial.course.ticks.begin(), trial.course.ticks.end(),
                  [](const Tick& tick) { return tick.sums.stiff != 0; }))
    return notAsked();
  const std::vector<Tick>& ticks = trial.course.ticks;
  Greatest greatest;
  for (const Tick& tick : ticks) greatest.add(tick);
  // In the first tick, joints take away the velocities that do not fit them.
  const std::size_t first = trial.scene.joints.empty() ? 0 : 1;
  for (std::size_t i = first + 1; i < ticks.size() && !ticks[i].displaced; ++i) {
    const double change = ticks[i].sums.energy() - ticks[first].sums.energy();
    const double allowed = greatest.allowance(.01, ticks[i]);
    if (!(abs(change) <= allowed))
      return Finding{static_cast<int>(i), change, allowed, "energy changed though nothing dissipates"};
  }
  return {};
}

bool hasOutside(const SceneData& scene) {
  return any(scene.obstacles, [](const BodyData& its) { return its.solidness == df::HARD; }) ||
         any(scene.bodies,
             [](const BodyData& its) {
               return its.kinematic || its.stiffness != 0 || its.damping != 0 || its.field != kNothing ||
                      its.linear_drag != 0 || its.quadratic_drag != 0;
             }) ||
         any(scene.joints, [](const JointData& its) { return min(its.a, its.b) == kNothing; }) ||
         actsOn(scene, {"kinematic", "drag", "spring", "change obstacle"});
}

Answer judgeMomentum(const Trial& trial, bool falls) {
  if (hasOutside(trial.scene) || falls != (trial.scene.gravity != Vec2{}) ||
      (!falls && actsOn(trial.scene, {"gravity"})))
    return notAsked();
  constexpr double kPart = 1e-9;
  const std::vector<Tick>& ticks = trial.course.ticks;
  // Angular momentum is kept if everything turns, and no joint breaks while it is open.
  const bool turns =
      !any(trial.scene.joints, [](const JointData& its) { return its.break_force > 0; }) &&
      !any(trial.scene.bodies, [](const BodyData& its) { return !its.turning || its.gravity_scale != 1; }) &&
      !actsOn(trial.scene, {"turning", "gravity scale"});
  std::size_t begin = 0;
  double scale = 0, angular_scale = 0, shift = 0;
  for (std::size_t i = 0; i < ticks.size() && !ticks[i].displaced; ++i) {
    const Sums &now = ticks[i].sums, &then = ticks[begin].sums;
    if (ticks[i].acted || i <= begin) {
      begin = ticks[i].acted ? i + 1 : i;
      scale = angular_scale = shift = 0;
    }
    scale = max(scale, now.momentum_scale);
    angular_scale = max(angular_scale, now.angular_scale);
    shift += ticks[i].shift;
    if (i <= begin) continue;
    const double time = static_cast<double>(i - begin);
    const double error = length(now.momentum - then.momentum - time * then.force);
    const double allowed = kPart * (scale + time * length(then.force)) + 1e-14;
    if (!(error <= allowed)) return Finding{static_cast<int>(i), error, allowed, "momentum changed"};
    const double turned = abs(now.angular - then.angular);
    // A displacement that removes an overlap or an opening moves momentum along a lever.
    const double allowed_turn = kPart * angular_scale + shift * scale + 1e-14;
    if (turns && !(turned <= allowed_turn))
      return Finding{static_cast<int>(i), turned, allowed_turn, "angular momentum changed"};
  }
  return {};
}

Answer judgeOverlap(const Trial& trial) {
  // A body that a driver presses against a wall has no place to go.
  if (!isModerate(trial) || hasDriver(trial.scene)) return notAsked();
  const double limit = trial.scene.isFast() ? .5 : .1;
  for (std::size_t i = 0; i < trial.course.ticks.size(); ++i) {
    const Tick& tick = trial.course.ticks[i];
    if (tick.displaced) break;
    if (tick.depth > limit)
      return Finding{static_cast<int>(i), tick.depth, limit, "overlap, of the half width"};
  }
  return {};
}

Answer judgeThrough(const Trial& trial) {
  // Kinematic bodies must move only as the boundaries do: others may press bodies through walls.
  const SceneData& scene = trial.scene;
  const bool is_pressed = any(scene.bodies, [&](const BodyData& its) {
    if (!its.kinematic) return !its.turning && its.spin != 0;
    if (its.velocity == Vec2{} && its.spin == 0) return false;
    return std::none_of(scene.boundaries.begin(), scene.boundaries.end(),
                        [&](const Boundary& boundary) { return boundary.velocity == its.velocity; });
  });
  if (scene.boundaries.empty() || is_pressed ||
      actsOn(scene, {"delete obstacle", "move obstacle", "change obstacle", "solidness", "position",
                     "kinematic", "mark", "delete", "velocity", "angle", "circle", "box"}))
    return notAsked();
  // Position of a centre relative to a wall: on either side, inside, or not level with it.
  enum class Side { LOW, HIGH, INSIDE, AWAY };
  for (const Boundary& boundary : trial.scene.boundaries) {
    const bool is_x = boundary.kind == Boundary::Kind::WALL_X;
    for (std::size_t body = 0; body < trial.scene.bodies.size(); ++body) {
      const BodyData& data = trial.scene.bodies[body];
      if (!data.isDynamic() || data.solidness != df::HARD) continue;
      Side last = Side::AWAY;
      for (std::size_t i = 0; i < trial.course.ticks.size(); ++i) {
        const BodyState& state = trial.course.ticks[i].bodies[body];
        if (!state.present) break;
        const Vec2 moved = static_cast<double>(i) * boundary.velocity;
        const Vec2 lower = boundary.lower + moved, upper = boundary.upper + moved, place = state.place;
        const double margin = 2 + 2 * length(state.velocity);
        const double across = is_x ? place.x : place.y, along = is_x ? place.y : place.x;
        Side side = across <= (is_x ? lower.x : lower.y)   ? Side::LOW
                    : across >= (is_x ? upper.x : upper.y) ? Side::HIGH
                                                           : Side::INSIDE;
        if (along < (is_x ? lower.y : lower.x) + margin || along > (is_x ? upper.y : upper.x) - margin)
          side = Side::AWAY;
        const bool left_room =
            place.x < lower.x || place.y < lower.y || place.x > upper.x || place.y > upper.y;
        const bool crossed =
            (last == Side::LOW && side == Side::HIGH) || (last == Side::HIGH && side == Side::LOW);
        if (boundary.kind == Boundary::Kind::ROOM ? left_room : crossed)
          return Finding{static_cast<int>(i), place.x, place.y,
                         "body " + std::to_string(body) + " is beyond a wall, at (value, limit)"};
        if (side != Side::INSIDE) last = side;
      }
    }
  }
  return {};
}

Answer judgeRest(const Trial& trial) {
  if (trial.scene.ticks < 1000 || hasActions(trial.scene)) return notAsked();
  const std::vector<Tick>& ticks = trial.course.ticks;
  const double limit = trial.scene.sleeping ? 0 : 1e-3;  // asleep is exactly still
  for (std::size_t i = ticks.size() - min<std::size_t>(ticks.size(), kWindow); i < ticks.size(); ++i) {
    for (std::size_t body = 0; body < ticks[i].bodies.size(); ++body) {
      const double speed = length(ticks[i].bodies[body].velocity);
      if (trial.scene.bodies[body].isDynamic() && !(speed <= limit))
        return Finding{static_cast<int>(i), speed, limit, "body " + std::to_string(body) + " still moves"};
    }
  }
  return {};
}

Answer judgeEvents(const Trial& trial) {
  constexpr int kLateTicks = 6;
  constexpr double kGap = .05;
  const auto finding = [](int tick, double value, double limit, const char* what, int receiver, int other) {
    return Finding{tick, value, limit,
                   std::string(what) + ", for body " + std::to_string(receiver) + " and " +
                       (other >= 0 ? "body " + std::to_string(other)
                                   : "obstacle " + std::to_string(obstacleNumber(other)))};
  };
  std::map<std::pair<int, int>, bool> open;
  for (const ContactEvent& event : trial.course.events) {
    bool& is_open = open[{event.receiver, event.other()}];
    const char* p_wrong = nullptr;
    if (event.begins && is_open && at(trial.scene.bodies, event.receiver).contact_ends)
      p_wrong = "a second begin event";
    if (!event.begins && !is_open) p_wrong = "an end event without a begin";
    if (event.begins && event.gap > kGap) p_wrong = "a begin event of bodies that did not touch";
    if (p_wrong != nullptr)
      return finding(event.tick, event.gap, kGap, p_wrong, event.receiver, event.other());
    is_open = event.begins;
  }
  std::map<std::pair<int, int>, int> apart;
  for (std::size_t i = 0; i < trial.course.ticks.size(); ++i) {
    for (const OpenContact& contact : trial.course.ticks[i].open) {
      int& count = apart[{contact.receiver, contact.other}];
      count = contact.apart ? count + 1 : 0;
      if (count > kLateTicks)
        return finding(static_cast<int>(i), count, kLateTicks, "the end event is missing", contact.receiver,
                       contact.other);
    }
  }
  return {};
}

Answer judgeFinite(const Trial& trial) {
  if (trial.course.frozen > 0)
    return Finding{trial.scene.ticks, static_cast<double>(trial.course.frozen), 0, "bodies were frozen"};
  for (std::size_t i = 0; i < trial.course.ticks.size(); ++i) {
    for (const BodyState& its : trial.course.ticks[i].bodies) {
      const double sum = its.place.x + its.place.y + its.velocity.x + its.velocity.y + its.angle + its.spin;
      if (!std::isfinite(sum)) return Finding{static_cast<int>(i), sum, 0, "a state is not finite"};
    }
  }
  return {};
}

Answer judgeSpeed(const Trial& trial) {
  // A faster body that hits something thin may well spin faster than the limit.
  if (any(trial.scene.bodies, [](const BodyData& its) { return length(its.velocity) > 1e4; }))
    return notAsked();
  if (trial.course.limited == 0) return {};
  return Finding{trial.scene.ticks, static_cast<double>(trial.course.limited), 0,
                 "numbers were reduced to their limits"};
}

}  // namespace

double massRatio(const SceneData& scene) {
  double least = 1e300, most = 0;
  for (const BodyData& body : scene.bodies) {
    if (!body.isDynamic()) continue;
    least = min(least, body.mass);
    most = max(most, body.mass);
  }
  return most > 0 ? most / least : 1;
}

bool actsOn(const SceneData& scene, std::initializer_list<const char*> names) {
  return std::any_of(names.begin(), names.end(), [&](const char* p_name) {
    const Setter& setter = setterNamed(p_name);
    return any(scene.actions, [&](const Action& its) { return its.p_setter == &setter; });
  });
}

bool hasActions(const SceneData& scene) {
  return any(scene.actions, [](const Action&) { return true; });
}

bool isModerate(const Trial& trial) {
  constexpr double kMost = 1e4;
  const SceneData& scene = trial.scene;
  return massRatio(scene) <= kMost && !actsOn(scene, {"mass", "spring"}) &&
         !any(scene.bodies, [](const BodyData& its) { return its.stiffness > kMost; }) &&
         !any(scene.joints,
              [](const JointData& its) { return its.kind == Kind::SPRING && !(its.first <= kMost); }) &&
         std::all_of(scene.fields.begin(), scene.fields.end(),
                     [](const FieldData& its) { return its.strength * its.steepness <= kMost; });
}

const std::vector<Judge>& judges() {
  static const std::vector<Judge> kJudges = [] {
    std::vector<Judge> all = {{"gain", judgeGain},
                              {"loss", judgeLoss},
                              {"momentum", [](const Trial& trial) { return judgeMomentum(trial, false); }},
                              {"fall", [](const Trial& trial) { return judgeMomentum(trial, true); }},
                              {"overlap", judgeOverlap},
                              {"through", judgeThrough},
                              {"rest", judgeRest},
                              {"events", judgeEvents},
                              {"finite", judgeFinite},
                              {"speed", judgeSpeed}};
    for (const Judge& judge : rerunJudges()) all.push_back(judge);
    return all;
  }();
  return kJudges;
}

const Judge* judgeNamed(const std::string& name) {
  for (const Judge& judge : judges()) {
    if (judge.name == name) return &judge;
  }
  return nullptr;
}

std::vector<std::pair<const Judge*, Answer>> judgeScene(const SceneData& scene, const Judge* p_only) {
  const Recording course = run(scene, Detail::ALL);
  const auto percentile = scene.seed * 0x9e3779b97f4a7c15u / (1ull << 32) % 100;
  std::vector<std::pair<const Judge*, Answer>> answers;
  for (const Judge& judge : judges()) {
    const bool is_asked = percentile < static_cast<std::uint64_t>(judge.share);
    if (p_only == nullptr || p_only == &judge)
      answers.emplace_back(&judge, is_asked || p_only != nullptr ? judge.ask({scene, course}) : notAsked());
  }
  return answers;
}

}  // namespace hunt

#include "Judges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <utility>

#include "RerunJudges.h"

namespace hunt {

namespace {

using Kind = JointData::Kind;

constexpr int kWindow = 30;
constexpr double kLoss = .01;
constexpr double kMomentum = 1e-9;

bool isFast(const SceneData& scene) {
  return scene.level == df::ACCURACY_FAST;
}

bool always(const Trial& /*trial*/) {
  return true;
}

double massRatio(const SceneData& scene) {
  double least = 1e300, most = 0;
  for (const BodyData& body : scene.bodies) {
    if (!body.isDynamic()) continue;
    least = std::min(least, body.mass);
    most = std::max(most, body.mass);
  }
  return most > 0 ? most / least : 1;
}

bool actsOn(const SceneData& scene, std::initializer_list<Action::Kind> kinds) {
  return std::any_of(scene.actions.begin(), scene.actions.end(), [&](const Action& action) {
    return action.present && std::find(kinds.begin(), kinds.end(), action.kind) != kinds.end();
  });
}

bool hasActions(const SceneData& scene) {
  return std::any_of(scene.actions.begin(), scene.actions.end(), [](auto& its) { return its.present; });
}

// True if masses differ by at most 10⁴, and springs and fields do not pull as if they were heavier.
bool isModerate(const Trial& trial) {
  constexpr double kMost = 1e4;
  const SceneData& scene = trial.scene;
  if (massRatio(scene) > kMost || actsOn(scene, {Action::Kind::MASS, Action::Kind::SPRING})) return false;
  for (const BodyData& body : scene.bodies) {
    if (body.present && body.stiffness > kMost) return false;
  }
  for (const FieldData& field : scene.fields) {
    if (field.strength * field.steepness > kMost) return false;
  }
  return std::all_of(scene.joints.begin(), scene.joints.end(), [](const JointData& joint) {
    return !joint.present || joint.kind != Kind::SPRING || joint.first <= kMost;
  });
}

// True if anything is moved by the game: by motors, as kinematic bodies, or by a spin that nothing can
// change.
bool hasDriver(const SceneData& scene) {
  for (const JointData& joint : scene.joints) {
    if (joint.present && joint.kind == Kind::MOTOR) return true;
  }
  const bool is_pushed = actsOn(scene, {Action::Kind::VELOCITY, Action::Kind::SPIN, Action::Kind::IMPULSE});
  return std::any_of(scene.bodies.begin(), scene.bodies.end(), [&](const BodyData& body) {
    const bool moves = is_pushed || body.spin != 0 || (body.kinematic && body.velocity != Vec2{});
    return body.present && (body.kinematic || !body.turning) && moves;
  });
}

bool appliesGain(const Trial& trial) {
  return !hasDriver(trial.scene);
}

// A body that a driver presses against a wall has no place to go.
bool appliesOverlap(const Trial& trial) {
  return isModerate(trial) && !hasDriver(trial.scene);
}

// Returns the gains in the ticks `from` to `to`: of the whole energy, and of the energy without what a stiff
// spring seems to store: its stretch is an error, like a joint's opening. What it released counts.
std::pair<double, double> gainsIn(const std::vector<Tick>& ticks, std::size_t from, std::size_t to) {
  double least = ticks[to].sums.energy(), least_known = 1e300, known = 0, stored = 1e300;
  for (std::size_t i = from; i <= to; ++i) {
    const Sums& sums = ticks[i].sums;
    stored = std::min(stored, sums.stiff);
    known = sums.kinetic + sums.potential + stored;
    least = std::min(least, sums.energy());
    least_known = std::min(least_known, known);
  }
  return {ticks[to].sums.energy() - least, known - least_known};
}

std::optional<Finding> findGain(const Trial& trial) {
  const std::vector<Tick>& ticks = trial.course.ticks;
  const double part = isFast(trial.scene) ? 1e-2 : 1e-3;
  std::size_t begin = 0;
  for (std::size_t i = 0; i < ticks.size() && !ticks[i].displaced; ++i) {
    if (ticks[i].acted) begin = i + 1;
    const std::size_t from = std::max(begin, i < kWindow ? 0 : i - kWindow);
    if (from >= i) continue;
    double kinetic = 0, pull = 0, shift = 0, size = 0;
    for (std::size_t j = from; j <= i; ++j) {
      kinetic = std::max(kinetic, ticks[j].sums.kinetic);
      pull = std::max(pull, ticks[j].sums.pull);
      shift = std::max(shift, ticks[j].shift);
      size = std::max(size, std::abs(ticks[j].sums.energy()));
    }
    // A displacement that removes an overlap or an opening is not work.
    const double allowed = part * kinetic + pull * (shift + 1e-8) + 1e-11 * size + ticks[i].sums.rest;
    const auto [gain, known_gain] = gainsIn(ticks, from, i);
    if (!(std::min(gain, known_gain) <= allowed))
      return Finding{static_cast<int>(i), std::min(gain, known_gain), allowed, "energy gained in 30 ticks"};
  }
  return std::nullopt;
}

bool conservesEnergy(const BodyData& body) {
  return body.restitution == 1 && body.friction == 0 && body.damping == 0 && body.linear_drag == 0 &&
         body.quadratic_drag == 0;
}

bool appliesLoss(const Trial& trial) {
  const SceneData& scene = trial.scene;
  if (isFast(scene) || hasDriver(scene) || hasActions(scene)) return false;
  for (const BodyData& body : scene.bodies) {
    if (body.isDynamic() && !conservesEnergy(body)) return false;
  }
  return std::all_of(scene.joints.begin(), scene.joints.end(),
                     [](const JointData& joint) {
                       const bool is_rigid = joint.kind == Kind::DISTANCE || joint.kind == Kind::HINGE ||
                                             joint.kind == Kind::WELD || joint.kind == Kind::SLIDER;
                       const bool is_spring = joint.kind == Kind::SPRING && joint.second == 0;
                       return !joint.present || ((is_rigid || is_spring) && joint.break_force == 0);
                     }) &&
         std::all_of(trial.course.ticks.begin(), trial.course.ticks.end(),
                     [](const Tick& tick) { return tick.sums.stiff == 0; });
}

std::optional<Finding> findLoss(const Trial& trial) {
  const std::vector<Tick>& ticks = trial.course.ticks;
  double kinetic = 0, pull = 0, shift = 0;
  for (const Tick& tick : ticks) {
    kinetic = std::max(kinetic, tick.sums.kinetic);
    pull = std::max(pull, tick.sums.pull);
    shift = std::max(shift, tick.shift);
  }
  // In the first tick, joints take away the velocities that do not fit them.
  const std::size_t first = trial.scene.joints.empty() ? 0 : 1;
  for (std::size_t i = first + 1; i < ticks.size() && !ticks[i].displaced; ++i) {
    const double change = ticks[i].sums.energy() - ticks[first].sums.energy();
    const double allowed = kLoss * kinetic + pull * (shift + 1e-8) + ticks[i].sums.rest;
    if (!(std::abs(change) <= allowed))
      return Finding{static_cast<int>(i), change, allowed, "energy changed though nothing dissipates"};
  }
  return std::nullopt;
}

bool hasOutside(const SceneData& scene) {
  for (const ObstacleData& obstacle : scene.obstacles) {
    if (obstacle.present && obstacle.solidness == df::HARD) return true;
  }
  for (const BodyData& body : scene.bodies) {
    if (!body.present) continue;
    if (body.kinematic || body.stiffness != 0 || body.damping != 0 || body.field != kNothing ||
        body.linear_drag != 0 || body.quadratic_drag != 0)
      return true;
  }
  for (const JointData& joint : scene.joints) {
    if (joint.present && (joint.a == kNothing || joint.b == kNothing)) return true;
  }
  return actsOn(scene, {Action::Kind::KINEMATIC, Action::Kind::DRAG, Action::Kind::SPRING,
                        Action::Kind::OBSTACLE_SOLIDNESS});
}

bool appliesMomentum(const Trial& trial) {
  return !hasOutside(trial.scene) && trial.scene.gravity == Vec2{} &&
         !actsOn(trial.scene, {Action::Kind::GRAVITY});
}

bool appliesFall(const Trial& trial) {
  return !hasOutside(trial.scene) && trial.scene.gravity != Vec2{};
}

// True if angular momentum is kept: everything turns, and no joint breaks while it is open.
bool allTurn(const SceneData& scene) {
  for (const JointData& joint : scene.joints) {
    if (joint.present && joint.break_force > 0) return false;
  }
  return std::all_of(scene.bodies.begin(), scene.bodies.end(),
                     [&](const BodyData& body) {
                       return !body.present || (body.turning && body.gravity_scale == 1);
                     }) &&
         !actsOn(scene, {Action::Kind::TURNING, Action::Kind::GRAVITY_SCALE});
}

std::optional<Finding> findMomentum(const Trial& trial) {
  const std::vector<Tick>& ticks = trial.course.ticks;
  const bool turns = allTurn(trial.scene);
  std::size_t begin = 0;
  double scale = 0, angular_scale = 0, shift = 0;
  for (std::size_t i = 0; i < ticks.size() && !ticks[i].displaced; ++i) {
    const Sums &now = ticks[i].sums, &then = ticks[begin].sums;
    if (ticks[i].acted || i <= begin) {
      begin = ticks[i].acted ? i + 1 : i;
      scale = angular_scale = shift = 0;
    }
    scale = std::max(scale, now.momentum_scale);
    angular_scale = std::max(angular_scale, now.angular_scale);
    shift += ticks[i].shift;
    if (i <= begin) continue;
    const double time = static_cast<double>(i - begin);
    const double error = length(now.momentum - then.momentum - time * then.force);
    const double allowed = kMomentum * (scale + time * length(then.force)) + 1e-14;
    if (!(error <= allowed)) return Finding{static_cast<int>(i), error, allowed, "momentum changed"};
    const double turned = std::abs(now.angular - then.angular);
    // A displacement that removes an overlap or an opening moves momentum along a lever.
    const double allowed_turn = kMomentum * angular_scale + shift * scale + 1e-14;
    if (turns && !(turned <= allowed_turn))
      return Finding{static_cast<int>(i), turned, allowed_turn, "angular momentum changed"};
  }
  return std::nullopt;
}

std::optional<Finding> findOverlap(const Trial& trial) {
  const double limit = isFast(trial.scene) ? .5 : .1;
  for (std::size_t i = 0; i < trial.course.ticks.size(); ++i) {
    const Tick& tick = trial.course.ticks[i];
    if (tick.displaced) break;
    if (tick.depth > limit)
      return Finding{static_cast<int>(i), tick.depth, limit, "overlap, of the half width"};
  }
  return std::nullopt;
}

// Position of a centre relative to a wall: on either side, inside, or not level with it.
enum class Side { LOW, HIGH, INSIDE, AWAY };

Side sideOf(const Boundary& boundary, double time, Vec2 place, double margin) {
  const Vec2 lower = boundary.lower + time * boundary.velocity,
             upper = boundary.upper + time * boundary.velocity;
  const bool is_x = boundary.kind == Boundary::Kind::WALL_X;
  const double across = is_x ? place.x : place.y, along = is_x ? place.y : place.x;
  if (along < (is_x ? lower.y : lower.x) + margin || along > (is_x ? upper.y : upper.x) - margin)
    return Side::AWAY;
  if (across <= (is_x ? lower.x : lower.y)) return Side::LOW;
  return across >= (is_x ? upper.x : upper.y) ? Side::HIGH : Side::INSIDE;
}

// True if kinematic bodies move only as the boundaries do: others may press bodies through walls.
bool movesWithBoundaries(const SceneData& scene) {
  return std::all_of(scene.bodies.begin(), scene.bodies.end(), [&](const BodyData& body) {
    const bool is_still =
        body.kinematic ? body.velocity == Vec2{} && body.spin == 0 : body.turning || body.spin == 0;
    return !body.present || is_still ||
           (body.kinematic &&
            std::any_of(scene.boundaries.begin(), scene.boundaries.end(),
                        [&](const Boundary& its) { return its.velocity == body.velocity; }));
  });
}

bool appliesThrough(const Trial& trial) {
  return !trial.scene.boundaries.empty() && movesWithBoundaries(trial.scene) &&
         !actsOn(trial.scene,
                 {Action::Kind::DELETE_OBSTACLE, Action::Kind::MOVE_OBSTACLE,
                  Action::Kind::OBSTACLE_SOLIDNESS, Action::Kind::SOLIDNESS, Action::Kind::POSITION,
                  Action::Kind::KINEMATIC, Action::Kind::MARK_BODY, Action::Kind::DELETE_BODY,
                  Action::Kind::VELOCITY, Action::Kind::ANGLE, Action::Kind::CIRCLE, Action::Kind::BOX});
}

std::optional<Finding> findThrough(const Trial& trial) {
  const std::vector<Tick>& ticks = trial.course.ticks;
  for (const Boundary& boundary : trial.scene.boundaries) {
    for (std::size_t body = 0; body < trial.scene.bodies.size(); ++body) {
      const BodyData& data = trial.scene.bodies[body];
      if (!data.isDynamic() || data.solidness != df::HARD) continue;
      Side last = Side::AWAY;
      for (std::size_t i = 0; i < ticks.size(); ++i) {
        const BodyState& state = ticks[i].bodies[body];
        if (!state.present) break;
        const double time = static_cast<double>(i);
        const Finding finding{static_cast<int>(i), state.place.x, state.place.y,
                              "body " + std::to_string(body) + " is beyond a wall, at (value, limit)"};
        if (boundary.kind == Boundary::Kind::ROOM) {
          const Vec2 place = state.place - time * boundary.velocity;
          const Vec2 low = boundary.lower, high = boundary.upper;
          if (place.x < low.x || place.y < low.y || place.x > high.x || place.y > high.y) return finding;
          continue;
        }
        const double margin = 2 + 2 * length(state.velocity);
        const Side side = sideOf(boundary, time, state.place, margin);
        const bool crossed =
            (last == Side::LOW && side == Side::HIGH) || (last == Side::HIGH && side == Side::LOW);
        if (crossed) return finding;
        if (side != Side::INSIDE) last = side;
      }
    }
  }
  return std::nullopt;
}

bool appliesRest(const Trial& trial) {
  return trial.scene.ticks >= 1000 && !hasActions(trial.scene);
}

std::optional<Finding> findRest(const Trial& trial) {
  constexpr double kStill = 1e-3;
  const std::vector<Tick>& ticks = trial.course.ticks;
  const double limit = trial.scene.sleeping ? 0 : kStill;  // asleep is exactly still
  for (std::size_t i = ticks.size() - std::min<std::size_t>(ticks.size(), kWindow); i < ticks.size(); ++i) {
    for (std::size_t body = 0; body < ticks[i].bodies.size(); ++body) {
      const double speed = length(ticks[i].bodies[body].velocity);
      if (trial.scene.bodies[body].isDynamic() && !(speed <= limit))
        return Finding{static_cast<int>(i), speed, limit, "body " + std::to_string(body) + " still moves"};
    }
  }
  return std::nullopt;
}

std::string pairText(const char* what, int receiver, int other) {
  return std::string(what) + ", for body " + std::to_string(receiver) + " and " +
         (other >= 0 ? "body " + std::to_string(other) : "obstacle " + std::to_string(obstacleNumber(other)));
}

std::optional<Finding> findEvents(const Trial& trial) {
  constexpr int kLateTicks = 6;
  constexpr double kGap = .05;
  std::map<std::pair<int, int>, bool> open;
  const auto hasEnds = [&](int body) {
    return trial.scene.bodies[static_cast<std::size_t>(body)].contact_ends;
  };
  for (const ContactEvent& event : trial.course.events) {
    bool& is_open = open[{event.receiver, event.other()}];
    const char* p_wrong = nullptr;
    if (hasEnds(event.receiver) && event.begins && is_open) p_wrong = "a second begin event";
    if (!event.begins && !is_open) p_wrong = "an end event without a begin";
    if (event.begins && event.gap > kGap) p_wrong = "a begin event of bodies that did not touch";
    if (p_wrong != nullptr)
      return Finding{event.tick, event.gap, kGap, pairText(p_wrong, event.receiver, event.other())};
    is_open = event.begins;
  }
  std::map<std::pair<int, int>, int> apart;
  for (std::size_t i = 0; i < trial.course.ticks.size(); ++i) {
    for (const OpenContact& contact : trial.course.ticks[i].open) {
      int& count = apart[{contact.receiver, contact.other}];
      count = contact.apart ? count + 1 : 0;
      if (count > kLateTicks)
        return Finding{static_cast<int>(i), static_cast<double>(count), kLateTicks,
                       pairText("the end event is missing", contact.receiver, contact.other)};
    }
  }
  return std::nullopt;
}

std::optional<Finding> findFinite(const Trial& trial) {
  if (trial.course.frozen > 0)
    return Finding{trial.scene.ticks, static_cast<double>(trial.course.frozen), 0, "bodies were frozen"};
  for (std::size_t i = 0; i < trial.course.ticks.size(); ++i) {
    for (const BodyState& state : trial.course.ticks[i].bodies) {
      const double sum =
          state.place.x + state.place.y + state.velocity.x + state.velocity.y + state.angle + state.spin;
      if (!std::isfinite(sum)) return Finding{static_cast<int>(i), sum, 0, "a state is not finite"};
    }
  }
  return std::nullopt;
}

// A faster body that hits something thin may well spin faster than the limit.
bool appliesSpeed(const Trial& trial) {
  constexpr double kFast = 1e4;
  return std::all_of(trial.scene.bodies.begin(), trial.scene.bodies.end(),
                     [](const BodyData& body) { return length(body.velocity) <= kFast; });
}

std::optional<Finding> findSpeed(const Trial& trial) {
  if (trial.course.limited == 0) return std::nullopt;
  return Finding{trial.scene.ticks, static_cast<double>(trial.course.limited), 0,
                 "numbers were reduced to their limits"};
}

constexpr std::array kJudges = {
    Judge{"gain",
          "no group without drivers gains energy: over 30 ticks at most 1e-3 (fast 1e-2) of its "
          "greatest kinetic energy",
          appliesGain, findGain, 100},
    Judge{"loss", "a group in which nothing dissipates keeps its energy to 1 %, at the default level",
          appliesLoss, findLoss, 100},
    Judge{"momentum", "momentum and angular momentum are kept to 1e-9 where nothing outside acts",
          appliesMomentum, findMomentum, 100},
    Judge{"fall", "a group that nothing but gravity acts on falls at g", appliesFall, findMomentum, 100},
    Judge{"overlap", "overlaps stay below a tenth (fast: half) of the half width", appliesOverlap,
          findOverlap, 100},
    Judge{"opening",
          "joints open by at most 1 % (fast 10 %) of their lever, or 1.5 times as far as at the other level",
          isModerate, findOpening, 100},
    Judge{"through", "no centre passes a wall", appliesThrough, findThrough, 100},
    Judge{"rest", "planks in a tray sleep after 1,000 ticks, or, where nothing may, move by less than .001",
          appliesRest, findRest, 100},
    Judge{"events", "begin and end events alternate, and pairs touch", always, findEvents, 100},
    Judge{"finite", "nothing is frozen or NaN", always, findFinite, 100},
    Judge{"speed", "no speed, spin or place is reduced to its limit", appliesSpeed, findSpeed, 100},
    Judge{"isolation", "a group gives equal bits alone and with a distant group, whichever was made first",
          appliesIsolation, findIsolation, 40},
    Judge{"levels",
          "one body without restitution: both levels agree to .1 cell and a tick's way for 60 ticks",
          appliesLevels, findLevels, 100},
    Judge{"rebuild", "a world whose setters were called equals one that was built that way, for 30 ticks",
          appliesRebuild, findRebuild, 100},
    Judge{"tiles", "bodies on tiles move as on one Object", appliesTiles, findTiles, 100}};

}  // namespace

std::span<const Judge> judges() {
  return kJudges;
}

const Judge* judgeNamed(const std::string& name) {
  const auto found =
      std::find_if(kJudges.begin(), kJudges.end(), [&](auto& its) { return its.name == name; });
  return found == kJudges.end() ? nullptr : &*found;
}

std::vector<Verdict> judgeScene(const SceneData& scene, const Judge* p_only) {
  const Recording course = run(scene, Detail::ALL);
  const Trial trial{scene, course};
  std::vector<Verdict> verdicts;
  for (const Judge& judge : kJudges) {
    if (p_only != nullptr && p_only != &judge) continue;
    Verdict verdict{&judge, judge.applies(trial), std::nullopt};
    const bool is_asked = p_only != nullptr || scene.seed * 0x9e3779b97f4a7c15u / (1ull << 32) % 100 <
                                                   static_cast<std::uint64_t>(judge.share);
    verdict.applied = verdict.applied && is_asked;
    if (verdict.applied) verdict.finding = judge.find(trial);
    verdicts.push_back(std::move(verdict));
  }
  return verdicts;
}

}  // namespace hunt

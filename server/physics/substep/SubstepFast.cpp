// Bodies of a SubstepWorld that move farther in a step than contacts were searched for: they stop at their
// first contact, or move with the body that they met.
#include <algorithm>
#include <cmath>
#include <utility>

#include "physics/substep/SubstepWorld.h"

namespace naiad::physics {

namespace {

constexpr double kMaxTurn = 40;  // rad per step: maximum swept rotation; limits timeOfImpact()'s iterations
// Lengths in units of the body's thickness:
constexpr double kMaxPass = 0.5;  // limit of movement beyond the search, so the centre passes nothing
constexpr double kCore = 0.5;     // radius of the core that is swept if the other body pushes this one

constexpr std::size_t kFewFast = 4;  // the fast bodies are many if at least one body in this number is fast
constexpr double kNever = 2;         // a time after the step

// Returns a bound of how far rotation moves a point of the body in this step.
double rollOf(const SubstepBody& b) {
  return b.state == 0 ? 0 : std::min(std::fabs(b.turn), 2.0) * b.reach;
}

SweptBox relativeTo(const Place& origin, const GridBounds& bounds) {
  const std::int64_t x = origin.cell_x * kGridUnits, y = origin.cell_y * kGridUnits;
  return {{static_cast<double>(bounds.lower_x - x), static_cast<double>(bounds.lower_y - y)},
          {static_cast<double>(bounds.upper_x - x), static_cast<double>(bounds.upper_y - y)}};
}

// Returns what remains of a motion after `time`.
RigidMotion restOf(const RigidMotion& motion, double time) {
  return {(1 - time) * motion.displacement, turned(motion.start, time * motion.turn),
          (1 - time) * motion.turn};
}

// Returns when shapes first touch those of another body; kNever if they do not.
double touchTime(std::span<const ConvexShape> own, const RigidMotion& motion,
                 std::span<const ConvexShape> others, const RigidMotion& its, Vec2 offset) {
  double first = kNever;
  for (const ConvexShape& shape : own) {
    for (const ConvexShape& other : others) {
      const TimeOfImpact impact = timeOfImpact(shape, motion, other, its, offset);
      if (impact.status != TimeOfImpactStatus::kApart) first = std::min(first, impact.time);
    }
  }
  return first;
}

}  // namespace

bool SubstepWorld::isFast(const SubstepBody& b) const {
  const double movement = length(movedBy(b)) + rollOf(b);
  return movement > b.margin + kMaxPass * b.thickness && movement < kFarthest;
}

void SubstepWorld::addFast(std::int32_t id) {
  const SubstepBody& b = m_bodies[at(id)];
  m_fast.push_back({movedBy(b), rollOf(b), b.thickness, id, sweptBounds(b.body.place, b.reach, movedBy(b))});
}

void SubstepWorld::stopFast() {
  m_fast.clear();
  for (const std::int32_t id : m_active) {
    const SubstepBody& b = m_bodies[at(id)];
    if (b.proxy >= 0 && isFast(b)) addFast(id);
  }
  if (m_fast.empty()) return;
  if (!m_drivers.empty()) addDriven();
  treePaths();
  m_near.clear();
  if (m_are_crowded) {
    for (const Fast& fast : m_fast) {
      const int own = m_fast_numbers[at(fast.id)];
      visitPathsBeside(own, [&](int other) {
        if (other > own) approach(own, other);
      });
    }
  } else {
    m_path_tree.queryPairs([this](int one, int other) { approach(one, other); });
  }
  for (Fast& fast : m_fast) {
    if (!isMovable(m_bodies[at(fast.id)])) continue;
    if (!m_are_many) {
      m_broad.query(fast.way, [&](std::uint32_t other) {
        if (m_fast_numbers[other] == kSlowNumber) addNear(fast, static_cast<std::int32_t>(other));
      });
    }
    stop(fast);
  }
  stopJoined();
}

// Wakes the sleeping bodies in the way of fast kinematic ones.
void SubstepWorld::wakeAhead() {
  const std::size_t before = m_active.size();
  for (const std::int32_t driver : m_drivers) {
    const SubstepBody& d = m_bodies[at(driver)];
    if (d.proxy < 0 || length(d.drift) + d.roll <= d.margin + kMaxPass * d.thickness) continue;
    m_broad.query(sweptBounds(d.body.place, d.reach, d.drift),
                  [this](std::uint32_t id) { wakeInStep(static_cast<std::int32_t>(id)); });
  }
  if (m_active.size() == before) return;
  sortActive(before);
  for (std::size_t i = before; i < m_active.size(); ++i) begin(m_active[i]);
  sortActive();
}

// Adds the bodies in the way of fast kinematic ones. Sorts all by the time at which such a body reaches them,
// because the first ones push the others.
void SubstepWorld::addDriven() {
  const auto own = static_cast<std::ptrdiff_t>(m_fast.size());
  for (std::ptrdiff_t i = 0; i < own; ++i) {
    const Fast driver = m_fast[at(i)];
    if (isMovable(m_bodies[at(driver.id)])) continue;
    m_broad.query(driver.way, [this](std::uint32_t id) {
      const SubstepBody& b = m_bodies[id];
      if (b.state > 0 && isMovable(b) && !isFast(b)) addFast(static_cast<std::int32_t>(id));
    });
  }
  const auto orderOf = [this](const Fast& fast) { return m_bodies[at(fast.id)].order; };
  std::sort(m_fast.begin() + own, m_fast.end(),
            [&](const Fast& x, const Fast& y) { return orderOf(x) < orderOf(y); });
  const auto isSame = [](const Fast& x, const Fast& y) { return x.id == y.id; };
  m_fast.erase(std::unique(m_fast.begin() + own, m_fast.end(), isSame), m_fast.end());
  for (std::ptrdiff_t i = 0; i < own; ++i) {
    const SubstepBody& d = m_bodies[at(m_fast[at(i)].id)];
    if (isMovable(d)) continue;
    for (Fast& fast : m_fast) {
      const SubstepBody& b = m_bodies[at(fast.id)];
      if (!isMovable(b) || !overlap(fast.way, m_fast[at(i)].way)) continue;
      const double time = touchTime(m_forms[b.form].shapes, motionOf(b), m_forms[d.form].shapes, motionOf(d),
                                    d.body.place - b.body.place);
      fast.reached = std::min(fast.reached, time);
    }
  }
  std::stable_sort(m_fast.begin(), m_fast.end(),
                   [](const Fast& x, const Fast& y) { return x.reached < y.reached; });
}

// Builds the tree of paths in which fast bodies find each other and, if there are many fast ones, the slow
// bodies. Paths are relative to a frame that moves with the fast bodies (m_along), in which they are short.
void SubstepWorld::treePaths() {
  m_paths.clear();
  m_path_values.clear();
  m_path_ids.clear();
  m_slow.clear();
  m_fast_numbers.assign(m_bodies.size(), kSlowNumber);
  m_along = middlePath();
  for (const Fast& fast : m_fast) {
    m_fast_numbers[at(fast.id)] = static_cast<std::int32_t>(m_paths.size());
    m_paths.push_back(seenPath(fast));
    m_path_values.push_back(crowdValue(m_bodies[at(fast.id)]));
  }
  const Place& origin = m_bodies[at(m_fast[0].id)].body.place;
  m_are_crowded = std::find(m_path_values.begin(), m_path_values.end(), kInCrowd) != m_path_values.end();
  m_are_many = m_are_crowded || m_fast.size() * kFewFast >= m_bodies.size();
  for (std::int32_t id = 0; m_are_many && id < idLimit(); ++id) {
    const SubstepBody& b = m_bodies[at(id)];
    if (b.proxy < 0 || m_fast_numbers[at(id)] != kSlowNumber) continue;
    m_slow.push_back(id);
    SweptBox swept = relativeTo(origin, m_broad.bounds(b.proxy));
    const Vec2 back = double{-kGridUnits} * m_along;
    swept.low += {std::min(back.x, 0.0), std::min(back.y, 0.0)};
    swept.high += {std::max(back.x, 0.0), std::max(back.y, 0.0)};
    m_paths.push_back(swept);
    m_path_values.push_back(crowdValue(b));
  }
  for (std::size_t i = 0; i < m_paths.size(); ++i) m_path_ids.push_back(static_cast<int>(i));
  m_path_tree.update(m_paths, m_path_ids, static_cast<int>(m_paths.size()), m_path_values);
}

// Calls visit() for the paths that overlap a path. Skips pairs of bodies in crowds, which pass each other.
template <typename Visit>
void SubstepWorld::visitPathsBeside(int own, Visit&& visit) const {
  const SweptBox& box = m_path_tree.box(own);
  const bool is_in_crowd = m_path_values[at(own)] == kInCrowd;
  m_path_tree.walk(
      [&](const ImpactTree::Below& below) {
        return overlaps(below.box, box) && !(is_in_crowd && below.least == kInCrowd);
      },
      visit);
}

SweptBox SubstepWorld::seenPath(const Fast& fast) const {
  const Place& origin = m_bodies[at(m_fast[0].id)].body.place;
  const SubstepBody& b = m_bodies[at(fast.id)];
  return relativeTo(origin, sweptBounds(b.body.place, b.reach, fast.path - m_along));
}

// Returns the median of the fast bodies' paths, which a single very fast body does not change much.
Vec2 SubstepWorld::middlePath() {
  m_path_order.resize(m_fast.size());
  const auto middle = m_path_order.begin() + static_cast<std::ptrdiff_t>(m_fast.size() / 2);
  const auto middleOf = [&](double Vec2::*axis) {
    for (std::size_t i = 0; i < m_fast.size(); ++i) m_path_order[i] = m_fast[i].path.*axis;
    std::nth_element(m_path_order.begin(), middle, m_path_order.end());
    return *middle;
  };
  return {middleOf(&Vec2::x), middleOf(&Vec2::y)};
}

GridBounds SubstepWorld::sweptBounds(const Place& from, double reach, Vec2 path) {
  return gridBounds(from,
                    {{std::min(path.x, 0.0) - reach, std::min(path.y, 0.0) - reach},
                     {std::max(path.x, 0.0) + reach, std::max(path.y, 0.0) + reach}},
                    0);
}

float SubstepWorld::crowdValue(const SubstepBody& b) const {
  return isMovable(b) && m_broad.isThinned(b.proxy) ? kInCrowd : 0;
}

// True if the bodies may pass through each other: both are in crowds, or one is and their centres are near.
bool SubstepWorld::passes(const SubstepBody& a, const SubstepBody& b) const {
  if (!isMovable(a) || !isMovable(b)) return false;
  const bool is_thinned = m_broad.isThinned(a.proxy), is_other = m_broad.isThinned(b.proxy);
  if (!is_thinned && !is_other) return false;
  const double near = a.thickness + b.thickness;
  return (is_thinned && is_other) || lengthSquared(b.body.place - a.body.place) < near * near;
}

void SubstepWorld::addNear(Fast& fast, std::int32_t id) {
  if (passes(m_bodies[at(fast.id)], m_bodies[at(id)])) return;
  ++m_counters.near;
  m_near.push_back({id, std::exchange(fast.near, static_cast<std::int32_t>(m_near.size()))});
}

// Adds each of two bodies of the path tree, one < other, to the possible obstacles of the other one if that
// is fast. Skips fast bodies that fly together until one of them is stopped or diverted.
void SubstepWorld::approach(int one, int other) {
  const auto fast_ones = static_cast<int>(m_fast.size());
  if (one >= fast_ones) return;
  Fast& fast = m_fast[at(one)];
  if (other >= fast_ones) {
    const std::int32_t slow = m_slow[at(other - fast_ones)];
    if (overlap(m_broad.bounds(m_bodies[at(slow)].proxy), fast.way)) addNear(fast, slow);
    return;
  }
  Fast& that = m_fast[at(other)];
  const double nearer = length(fast.path - that.path) + fast.roll + that.roll;
  const bool are_movable = isMovable(m_bodies[at(fast.id)]) && isMovable(m_bodies[at(that.id)]);
  const bool are_together = are_movable && nearer <= kMaxPass * std::min(fast.thickness, that.thickness);
  if (are_together && !fast.is_stopped && !that.is_stopped) return;
  addNear(fast, that.id);
  addNear(that, fast.id);
}

// Repeats approach() for a body that was stopped or diverted.
void SubstepWorld::approachAgain(Fast& fast) {
  const int own = m_fast_numbers[at(fast.id)];
  visitPathsBeside(own, [&](int other) {
    if (other != own) approach(std::min(own, other), std::max(own, other));
  });
}

// True if no immovable body except one touches the shapes, now or on this motion. `time` is now; until then,
// the body has moved by `moved`.
bool SubstepWorld::isClear(const SubstepBody& b, std::span<const ConvexShape> shapes,
                           const RigidMotion& motion, double time, Vec2 moved, std::int32_t except) {
  bool is_clear = true;
  m_broad.query(sweptBounds(b.body.place + moved, b.reach, motion.displacement), [&](std::uint32_t id) {
    const SubstepBody& other = m_bodies[id];
    if (!is_clear || isMovable(other) || static_cast<std::int32_t>(id) == except) return;
    const RigidMotion its = motionOf(other);
    const Vec2 offset = (other.body.place - b.body.place) + (time * its.displacement - moved);
    for (const ConvexShape& own : shapes) {
      for (const ConvexShape& that : m_forms[other.form].shapes) {
        const TimeOfImpact impact = timeOfImpact(own, motion, that, restOf(its, time), offset);
        is_clear = is_clear && impact.status == TimeOfImpactStatus::kApart && !impact.touched_before;
      }
    }
  });
  return is_clear;
}

// Returns the body's motion in this step, even if it was stopped.
RigidMotion SubstepWorld::wholeMotion(const SubstepBody& b) const {
  return {movedBy(b), b.body.rotation, std::clamp(b.turn, -kMaxTurn, kMaxTurn)};
}

// Returns the body's motion in this step. If the body was stopped, returns no motion, at its final rotation.
RigidMotion SubstepWorld::motionOf(const SubstepBody& b) const {
  if (b.state == 0) return {{}, b.body.rotation, 0};
  return b.part < 1 ? RigidMotion{{}, turned(b.body.rotation, b.part * b.turn), 0} : wholeMotion(b);
}

// Stops a fast body where it first touches a possible obstacle, or moves it on with that one from there.
void SubstepWorld::stop(Fast& fast) {
  const std::int32_t id = fast.id;
  SubstepBody& b = m_bodies[at(id)];
  const RigidMotion motion = wholeMotion(b);
  double first = b.part;
  std::int32_t met = -1;
  for (std::int32_t i = fast.near; i >= 0; i = m_near[at(i)].next) {
    const std::int32_t near = m_near[at(i)].id;
    const SubstepBody& other = m_bodies[at(near)];
    const RigidMotion its = motionOf(other);
    const double nearer = length(fast.path - its.displacement) + rollOf(b) + rollOf(other);
    const double pass = kMaxPass * std::min(b.thickness, other.thickness);
    // A kinematic body pushes on even if the sweeps do not move all that is in its way.
    const bool is_driver = !isMovable(other) && other.state > 0;
    if (nearer <= (is_driver ? 0 : marginOf(b, other)) + pass) continue;
    const auto pair = findPair(id, near);
    if (pair != m_pairs.end() && pair->is_jointed) continue;
    const bool is_pushing = pair != m_pairs.end() && pair->is_pushing;
    if (is_pushing && !is_driver && nearer <= b.margin + other.margin + pass) continue;
    const Vec2 offset = other.body.place - b.body.place +
                        (other.state > 0 && other.part < 1 ? other.part * movedBy(other) : Vec2{});
    // Rows keep only the known points apart, and other corners may touch in this step. So a body that is
    // pushed may rotate into the other body, but its core must not pass the other one. A body that is already
    // inside an immovable one would leave it on the far side, without touching more of it.
    const std::span<const ConvexShape> shapes = m_forms[other.form].shapes;
    ConvexShape core;
    const bool has_core = (is_pushing || !isMovable(other)) && makeCore(b, core);
    double time = has_core ? touchTime(std::span(&core, 1), motion, shapes, its, offset) : kNever;
    if (!is_pushing) time = std::min(time, touchTime(m_forms[b.form].shapes, motion, shapes, its, offset));
    const bool is_tie = time == first && met >= 0;
    if (time < first || (is_tie && other.order < m_bodies[at(met)].order)) first = time, met = near;
  }
  if (first >= b.part) return;
  ++m_counters.stopped;
  const std::int32_t number = m_fast_numbers[at(met)];
  Fast* const p_met = number == kSlowNumber || !isMovable(m_bodies[at(met)]) ? nullptr : &m_fast[at(number)];
  std::int32_t carrier = met;
  if (isMovable(m_bodies[at(met)])) {
    carrier = p_met != nullptr ? carrierOf(*p_met) : -1;
    if (carrier < 0) carrier = carrierOf(fast);
  }
  if (carrier >= 0 && m_bodies[at(carrier)].state > 0 && carry(fast, carrier, first)) return;
  if (p_met != nullptr && !p_met->is_stopped && advanceTogether(fast, *p_met, first)) return;
  for (Fast* const p_fast : {&fast, p_met}) {  // the fast body that was hit stops, too
    if (p_fast == nullptr || p_fast->carrier >= 0) continue;
    double& part = m_bodies[at(p_fast->id)].part;
    part = std::min(part, first);
    p_fast->is_stopped = true;
    approachAgain(*p_fast);
  }
}

// Stops the bodies that joints connect to a stopped one as early as that one, so that the joints do not open.
void SubstepWorld::stopJoined() {
  std::vector<double>& least = m_path_order;  // by group
  least.assign(m_joints.isEmpty() ? 0 : m_bodies.size(), 1);
  for (const bool is_end : {false, true}) {
    const auto visit = [&](int id) {
      if (id < 0 || !isMovable(m_bodies[at(id)])) return;
      double &part = m_bodies[at(id)].part, &of_group = least[at(m_joints.groupOf(id))];
      (is_end ? part : of_group) = std::min(part, of_group);
    };
    m_joints.visitLinks([&](int a, int b) { visit(a), visit(b); });
  }
}

// Returns the kinematic body that carries or pushes a fast one; −1 if none.
std::int32_t SubstepWorld::carrierOf(const Fast& fast) const {
  if (m_drivers.empty() || fast.carrier >= 0) return fast.carrier;
  for (std::int32_t i = fast.near; i >= 0; i = m_near[at(i)].next) {
    const SubstepBody& other = m_bodies[at(m_near[at(i)].id)];
    if (isMovable(other) || other.state == 0) continue;
    const auto pair = findPair(fast.id, m_near[at(i)].id);
    if (pair != m_pairs.end() && pair->is_pushing) return m_near[at(i)].id;
  }
  return -1;
}

// Makes the part of a body that must not pass others.
bool SubstepWorld::makeCore(const SubstepBody& b, ConvexShape& core) {
  return makeCircle(kCore * b.thickness, {}, core) == ShapeStatus::kOk;
}

// Moves a body that a kinematic one met at `time` with that one from there on, as if it were fixed to it. If
// it stopped, the other body would pass over it. Returns false, without a change, if another immovable body
// is in the way.
bool SubstepWorld::carry(Fast& fast, std::int32_t carrier, double time) {
  SubstepBody& b = m_bodies[at(fast.id)];
  const RigidMotion own = wholeMotion(b), its = wholeMotion(m_bodies[at(carrier)]);
  const Vec2 offset = b.body.place - m_bodies[at(carrier)].body.place;
  const Vec2 moved = time * own.displacement;
  const double turn = (1 - time) * its.turn;
  const Vec2 from_carrier = rotationBy(turn) * ((offset - time * its.displacement) + moved);
  const Vec2 path = its.displacement + (from_carrier - offset);
  ConvexShape core;
  if (!makeCore(b, core)) return false;
  if (!isClear(b, std::span(&core, 1), {path - moved, {}, 0}, time, moved, carrier)) return false;
  b.part = 1;
  b.turn = time * own.turn + turn;
  fast.carrier = carrier;
  fast.is_stopped = true;
  divert(fast, path);
  approachAgain(fast);
  return true;
}

// Gives a fast body another path.
void SubstepWorld::divert(Fast& fast, Vec2 path) {
  SubstepBody& b = m_bodies[at(fast.id)];
  const Vec2 gained = path - m_dt * b.body.velocity;
  SubstepState& s = m_states[at(b.state)];
  s.x = static_cast<float>(gained.x), s.y = static_cast<float>(gained.y);
  fast.path = movedBy(b);
  fast.roll = rollOf(b);
  fast.way = sweptBounds(b.body.place, b.reach, fast.path);
  b.is_diverted = true;
  m_path_tree.grow(m_fast_numbers[at(fast.id)], seenPath(fast));
}

// Gives two fast bodies that meet at `time` a common path from there on. If they stopped, bodies that fly
// behind them would run into them. Returns false, without a change, if a joint or immovable body prevents it.
bool SubstepWorld::advanceTogether(Fast& one, Fast& other, double time) {
  // Only the ratio of the masses matters, so the inverse masses are exchanged.
  const double mass_of_other = m_bodies[at(one.id)].body.inverse_mass;
  const double mass_of_one = m_bodies[at(other.id)].body.inverse_mass;
  const double sum = mass_of_one + mass_of_other;
  if (!(sum > 0)) return false;
  const Vec2 common = (mass_of_one * one.path + mass_of_other * other.path) / sum;
  const auto pathOf = [&](const Fast& fast) { return time * fast.path + (1 - time) * common; };
  for (const Fast* const p_fast : {&one, &other}) {
    const SubstepBody& b = m_bodies[at(p_fast->id)];
    const RigidMotion motion = {pathOf(*p_fast), b.body.rotation, wholeMotion(b).turn};
    if (m_energy.isJoined(b.state) || !isClear(b, m_forms[b.form].shapes, motion, 0, {}, -1)) return false;
  }
  for (Fast* const p_fast : {&one, &other}) divert(*p_fast, pathOf(*p_fast));
  approachAgain(one);
  approachAgain(other);
  return true;
}

}  // namespace naiad::physics

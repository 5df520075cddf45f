#include "physics/impact/ImpactWorld.h"

#include <algorithm>

namespace naiad::physics {

namespace {

// Prices of work, in multiplications:
constexpr double kForecastPrice = 80;  // for each examined pair
constexpr double kEventPrice = 200;    // per event, in addition to its examined pairs
constexpr double kBodyPrice = 50;      // for each body in each step

constexpr double kFarthest =
    1e15;  // metric cells (Vec2.h) in one tick; less than 2^51, the limit for moving a Place

// Returns in `low` and `high` how far a body moves along one axis within `t`.
void widen(double v, double a, double t, double& low, double& high) {
  const double end = t * (v + 0.5 * a * t);
  double farthest = 0;
  if (v * a < 0 && std::fabs(v) < std::fabs(a) * t) farthest = -0.5 * v * v / a;
  low = std::min({0.0, end, farthest});
  high = std::max({0.0, end, farthest});
}

// True if `a` is later, with which a heap has the earliest event on top.
template <typename Pending>
bool isLater(const Pending& a, const Pending& b) {
  if (a.time != b.time) return a.time > b.time;
  if (a.first != b.first) return a.first > b.first;
  return a.second > b.second;
}

}  // namespace

int ImpactWorld::add(const ImpactBody& body) {
  if (!isValid(body)) return -1;
  int id = m_lowest_free;
  while (id < idLimit() && m_motions[id].exists) ++id;
  m_lowest_free = id + 1;
  if (id == idLimit()) {
    m_bodies.emplace_back();
    m_motions.emplace_back();
  }
  m_motions[id] = {};
  m_motions[id].exists = m_motions[id].is_dirty = true;
  return set(id, body) ? id : -1;
}

bool ImpactWorld::set(int id, const ImpactBody& body) {
  if (!exists(id) || !isValid(body)) return false;
  Motion& motion = m_motions[id];
  if (m_bodies[id] == body && !motion.is_frozen) return true;
  if (isPushed(id) != (body.inverse_mass > 0)) {  // contacts are listed by pushable bodies only
    remove(id);
    motion.exists = true;
  }
  m_bodies[id] = body;
  m_bodies[id].place = body.place + Vec2{};
  motion.is_dirty = true;
  motion.is_frozen = motion.is_given_up = false;
  motion.acceleration = body.acceleration;
  return true;
}

bool ImpactWorld::remove(int id) {
  if (!exists(id)) return false;
  m_ending.clear();
  if (isPushed(id)) {
    for (int c = m_motions[id].first_contact; c >= 0;) {
      m_ending.push_back(c);
      c = m_contacts[c].first == id ? m_contacts[c].next_of_first : m_contacts[c].next_of_second;
    }
    std::sort(m_ending.begin(), m_ending.end());  // because their numbers are reused in the opposite order
  } else {
    for (int c = 0; c < static_cast<int>(m_contacts.size()); ++c) {
      if (m_contacts[c].first == id || m_contacts[c].second == id) m_ending.push_back(c);
    }
  }
  for (const int c : m_ending) {
    m_motions[m_contacts[c].first].is_dirty = m_motions[m_contacts[c].second].is_dirty = true;
    dropContact(c);
  }
  m_motions[id].exists = false;
  m_lowest_free = std::min(m_lowest_free, id);
  return true;
}

void ImpactWorld::advance(int id, double time) {
  Motion& motion = m_motions[id];
  const double t = time - motion.time;
  motion.time = time;
  if (!(t > 0) || !isMoving(id)) return;
  ImpactBody& body = m_bodies[id];
  const Vec2 displacement = t * body.velocity + (0.5 * t * t) * motion.acceleration;
  if (!(std::fabs(displacement.x) < kFarthest && std::fabs(displacement.y) < kFarthest)) {
    freeze(id);
    return;
  }
  body.place = body.place + displacement;
  body.velocity += t * motion.acceleration;
}

void ImpactWorld::freeze(int id) {
  Motion& motion = m_motions[id];
  motion.is_frozen = true;
  ++motion.generation;
  ++m_counters.quarantined;  // its contacts end at the start of the next tick
}

void ImpactWorld::giveUp(int id) {
  Motion& motion = m_motions[id];
  if (!isPushed(id) || motion.is_frozen) return;
  motion.is_frozen = motion.is_given_up = m_has_given_up = true;
  ++motion.generation;
  ++m_counters.given_up;
}

void ImpactWorld::spend(int id, double work) {
  m_work += work;
  if (isPushed(id)) m_motions[id].work += work;
}

// Returns the work that one group may do: the remaining budget, but at least kWorkOfBody.
double ImpactWorld::workLeft() const {
  return std::max(m_most_work - m_work, kWorkOfBody);
}

RelativeMotion ImpactWorld::relative(int a, int b, double now) const {
  const double ta = now - m_motions[a].time, tb = now - m_motions[b].time;
  const Vec2 aa = m_motions[a].acceleration, ab = m_motions[b].acceleration;
  const Vec2 va = m_bodies[a].velocity, vb = m_bodies[b].velocity;
  return {(m_bodies[b].place - m_bodies[a].place) +
              ((tb * vb + (0.5 * tb * tb) * ab) - (ta * va + (0.5 * ta * ta) * aa)),
          (vb + tb * ab) - (va + ta * aa), ab - aa};
}

// Returns the box around the body's path from now to the end of the tick, relative to the origin's cell, with
// a margin that is larger than rounding errors.
SweptBox ImpactWorld::sweptBox(int id, double now) const {
  const ImpactBody& body = m_bodies[id];
  const Motion& motion = m_motions[id];
  const double t = now - motion.time, left = m_dt - now;
  const Vec2 velocity = body.velocity + t * motion.acceleration;
  const Vec2 at = Vec2{static_cast<double>(body.place.cell_x - m_origin_x) + body.place.dx,
                       static_cast<double>(body.place.cell_y - m_origin_y) + body.place.dy} +
                  t * body.velocity + (0.5 * t * t) * motion.acceleration;
  const Vec2 half = body.shape == ImpactShape::kCircle ? Vec2{body.half.x, body.half.x} : body.half;
  Vec2 low, high;
  widen(velocity.x, motion.acceleration.x, left, low.x, high.x);
  widen(velocity.y, motion.acceleration.y, left, low.y, high.y);
  low += at - half;
  high += at + half;
  const auto margin = [](double a, double b) { return 1e-9 * (1 + std::max(std::fabs(a), std::fabs(b))); };
  const Vec2 wider = {margin(low.x, high.x), margin(low.y, high.y)};
  return {low - wider, high + wider};
}

void ImpactWorld::setReach(int id, const Place& centre, Vec2 half) {
  if (!exists(id)) return;
  if (id >= static_cast<int>(m_reaches.size())) m_reaches.resize(m_bodies.size());
  m_reaches[id] = {centre, half};
  m_motions[id].has_reach = true;
}

bool ImpactWorld::isWithinReach(int id, const SweptBox& box) const {
  if (!m_motions[id].has_reach) return true;
  const Reach& reach = m_reaches[id];
  const Vec2 centre = {static_cast<double>(reach.centre.cell_x - m_origin_x) + reach.centre.dx,
                       static_cast<double>(reach.centre.cell_y - m_origin_y) + reach.centre.dy};
  return contains({centre - reach.half, centre + reach.half}, box);
}

void ImpactWorld::markChanged(int id) {
  if (m_motions[id].is_changed) return;
  m_motions[id].is_changed = true;
  m_changed.push_back(id);
}

void ImpactWorld::beginTick(double dt) {
  m_dt = dt;
  m_events.clear();
  m_queue.clear();
  m_ids.clear();
  for (int id = 0; id < idLimit(); ++id) {
    Motion& motion = m_motions[id];
    if (!motion.exists || motion.is_frozen) continue;
    const ImpactBody& body = m_bodies[id];
    const Vec2 reach = dt * (Vec2{std::fabs(body.velocity.x), std::fabs(body.velocity.y)} +
                             0.5 * dt * Vec2{std::fabs(body.acceleration.x), std::fabs(body.acceleration.y)});
    if (!(reach.x < kFarthest && reach.y < kFarthest)) {
      freeze(id);
      continue;
    }
    motion.time = 0;
    motion.events_at_once = 0;
    motion.last_event = -1;
    m_ids.push_back(id);
    m_work += kBodyPrice;
  }
  for (std::size_t i = 0; i < m_contacts.size(); ++i) {
    const Contact& contact = m_contacts[i];
    if (contact.first < 0) continue;
    if (m_motions[contact.first].is_frozen || m_motions[contact.second].is_frozen) {
      m_motions[contact.first].is_dirty = m_motions[contact.second].is_dirty = true;
      dropContact(static_cast<int>(i));
      continue;
    }
  }
  for (const int id : m_ids) {
    Motion& motion = m_motions[id];
    if (motion.first_contact < 0) motion.acceleration = m_bodies[id].acceleration;
  }
  for (const Contact& contact : m_contacts) {
    if (contact.first < 0) continue;
    const RelativeMotion motion = relative(contact.first, contact.second, 0);
    const bool is_still = motion.velocity == Vec2{} && motion.acceleration == Vec2{};
    if (is_still && !m_motions[contact.first].is_dirty && !m_motions[contact.second].is_dirty) continue;
    for (const int id : {contact.first, contact.second}) {
      if (isPushed(id)) markChanged(id);
    }
  }
  settleAtStart();
  placeBoxes();
}

void ImpactWorld::settleAtStart() {
  settle(0);
  for (const int id : m_changed) m_motions[id].is_changed = false;
  m_changed.clear();
}

void ImpactWorld::placeBoxes() {
  m_boxes.clear();
  if (m_ids.empty()) return;
  m_origin_x = m_bodies[m_ids[0]].place.cell_x;
  m_origin_y = m_bodies[m_ids[0]].place.cell_y;
  for (const int id : m_ids) m_boxes.push_back(sweptBox(id, 0));
  m_tree.update(m_boxes, m_ids, idLimit());
}

// Appends the pairs of a body. Returns false and appends none if there are more than `most`. Pairs with
// abandoned bodies are counted, too; otherwise each body of a crowd would examine all bodies before it.
bool ImpactWorld::listCandidates(int id, std::size_t most) {
  const std::size_t before = m_candidates.size();
  std::size_t count = 0;
  m_tree.query(m_tree.box(id), [&](int other) {
    const bool is_given_up = m_motions[other].is_frozen;
    if (other == id || (other < id && isMoving(other) && !is_given_up)) return true;
    if (!isPushed(id) && !isPushed(other)) return true;
    if (!is_given_up) m_candidates.push_back({id, other});
    return ++count <= most;
  });
  if (count <= most) return true;
  m_candidates.resize(before);
  return false;
}

// Lists all pairs whose paths may cross. All pairs are listed before any is examined, and thousands of bodies
// in one place have too many. So after the first body whose pairs exceed the tick's shared budget, each body
// has only its own share.
void ImpactWorld::listCandidates() {
  constexpr auto kOwnShare = static_cast<std::size_t>(kWorkOfBody / kForecastPrice);
  constexpr double kEnough = 1e15;
  const double most_shared = m_reserve < kUnbounded ? kWorkOfTick : kEnough;
  const double left_now = std::clamp(m_most_work - m_work, 0.0, most_shared);
  const auto shared = static_cast<std::size_t>(left_now / kForecastPrice);
  bool is_spent = false;
  m_candidates.clear();
  m_candidates.reserve(8 * m_ids.size());
  for (std::size_t i = 0; i < m_ids.size(); ++i) {
    const int id = m_ids[i];
    if (!isMoving(id) || m_motions[id].is_frozen) continue;
    const std::size_t all = is_spent ? 0 : shared + (i + 1) * kOwnShare;  // includes what earlier bodies left
    const std::size_t left = all > m_candidates.size() ? all - m_candidates.size() : 0;
    // A body that cannot be pushed is never given up, so its number of pairs is not limited.
    const std::size_t most = isPushed(id) ? std::max(left, kOwnShare) : m_ids.size();
    if (listCandidates(id, most)) continue;
    giveUp(id);
    is_spent = true;
  }
}

void ImpactWorld::forecastAll() {
  listCandidates();
  if (touchCandidates()) {
    settleAtStart();
    placeBoxes();
    listCandidates();
  }
  for (const int id : m_ids) m_motions[id].is_dirty = false;
  for (const Candidate& pair : m_candidates) {
    if (m_motions[pair.id].is_frozen || m_motions[pair.other].is_frozen) continue;
    forecastPair(pair.id, pair.other, 0);
    if (isOverdrawn(pair.id)) giveUp(pair.id);
  }
}

void ImpactWorld::forecastChanged(double now) {
  std::sort(m_changed.begin(), m_changed.end());
  for (const int i : m_changed) {
    ++m_motions[i].generation;
    if (m_motions[i].is_frozen) continue;
    const SweptBox box = sweptBox(i, now);
    m_tree.grow(i, box);
    if (isPushed(i) && !isWithinReach(i, box)) m_is_beyond = true;
  }
  for (const int i : m_changed) {
    if (m_motions[i].is_frozen) continue;
    m_tree.query(sweptBox(i, now), [&](int j) {
      if (j == i || m_motions[j].is_frozen || (j < i && m_motions[j].is_changed)) return true;
      if (isMoving(i) || isMoving(j)) forecastPair(i, j, now);
      if (isOverdrawn(i)) giveUp(i);
      return !m_motions[i].is_frozen;
    });
  }
  for (const int i : m_changed) m_motions[i].is_changed = false;
  m_changed.clear();
}

void ImpactWorld::forecastPair(int i, int j, double now) {
  if (!isPushed(i) && !isPushed(j)) return;
  ++m_counters.forecasts;
  spend(i, kForecastPrice);
  const int first = std::min(i, j), second = std::max(i, j);
  const ImpactBody &a = m_bodies[first], &b = m_bodies[second];
  const RelativeMotion motion = relative(first, second, now);
  if (isPushed(first) && isPushed(second) && touchOf(a, b, motion.offset).gap < -kDeepest) {
    ++m_counters.overlaps;
    return;
  }
  const double left = m_dt - now, rest_speed = restSpeed(a.velocity, b.velocity);
  const int found = findContact(first, second);
  const bool is_resting = found >= 0 && m_contacts[found].is_resting;
  const ImpactForecast impact = forecastImpact(a, b, motion, left, rest_speed, is_resting);
  Pending next = {
      impact.time,   first,      second, m_motions[first].generation, m_motions[second].generation,
      Kind::kImpact, impact.axis};
  const auto take = [&](double time, Kind kind) {
    if (time < 0 || time > left || (next.time >= 0 && next.time <= time)) return;
    next.time = time;
    next.kind = kind;
  };
  if (is_resting) {
    const ImpactAxis axis = m_contacts[found].axis;
    take(forecastEdge(a, b, motion, axis, left), Kind::kEdge);
    const Vec2 along = perpendicular(touchOf(a, b, motion.offset, axis).normal);
    const double slip = dot(motion.velocity, along), gain = dot(motion.acceleration, along);
    if (std::fabs(slip) > rest_speed && slip * gain < 0) take(-slip / gain, Kind::kStop);
  }
  if (next.time < 0) return;
  next.time = std::min(now + next.time, m_dt);
  m_queue.push_back(next);
  std::push_heap(m_queue.begin(), m_queue.end(), isLater<Pending>);
}

bool ImpactWorld::isStale(const Pending& pending) const {
  return pending.first_generation != m_motions[pending.first].generation ||
         pending.second_generation != m_motions[pending.second].generation;
}

void ImpactWorld::compactQueue() {
  m_queue.erase(std::remove_if(m_queue.begin(), m_queue.end(), [&](const Pending& p) { return isStale(p); }),
                m_queue.end());
  std::make_heap(m_queue.begin(), m_queue.end(), isLater<Pending>);
  m_compact_at = std::max<std::size_t>(4096, 2 * m_queue.size());
}

void ImpactWorld::handle(const Pending& pending) {
  const int a = pending.first, b = pending.second;
  const double granted = std::min(kWorkOfEvent, m_reserve_left);
  m_reserve_left -= granted;
  m_most_work += granted;
  if (isOverdrawn(a) || isOverdrawn(b)) {
    giveUp(a);
    giveUp(b);
    return;
  }
  for (const int id : {a, b}) {
    spend(id, kEventPrice);
    advance(id, pending.time);
    markChanged(id);
    if (!isPushed(id)) continue;
    Motion& motion = m_motions[id];
    if (motion.last_event != pending.time) motion.events_at_once = 0;
    motion.last_event = pending.time;
    ++motion.events_at_once;
  }
  if (!m_motions[a].is_frozen && !m_motions[b].is_frozen) {
    if (pending.kind == Kind::kImpact) collide(a, b, pending.axis, pending.time);
    if (pending.kind == Kind::kStop) stopSliding(a, b);
  }
  settle(pending.time);
  forecastChanged(pending.time);
}

// Sorts the events. If a pair touches several times at one moment, as touching bodies do, it gets at most one
// start, with the sum of the impulses, and one end.
void ImpactWorld::sortEvents() {
  for (std::size_t i = 0; i < m_events.size(); ++i) m_events[i].order = static_cast<int>(i);
  std::sort(m_events.begin(), m_events.end(), [](const ImpactEvent& x, const ImpactEvent& y) {
    if (x.time != y.time) return x.time < y.time;
    if (x.first != y.first) return x.first < y.first;
    return x.second != y.second ? x.second < y.second : x.order < y.order;
  });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < m_events.size();) {
    ImpactEvent begin = m_events[i];
    std::size_t last = i;
    for (std::size_t j = i + 1; j < m_events.size() && m_events[j].time == begin.time &&
                                m_events[j].first == begin.first && m_events[j].second == begin.second;
         ++j) {
      begin.impulse += m_events[j].impulse;
      last = j;
    }
    const ImpactEvent end = m_events[last];
    i = last + 1;
    if (begin.is_begin) m_events[kept++] = begin;
    if (!end.is_begin) m_events[kept++] = end;
  }
  m_events.erase(m_events.begin() + static_cast<std::ptrdiff_t>(kept), m_events.end());
  for (std::size_t i = 0; i < kept; ++i) m_events[i].order = static_cast<int>(i);
}

ImpactStepStatus ImpactWorld::step(double dt, bool goes_on) {
  if (!(dt > 0 && dt < 1e12)) return ImpactStepStatus::kRefused;
  const std::int64_t frozen_before = m_counters.quarantined;
  ++m_counters.ticks;
  m_stepped = dt;
  m_is_beyond = false;
  if (!goes_on) {
    m_work = 0;
    m_most_work = m_reserve < kUnbounded ? kWorkOfTick : kUnbounded;
    m_reserve_left = m_reserve;
    m_has_given_up = false;
    for (Motion& motion : m_motions) {
      motion.work = 0;
      if (motion.exists) m_most_work += kWorkOfBody;
    }
  }
  beginTick(dt);
  forecastAll();
  while (!m_queue.empty() && !m_is_beyond) {
    std::pop_heap(m_queue.begin(), m_queue.end(), isLater<Pending>);
    const Pending next = m_queue.back();
    m_queue.pop_back();
    if (!isStale(next)) handle(next);
    if (m_is_beyond) m_stepped = next.time;
    if (m_queue.size() > m_compact_at) compactQueue();
  }
  for (const int id : m_ids) {
    if (!m_motions[id].is_frozen) advance(id, m_stepped);
    m_motions[id].time = 0;
    m_motions[id].has_reach = false;
  }
  sortEvents();
  return m_counters.quarantined == frozen_before ? ImpactStepStatus::kDone : ImpactStepStatus::kQuarantined;
}

}  // namespace naiad::physics

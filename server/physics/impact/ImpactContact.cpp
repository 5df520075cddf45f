// The contacts of an ImpactWorld: impacts, and bodies that rest on each other.
#include <algorithm>
#include <utility>

#include "physics/impact/ImpactWorld.h"

namespace naiad::physics {

ImpactWorld::PairState ImpactWorld::pairState(int a, int b, ImpactAxis axis) const {
  const ImpactBody &first = m_bodies[a], &second = m_bodies[b];
  PairState state;
  state.touch = touchOf(first, second, second.place - first.place, axis);
  state.velocity = second.velocity - first.velocity;
  state.approach = -dot(state.velocity, state.touch.normal);
  state.rest_speed = restSpeed(first.velocity, second.velocity);
  return state;
}

// True if the bodies should not bounce, because the bounce would be too slow or too low.
bool ImpactWorld::isSoft(int a, int b, const PairState& state) const {
  const double restitution = restitutionOf(m_bodies[a], m_bodies[b]);
  const double bounce = restitution * state.approach;
  if (bounce <= state.rest_speed) return true;
  if (restitution < 1 &&
      (m_motions[a].events_at_once > kMaxAtOnce || m_motions[b].events_at_once > kMaxAtOnce)) {
    return true;  // too many impacts at one moment: further bounces would have no height
  }
  double pressing = -dot(m_motions[b].acceleration - m_motions[a].acceleration, state.touch.normal);
  if (restitution < 1) {  // bodies that fall together do not press, but their bounces must end
    for (const int id : {a, b}) {
      pressing = std::max(pressing, std::fabs(dot(m_bodies[id].acceleration, state.touch.normal)));
    }
  }
  return pressing > 0 && bounce * bounce <= 2 * pressing * kRestHeight;
}

void ImpactWorld::collide(int a, int b, ImpactAxis axis, double now) {
  ++m_counters.impacts;
  ImpactBody &first = m_bodies[a], &second = m_bodies[b];
  PairState state = pairState(a, b, axis);
  const double masses = first.inverse_mass + second.inverse_mass;
  if (std::fabs(state.touch.gap) <= 2 * kImpactSlop) {  // only the moment was rounded: make them touch
    const Vec2 by = (state.touch.gap / masses) * state.touch.normal;
    if (first.inverse_mass > 0) first.place = first.place + first.inverse_mass * by;
    if (second.inverse_mass > 0) second.place = second.place + -second.inverse_mass * by;
  }
  int contact = findContact(a, b);
  const bool is_new = contact < 0;
  if (is_new) contact = makeContact(a, b, axis);
  m_contacts[contact].axis = axis;
  double impulse = 0;
  if (state.approach < 0) {
    const double pressing = -dot(m_motions[b].acceleration - m_motions[a].acceleration, state.touch.normal);
    // They separate, but too slowly to rise by kRestHeight, so the next impact would repeat this one.
    if (pressing > 0 && state.approach * state.approach <= 2 * pressing * kRestHeight) {
      const Vec2 pull = (state.approach / masses) * state.touch.normal;
      first.velocity -= first.inverse_mass * pull;
      second.velocity += second.inverse_mass * pull;
    }
  } else if (isSoft(a, b, state)) {
    if (state.approach > 0) impulse = pushGroupOf(contact, now);
  } else {
    pushPair(a, b, state);
    impulse = (1 + restitutionOf(first, second)) * state.approach / masses;
  }
  if (is_new) m_events.push_back({now, a, b, true, impulse, state.touch.normal});
}

void ImpactWorld::pushPair(int a, int b, const PairState& state) {
  ImpactBody &first = m_bodies[a], &second = m_bodies[b];
  const double masses = first.inverse_mass + second.inverse_mass;
  const double impulse = (1 + restitutionOf(first, second)) * state.approach / masses;
  Vec2 push = impulse * state.touch.normal;
  const double friction = frictionOf(first, second);
  if (friction > 0) {
    const Vec2 along = perpendicular(state.touch.normal);
    const double stop = -dot(state.velocity, along) / masses;
    push += std::clamp(stop, -friction * impulse, friction * impulse) * along;
  }
  first.velocity -= first.inverse_mass * push;
  second.velocity += second.inverse_mass * push;
}

// Removes the slip that rounding leaves when friction stops a sliding contact.
void ImpactWorld::stopSliding(int a, int b) {
  const int contact = findContact(a, b);
  if (contact < 0) return;
  ImpactBody &first = m_bodies[a], &second = m_bodies[b];
  const PairState state = pairState(a, b, m_contacts[contact].axis);
  const Vec2 along = perpendicular(state.touch.normal);
  const double slip = dot(state.velocity, along);
  if (std::fabs(slip) > 10 * state.rest_speed) return;
  const Vec2 push = (-slip / (first.inverse_mass + second.inverse_mass)) * along;
  first.velocity -= first.inverse_mass * push;
  second.velocity += second.inverse_mass * push;
}

bool ImpactWorld::keepsContact(const Contact& contact, const PairState& state) const {
  const bool are_boxes = m_bodies[contact.first].shape == ImpactShape::kBox &&
                         m_bodies[contact.second].shape == ImpactShape::kBox;
  return state.touch.gap <= 2 * kImpactSlop && state.approach >= -state.rest_speed &&
         !(are_boxes && state.touch.overlap <= 1.01 * kImpactSlop);
}

int ImpactWorld::localOf(int id) {
  if (!isPushed(id)) return -1;
  if (m_motions[id].local < 0) {
    m_motions[id].local = static_cast<int>(m_group.size());
    m_group.push_back(id);
  }
  return m_motions[id].local;
}

// Fills m_group and m_group_contacts. For an impact: with bodies connected to `own_contact` by contacts that
// would not bounce. Otherwise: with bodies connected to `body` by resting contacts; separated contacts end.
void ImpactWorld::gather(int body, double now, bool is_impact, int own_contact) {
  m_group.clear();
  m_group_contacts.clear();
  if (is_impact) {
    localOf(m_contacts[own_contact].first);
    localOf(m_contacts[own_contact].second);
  } else {
    localOf(body);
  }
  for (std::size_t i = 0; i < m_group.size(); ++i) {
    const int id = m_group[i];
    for (int c = m_motions[id].first_contact; c >= 0;) {
      Contact& contact = m_contacts[c];
      const int next = contact.first == id ? contact.next_of_first : contact.next_of_second;
      const int other = contact.first == id ? contact.second : contact.first;
      const int at = c;
      c = next;
      if (contact.is_listed) continue;
      advance(other, now);
      if (m_motions[other].is_frozen) continue;
      const PairState state = pairState(contact.first, contact.second, contact.axis);
      if (at != own_contact && !keepsContact(contact, state)) {  // own_contact may touch only at corners
        if (!is_impact) {
          markChanged(contact.first);
          markChanged(contact.second);
          endContact(at, now);
        }
        continue;
      }
      if (is_impact) {
        if (at != own_contact && !isSoft(contact.first, contact.second, state)) continue;
      } else {
        contact.is_resting = state.approach <= state.rest_speed;
        if (!contact.is_resting) continue;  // the bodies still approach: this will be an impact
      }
      contact.is_listed = true;
      m_group_contacts.push_back(at);
      localOf(other);
    }
  }
  std::sort(m_group_contacts.begin(), m_group_contacts.end(), [&](int x, int y) {
    const Contact &p = m_contacts[x], &q = m_contacts[y];
    return p.first != q.first ? p.first < q.first : p.second < q.second;
  });
  m_group_masses.clear();
  for (const int id : m_group) m_group_masses.push_back(m_bodies[id].inverse_mass);
}

// Solves the group. The order of rows and sums depends only on ids, not on how the group was found.
void ImpactWorld::solveGroup(Purpose purpose) {
  m_rest.rows().clear();
  for (const int c : m_group_contacts) addRows(m_contacts[c], purpose);
  ++m_counters.rest_solves;
  if (!m_rest.solve(m_group_masses, workLeft())) ++m_counters.unconverged;
  const double share = m_rest.work() / static_cast<double>(m_group.size());
  for (const int id : m_group) {
    spend(id, share);
    if (m_rest.isTooCostly()) giveUp(id);
  }
}

// Moves overlapping bodies of a group apart, because impacts leave overlaps of the slop's size where circles
// slide around each other. Usually nothing has to be moved.
void ImpactWorld::partGroup(double now) {
  bool is_needed = false;
  for (const int c : m_group_contacts) {
    const Contact& contact = m_contacts[c];
    const double gap = pairState(contact.first, contact.second, contact.axis).touch.gap;
    is_needed = is_needed || (gap < -0.5 * kImpactSlop && gap > -kDeepest);
  }
  if (!is_needed) return;
  solveGroup(Purpose::kPlace);
  for (std::size_t i = 0; i < m_group.size(); ++i) {
    const Vec2 displacement = m_rest.change(static_cast<int>(i));
    if (displacement == Vec2{}) continue;
    const int id = m_group[i];
    advance(id, now);
    m_bodies[id].place = m_bodies[id].place + displacement;
    markChanged(id);
  }
}

void ImpactWorld::addRows(const Contact& contact, Purpose purpose) {
  const PairState state = pairState(contact.first, contact.second, contact.axis);
  const Vec2 normal = state.touch.normal, along = perpendicular(normal);
  const Vec2 pull = m_bodies[contact.second].acceleration - m_bodies[contact.first].acceleration;
  const double slip = dot(state.velocity, along);
  std::vector<RestRow>& rows = m_rest.rows();
  RestRow row;
  row.first = localOf(contact.first);
  row.second = localOf(contact.second);
  row.direction = normal;
  // The normal turns while the bodies slide around each other, which needs an acceleration.
  const bool is_impact = purpose == Purpose::kImpact;
  row.bias = is_impact ? -state.approach : dot(pull, normal) + slip * slip * state.touch.curvature;
  if (purpose == Purpose::kPlace) row.bias = state.touch.gap > -kDeepest ? state.touch.gap : 0;
  const double friction = frictionOf(m_bodies[contact.first], m_bodies[contact.second]);
  rows.push_back(row);
  if (friction == 0 || purpose == Purpose::kPlace) return;
  row.normal = static_cast<int>(rows.size()) - 1;
  row.friction = friction;
  row.direction = along;
  row.bias = is_impact ? slip : dot(pull, along);
  if (!is_impact && std::fabs(slip) > state.rest_speed) row.slip = slip > 0 ? 1 : -1;
  rows.push_back(row);
}

// Applies an impact without a bounce to all bodies that rest on each other. Returns the impulse of `contact`.
double ImpactWorld::pushGroupOf(int contact, double now) {
  gather(-1, now, true, contact);
  solveGroup(Purpose::kImpact);
  double impulse = 0;
  std::size_t row = 0;
  for (const int c : m_group_contacts) {
    m_contacts[c].is_listed = false;
    if (c == contact) impulse = m_rest.rows()[row].push;
    row += frictionOf(m_bodies[m_contacts[c].first], m_bodies[m_contacts[c].second]) == 0 ? 1 : 2;
  }
  for (std::size_t i = 0; i < m_group.size(); ++i) {
    const int id = m_group[i];
    m_motions[id].local = -1;
    const int local = static_cast<int>(i);
    const Vec2 change = m_rest.change(local);
    if (change == Vec2{}) continue;
    Vec2& velocity = m_bodies[id].velocity;
    velocity = {m_rest.settled(local, velocity.x, change.x), m_rest.settled(local, velocity.y, change.y)};
    markChanged(id);
  }
  return impulse;
}

// Makes contacts of all touching pairs that may press on each other, for bodies that have just been placed.
// Without this, one contact after the other would be found, each by an event with a solution of the whole
// group. Contacts that do not press are dropped. Returns false if there are too few.
bool ImpactWorld::touchCandidates() {
  constexpr int kFew = 4;  // if there are at most this many, it is as fast to find them one by one
  const auto mayPress = [&](int id, Vec2 normal) {
    const Vec2 pull = m_bodies[id].acceleration;
    return std::fabs(dot(pull, normal)) > 1e-9 * length(pull);
  };
  m_group_contacts.clear();
  for (const Candidate& pair : m_candidates) {
    if (!m_motions[pair.id].is_dirty && !m_motions[pair.other].is_dirty) continue;
    if (m_motions[pair.id].is_frozen || m_motions[pair.other].is_frozen) continue;
    const int a = std::min(pair.id, pair.other), b = std::max(pair.id, pair.other);
    const PairState state = pairState(a, b, ImpactAxis::kNearest);
    const bool are_boxes = m_bodies[a].shape == ImpactShape::kBox && m_bodies[b].shape == ImpactShape::kBox;
    ImpactAxis axis = ImpactAxis::kNearest;
    if (are_boxes) axis = state.touch.normal.x != 0 ? ImpactAxis::kX : ImpactAxis::kY;
    const bool touches = std::fabs(state.touch.gap) <= kImpactSlop &&
                         std::fabs(state.approach) <= state.rest_speed &&
                         !(are_boxes && state.touch.overlap <= 1.01 * kImpactSlop);
    if (!touches || !(mayPress(a, state.touch.normal) || mayPress(b, state.touch.normal))) continue;
    if (findContact(a, b) >= 0) continue;
    m_group_contacts.push_back(makeContact(a, b, axis));
  }
  const bool are_many = m_group_contacts.size() > kFew;
  for (const int c : m_group_contacts) {
    Contact& contact = m_contacts[c];
    contact.is_tried = are_many;
    for (const int id : {contact.first, contact.second}) {
      if (are_many && isPushed(id)) markChanged(id);
    }
    if (!are_many) dropContact(c);
  }
  return are_many;
}

void ImpactWorld::settle(double now) {
  for (std::size_t i = 0; i < m_changed.size(); ++i) {  // m_changed may grow in the loop
    const int id = m_changed[i];
    if (!isPushed(id) || m_motions[id].is_visited || m_motions[id].is_frozen) continue;
    settleGroup(id, now);
  }
  for (const int id : m_changed) m_motions[id].is_visited = false;
}

// Computes the accelerations of all bodies connected to `body` by resting contacts.
void ImpactWorld::settleGroup(int body, double now) {
  gather(body, now, false, -1);
  if (!m_group_contacts.empty()) {
    partGroup(now);
    solveGroup(Purpose::kRest);
  }
  for (std::size_t i = 0; i < m_group.size(); ++i) {
    const int id = m_group[i];
    Motion& motion = m_motions[id];
    motion.local = -1;
    Vec2 acceleration = m_bodies[id].acceleration;
    if (!m_group_contacts.empty()) {
      const int local = static_cast<int>(i);
      const Vec2 change = m_rest.change(local);
      acceleration = {m_rest.settled(local, acceleration.x, change.x),
                      m_rest.settled(local, acceleration.y, change.y)};
    }
    if (acceleration != motion.acceleration) {
      advance(id, now);
      motion.acceleration = acceleration;
      markChanged(id);
    }
    if (motion.is_changed) motion.is_visited = true;
  }
  std::size_t row = 0;
  for (const int c : m_group_contacts) {
    Contact& contact = m_contacts[c];
    contact.is_listed = false;
    const RestRow& normal = m_rest.rows()[row];
    row += frictionOf(m_bodies[contact.first], m_bodies[contact.second]) == 0 ? 1 : 2;
    if (std::exchange(contact.is_tried, false)) {
      if (!(normal.push > 0)) {
        dropContact(c);
        continue;
      }
      m_events.push_back({now, contact.first, contact.second, true, 0, normal.direction});
    }
    if (normal.push > 0) {
      calm(contact);
      continue;
    }
    const Vec2 gain = m_motions[contact.second].acceleration - m_motions[contact.first].acceleration;
    const double scale =
        length(m_bodies[contact.first].acceleration) + length(m_bodies[contact.second].acceleration);
    if (dot(gain, normal.direction) > 1e-12 * scale) endContact(c, now);
  }
}

// Removes the relative speed that rounding leaves at a contact whose bodies press on each other.
void ImpactWorld::calm(const Contact& contact) {
  ImpactBody &first = m_bodies[contact.first], &second = m_bodies[contact.second];
  const PairState state = pairState(contact.first, contact.second, contact.axis);
  const double masses = first.inverse_mass + second.inverse_mass;
  const Vec2 along = perpendicular(state.touch.normal);
  const double slip = dot(state.velocity, along);
  Vec2 left = -state.approach * state.touch.normal;
  if (std::fabs(slip) <= state.rest_speed && frictionOf(first, second) > 0) left += slip * along;
  if (left == Vec2{}) return;
  first.velocity += (first.inverse_mass / masses) * left;
  second.velocity -= (second.inverse_mass / masses) * left;
  for (const int id : {contact.first, contact.second}) {
    if (isPushed(id)) markChanged(id);
  }
}

int ImpactWorld::findContact(int a, int b) const {
  const int id = isPushed(a) ? a : b;
  for (int c = m_motions[id].first_contact; c >= 0;) {
    const Contact& contact = m_contacts[c];
    if (contact.first == a && contact.second == b) return c;
    c = contact.first == id ? contact.next_of_first : contact.next_of_second;
  }
  return -1;
}

int ImpactWorld::makeContact(int a, int b, ImpactAxis axis) {
  int c = m_free_contact;
  if (c < 0) {
    c = static_cast<int>(m_contacts.size());
    m_contacts.emplace_back();
  } else {
    m_free_contact = m_contacts[c].next_of_first;
  }
  Contact& contact = m_contacts[c];
  contact = {};
  contact.first = a;
  contact.second = b;
  contact.axis = axis;
  if (isPushed(a)) contact.next_of_first = std::exchange(m_motions[a].first_contact, c);
  if (isPushed(b)) contact.next_of_second = std::exchange(m_motions[b].first_contact, c);
  return c;
}

void ImpactWorld::unlink(int body, int contact) {
  int* link = &m_motions[body].first_contact;
  while (*link >= 0) {
    Contact& at = m_contacts[*link];
    int& next = at.first == body ? at.next_of_first : at.next_of_second;
    if (*link == contact) {
      *link = next;
      return;
    }
    link = &next;
  }
}

void ImpactWorld::dropContact(int c) {
  Contact& contact = m_contacts[c];
  for (const int id : {contact.first, contact.second}) {
    if (isPushed(id)) unlink(id, c);
  }
  contact.first = contact.second = -1;
  contact.next_of_first = m_free_contact;
  m_free_contact = c;
}

void ImpactWorld::endContact(int c, double now) {
  const Contact contact = m_contacts[c];
  const PairState state = pairState(contact.first, contact.second, contact.axis);
  dropContact(c);
  m_events.push_back({now, contact.first, contact.second, false, 0, state.touch.normal});
}

}  // namespace naiad::physics

// Contacts of a RigidWorld: keeps them from step to step, makes their constraints and publishes events.
#include <algorithm>
#include <cmath>

#include "physics/geometry/ShapeDistance.h"
#include "physics/rigid/RigidSolver.h"
#include "physics/rigid/RigidWorld.h"

namespace naiad::physics {

namespace {

// Lengths in units of the thinner body's thickness:
constexpr double kMaxPush = 2;    // per tick: maximum speed at which overlap is undone
constexpr double kSlop = 1e-8;    // overlap that is not undone, so that a contact at rest does not end
constexpr double kLinger = 0.01;  // a contact ends if its gap is larger
constexpr double kLarge = 2;      // ratio of reaches: above it, most shapes of the larger body are far away
constexpr double kSlide = 0.25;   // part of the reference face: farther sliding leaves the points behind

double edgeLength(const RotatedView& shape, std::int32_t edge) {
  return length(shape.vertices[following(edge, shape.count)] - shape.vertices[edge]);
}

// True if the body is immovable and does not rotate. Only then may its face be the reference for a sliding
// body: bodies would sink deeper into a rotating drum.
bool isFloor(const RigidBody& body) {
  return body.inverse_mass == 0 && body.spin == 0;
}

// True if a body slides so far in the step that it would leave the contact points behind. The points lie on
// the edge opposite the reference face and stay there for the step. If that edge is longer, such as a
// floor's, it is the better reference, because the points then move with the sliding body. `path` is the
// movement of B relative to A in the step.
bool slidesAway(const RotatedView& a, const RotatedView& b, Vec2 offset, Vec2 path, const Manifold& manifold,
                ReferenceFace& better) {
  using Owner = ReferenceFace::Owner;
  if (manifold.reference.owner == Owner::kNone) return false;
  const bool is_of_a = manifold.reference.owner == Owner::kA;
  const RotatedView &owner = is_of_a ? a : b, &other = is_of_a ? b : a;
  const double face = edgeLength(owner, manifold.reference.edge);
  if (std::fabs(cross(manifold.normal, path)) <= kSlide * face) return false;
  const FaceSeparation facing = bestFace(other, owner, is_of_a ? -offset : offset, kNoLimit);
  better = {is_of_a ? Owner::kB : Owner::kA, static_cast<std::uint8_t>(facing.edge)};
  return other.count > 2 && edgeLength(other, facing.edge) > face;
}

}  // namespace

std::int32_t RigidWorld::makeContact() {
  if (m_free_contact < 0) {
    m_contacts.emplace_back();
    return static_cast<std::int32_t>(m_contacts.size()) - 1;
  }
  const std::int32_t contact = m_free_contact;
  m_free_contact = m_contacts[at(contact)].next;
  m_contacts[at(contact)] = {};
  return contact;
}

void RigidWorld::dropContacts(Pair& pair) {
  for (std::int32_t i = pair.first; i >= 0;) {
    const std::int32_t next = m_contacts[at(i)].next;
    m_contacts[at(i)].next = m_free_contact;
    m_free_contact = i;
    i = next;
  }
  pair.first = -1;
}

std::int32_t RigidWorld::findPair(std::int32_t a, std::int32_t b) const {
  const auto found = std::lower_bound(
      m_pairs.begin(), m_pairs.end(), Late{a, b},
      [this](const Pair& p, Late x) { return p.a != x.a ? isBefore(p.a, x.a) : isBefore(p.b, x.b); });
  if (found == m_pairs.end() || found->a != a || found->b != b) return -1;
  return static_cast<std::int32_t>(found - m_pairs.begin());
}

// Removes a pair whose bounds no longer overlap.
void RigidWorld::dropPair(Pair& pair) {
  dropContacts(pair);
  if (pair.is_touching) addEvent({0, pair.a, pair.b, false, 0, {}});
}

void RigidWorld::forgetPairs(int id) {
  std::erase_if(m_pairs, [id](const Pair& pair) { return pair.a == id || pair.b == id; });
}

// Lists the body's touching pairs, so that the next step knows that they touched.
void RigidWorld::keepTouching(int id) {
  for (const Pair& pair : m_pairs) {
    if (!pair.is_touching || (pair.a != id && pair.b != id)) continue;
    const bool in_order = isBefore(pair.a, pair.b);
    m_late.push_back({in_order ? pair.a : pair.b, in_order ? pair.b : pair.a});
  }
}

// Adds an event, with the lower id first.
void RigidWorld::addEvent(RigidEvent event) {
  if (event.first > event.second) {
    std::swap(event.first, event.second);
    event.normal = -event.normal;
  }
  m_events.push_back(event);
}

void RigidWorld::updatePairs() {
  m_pairs.swap(m_pairs_before);
  m_pairs.clear();
  for (const BroadPhasePair& found : m_broad.updatePairs()) {
    const auto a = static_cast<std::int32_t>(found.id_a), b = static_cast<std::int32_t>(found.id_b);
    m_pairs.push_back(isBefore(a, b) ? Pair{a, b} : Pair{b, a});
  }
  const auto areBefore = [this](const Pair& x, const Pair& y) {
    return x.a != y.a ? isBefore(x.a, y.a) : isBefore(x.b, y.b);
  };
  if (!std::is_sorted(m_pairs.begin(), m_pairs.end(), areBefore))
    std::sort(m_pairs.begin(), m_pairs.end(), areBefore);
  std::size_t next = 0;
  for (Pair& pair : m_pairs) {
    while (next < m_pairs_before.size() && areBefore(m_pairs_before[next], pair))
      dropPair(m_pairs_before[next++]);
    const bool is_old =
        next < m_pairs_before.size() && m_pairs_before[next].a == pair.a && m_pairs_before[next].b == pair.b;
    if (is_old) pair = m_pairs_before[next++];
    if (!is_old || m_joints_changed) pair.is_jointed = m_joints.keepsApart(pair.a, pair.b);
    pair.is_seen = pair.is_pushing = pair.is_near = false;
    pair.event = -1;
  }
  while (next < m_pairs_before.size()) dropPair(m_pairs_before[next++]);
  m_joints_changed = false;
  if (!m_forgotten.empty())
    applyForget(
        m_pairs, [this](int id) { return isMovable(id); }, [this](Pair& pair) { dropContacts(pair); });
  for (const Late& late : m_late_before) {
    const std::int32_t pair = findPair(late.a, late.b);
    if (pair >= 0) {
      m_pairs[at(pair)].is_touching = true;
    } else if (exists(late.a) && exists(late.b)) {
      addEvent({0, late.a, late.b, false, 0, {}});
    }
  }
  m_late_before.clear();
}

// Repeats the update until no more bodies wake, because a woken body may wake others.
void RigidWorld::updateContacts(double dt) {
  std::size_t before = 0;
  do {
    before = m_active.size();
    for (std::int32_t i = 0; i < static_cast<std::int32_t>(m_pairs.size()); ++i) updatePair(i, dt);
  } while (m_active.size() > before);
  m_counters.contacts += static_cast<std::int64_t>(m_constraints.size());
}

ContactConstraint& RigidWorld::addConstraint(int a, int b) {
  m_constraints.emplace_back();
  ContactConstraint& c = m_constraints.back();
  const RigidBody &one = m_bodies[at(a)], &other = m_bodies[at(b)];
  c.a = a, c.b = b;
  c.friction = std::sqrt(one.friction * other.friction);
  c.restitution = std::max(one.restitution, other.restitution);
  const double thickness = std::min(m_extras[at(a)].thickness, m_extras[at(b)].thickness);
  c.max_push_speed = kMaxPush * thickness;
  c.slop = kSlop * thickness;
  const Extra &of_a = m_extras[at(a)], &of_b = m_extras[at(b)];
  c.may_fly =
      c.restitution == 1 ? !of_a.is_on_joints && !of_b.is_on_joints : !of_a.is_in_crowd && !of_b.is_in_crowd;
  return c;
}

void RigidWorld::updatePair(std::int32_t index, double dt) {
  Pair& pair = m_pairs[at(index)];
  if (pair.is_seen) return;
  const Extra &a = m_extras[at(pair.a)], &b = m_extras[at(pair.b)];
  const Vec2 offset = m_bodies[at(pair.b)].place - m_bodies[at(pair.a)].place;
  const double margin = a.margin + b.margin;
  const double reach = a.reach + b.reach + margin;
  const bool is_far = lengthSquared(offset) > reach * reach;
  if (is_far && pair.first < 0 && !pair.is_touching) {  // true for most pairs
    pair.is_seen = true;
    return;
  }
  if (!(a.is_active || a.is_dirty || b.is_active || b.is_dirty)) return;
  const bool a_sleeps = a.is_asleep, b_sleeps = b.is_asleep;
  if ((a_sleeps || !isMovable(pair.a)) && (b_sleeps || !isMovable(pair.b)) &&
      !(a_sleeps && (b.is_active || b.is_dirty)) && !(b_sleeps && (a.is_active || a.is_dirty))) {
    return;
  }
  pair.is_seen = true;
  if (pair.is_jointed) return dropContacts(pair);
  if (is_far) return dropContacts(pair);
  const Vec2 path = dt * (m_bodies[at(pair.b)].velocity - m_bodies[at(pair.a)].velocity);
  const bool is_a_large = a.reach > kLarge * b.reach, is_b_large = b.reach > kLarge * a.reach;
  const std::size_t first_constraint = m_constraints.size();
  std::int32_t old = pair.first, last = -1;
  pair.first = -1;
  const auto append = [&](std::int32_t contact) {
    (last >= 0 ? m_contacts[at(last)].next : pair.first) = contact;
    m_contacts[at(contact)].next = -1;
    last = contact;
  };
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(a.turned.size()); ++i) {
    for (std::int32_t j = 0; j < static_cast<std::int32_t>(b.turned.size()); ++j) {
      std::int32_t contact = -1;
      if (old >= 0 && m_contacts[at(old)].shape_a == i && m_contacts[at(old)].shape_b == j) {
        contact = old;
        old = m_contacts[at(old)].next;
      }
      const bool is_apart = (is_a_large && faceGap(a.turned[at(i)], offset, b.reach) > margin) ||
                            (is_b_large && faceGap(b.turned[at(j)], -offset, a.reach) > margin);
      if (is_apart && contact < 0) continue;
      Manifold& manifold = m_manifold;
      const ReferenceFace kept = contact >= 0 ? m_contacts[at(contact)].reference : ReferenceFace{};
      if (!collide(a.turned[at(i)], b.turned[at(j)], offset, margin, kept, manifold)) {
        if (contact >= 0) {
          m_contacts[at(contact)].next = m_free_contact;
          m_free_contact = contact;
        }
        continue;
      }
      const bool is_of_a = manifold.reference.owner == ReferenceFace::Owner::kA;
      ReferenceFace better;
      if (isFloor(m_bodies[at(is_of_a ? pair.b : pair.a)]) &&
          slidesAway(a.turned[at(i)], b.turned[at(j)], offset, path, manifold, better))
        collide(a.turned[at(i)], b.turned[at(j)], offset, margin, better, manifold);
      if (contact < 0) contact = makeContact();
      RigidContact& memory = m_contacts[at(contact)];
      memory.shape_a = i, memory.shape_b = j;
      memory.reference = manifold.reference;
      append(contact);
      ContactConstraint& c = addConstraint(pair.a, pair.b);
      c.pair = index, c.contact = contact;
      c.is_kept = pair.is_touching;
      if (hasFrictionParts()) c.friction = frictionOf(pair.a, pair.b, manifold);
      beginConstraint(a.turned[at(i)], b.turned[at(j)], offset, manifold, c);
      for (std::int32_t k = 0; k < c.count; ++k) {
        ContactPoint& p = c.points[at(k)];
        m_deepest = std::max(m_deepest, -p.separation);
        for (std::int32_t l = 0; l < memory.count; ++l) {
          if (memory.id[at(l)] != p.id) continue;
          p.normal_impulse = m_h * memory.normal_impulse[at(l)];
          // No row would change it, because there is no friction.
          if (c.friction > 0) p.friction_impulse = m_h * memory.friction_impulse[at(l)];
        }
      }
    }
  }
  if (m_constraints.size() == first_constraint) return;
  for (const int id : {pair.a, pair.b}) {
    if (!m_extras[at(id)].is_asleep) continue;
    wakeRing(id);
    int member = id;
    do {
      Extra& extra = m_extras[at(member)];
      if (!extra.is_active && !extra.is_frozen) {
        extra.is_active = true;
        m_active.push_back(member);
        beginBody(member, dt);
      }
      member = extra.ring;
    } while (member != id);
  }
  for (std::size_t i = first_constraint; i < m_constraints.size(); ++i) refresh(m_constraints[i], m_states);
}

void RigidWorld::storeContact(const ContactConstraint& c, double h) {
  if (c.contact < 0) return;
  RigidContact& memory = m_contacts[at(c.contact)];
  memory.count = c.count;
  for (std::int32_t k = 0; k < c.count; ++k) {
    const ContactPoint& p = c.points[at(k)];
    memory.id[at(k)] = p.id;
    memory.normal_impulse[at(k)] = p.normal_impulse / h;
    memory.friction_impulse[at(k)] = p.friction_impulse / h;
  }
}

void RigidWorld::publishBegin(const ContactConstraint& c, double dt) {
  const double impulse = c.points[0].total + c.points[1].total;
  const double linger = kLinger * std::min(m_extras[at(c.a)].thickness, m_extras[at(c.b)].thickness);
  std::int32_t index = c.pair >= 0 ? c.pair : findPair(c.a, c.b);
  const double least =
      c.count > 1 ? std::min(c.points[0].separation, c.points[1].separation) : c.points[0].separation;
  if (index >= 0 && least <= linger) m_pairs[at(index)].is_near = true;
  if (!(impulse > 0)) return;
  m_extras[at(c.a)].is_pushed = m_extras[at(c.b)].is_pushed = true;
  const bool is_late = index < 0;
  if (!is_late) {
    Pair& pair = m_pairs[at(index)];
    if (pair.is_touching && !pair.is_pushing) {
      pair.is_pushing = true;  // the contact continues
      return;
    }
    if (pair.is_touching) {  // true if the contact began or continued in this step
      if (pair.event >= 0) m_events[at(pair.event)].impulse += impulse;
      return;
    }
    pair.is_touching = pair.is_pushing = true;
    pair.event = static_cast<std::int32_t>(m_events.size());
  } else {
    if (std::find(m_late.begin(), m_late.end(), Late{c.a, c.b}) != m_late.end()) return;
    m_late.push_back({c.a, c.b});
  }
  addEvent({std::min(std::max(c.first_time, 0.0), dt), c.a, c.b, true, impulse, c.first_normal});
}

void RigidWorld::publishEnds(double dt) {
  for (Pair& pair : m_pairs) {
    if (!pair.is_seen || !pair.is_touching || pair.is_pushing || pair.is_near) continue;
    pair.is_touching = false;
    addEvent({dt, pair.a, pair.b, false, 0, {}});
  }
}

}  // namespace naiad::physics

// Contacts of a SubstepWorld, kept from step to step: chooses the pairs to test and updates their manifolds.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

#include "physics/geometry/Reserve.h"
#include "physics/geometry/ShapeDistance.h"
#include "physics/substep/Fetch.h"
#include "physics/substep/SubstepWorld.h"

namespace naiad::physics {

namespace {

// Lengths in units of the thinner body's thickness:
constexpr double kSlowMargin = 0.12;   // bodies with smaller margins do not push others off their paths
constexpr double kLinger = 0.01;       // a contact ends if its gap is larger
constexpr double kCalmDepth = 0.1;     // slow bodies with less overlap may be at rest
constexpr double kSunk = 1;            // a load has sunk if its overlap is larger: half the thinner body
constexpr double kKept = 0.005;        // after this relative movement, a manifold is computed again
constexpr double kPushedAgain = 0.5;   // fraction of the last step's push that is expected again
constexpr double kEverywhere = 1e300;  // metric cells: a deviation by which a body may reach every other
constexpr double kOverload = 30;       // ratio of masses above which one body is a load for the other
constexpr double kLarge = 4;           // ratio of reaches above which one body is much larger than the other
// Limit of the sweeps over separated pairs. If deviations still spread then, they count as unlimited.
constexpr int kMaxSweeps = 32;

// Returns an upper bound of the relative speed of any two points of the bodies at the start of a step.
double speedBetween(const SubstepBody& a, const SubstepBody& b) {
  return length(b.body.velocity - a.body.velocity) + std::fabs(a.body.spin) * a.reach +
         std::fabs(b.body.spin) * b.reach;
}

// Returns a lower bound of the distance between two boxes; negative if they overlap.
double gapBetween(const Bounds& a, const Bounds& b, Vec2 offset) {
  return std::max(std::max(offset.x + b.lower.x - a.upper.x, a.lower.x - b.upper.x - offset.x),
                  std::max(offset.y + b.lower.y - a.upper.y, a.lower.y - b.upper.y - offset.y));
}

bool isOverloaded(const SubstepBody& a, const SubstepBody& b) {
  const auto [heavy, light] = std::minmax(a.body.inverse_mass, b.body.inverse_mass);
  return heavy > 0 && kOverload * heavy < light;
}

// Returns the maximum change of the lighter body's speed, as a multiple of the speed at which they touch.
double reboundOf(const SubstepBody& a, const SubstepBody& b) {
  return 1 + std::max(a.body.restitution, b.body.restitution);
}

}  // namespace

std::int32_t SubstepWorld::makeMemory() {
  if (m_free_memory < 0) {
    m_memory.emplace_back();
    return static_cast<std::int32_t>(m_memory.size()) - 1;
  }
  const std::int32_t memory = m_free_memory;
  m_free_memory = m_memory[at(memory)].next;
  m_memory[at(memory)] = {};
  return memory;
}

void SubstepWorld::freeMemory(std::int32_t memory) {
  m_memory[at(memory)].next = m_free_memory;
  m_free_memory = memory;
}

void SubstepWorld::dropMemory(Pair& pair) {
  for (std::int32_t i = pair.first; i >= 0;) {
    const std::int32_t next = m_memory[at(i)].next;
    freeMemory(i);
    i = next;
  }
  pair.first = -1;
}

void SubstepWorld::endPair(Pair& pair) {
  if (pair.is_touching && m_bodies[at(pair.a)].exists && m_bodies[at(pair.b)].exists) {
    m_events.push_back({m_time, pair.low, pair.high, false, 0, {}});
  }
  pair.is_touching = pair.is_pushing = false;
}

std::vector<SubstepWorld::Pair>::const_iterator SubstepWorld::findPair(std::int32_t one,
                                                                       std::int32_t other) const {
  const auto key = std::minmax(one, other);
  const auto found = std::lower_bound(m_pairs.begin(), m_pairs.end(), key, [](const Pair& p, const auto& k) {
    return std::tie(p.low, p.high) < std::tie(k.first, k.second);
  });
  return found != m_pairs.end() && found->low == key.first && found->high == key.second ? found
                                                                                        : m_pairs.end();
}

void SubstepWorld::wakeChanged() {
  if (m_changed.empty()) return;
  const auto wakeBoth = [&](std::int32_t a, std::int32_t b) {
    if (!m_bodies[at(a)].is_changed && !m_bodies[at(b)].is_changed) return;
    for (const std::int32_t id : {a, b}) wakeRing(id), forgetBeside(id);
  };
  for (const Pair& pair : m_pairs) {
    if (pair.first >= 0) wakeBoth(pair.a, pair.b);
  }
  m_joints.visitWorking([&](int a, int b) {
    if (a >= 0) wakeBoth(a, b);
  });
}

void SubstepWorld::updatePairs() {
  const std::span<const BroadPhasePair> found = m_broad.updatePairs();
  m_pairs.swap(m_pairs_before);
  m_pairs.clear();
  reserveFor(m_pairs, found.size());
  auto old = m_pairs_before.begin();
  const auto drop = [&] {
    endPair(*old);
    dropMemory(*old++);
  };
  for (const BroadPhasePair& pair : found) {
    const auto low = static_cast<std::int32_t>(pair.id_a), high = static_cast<std::int32_t>(pair.id_b);
    while (old != m_pairs_before.end() && std::tie(old->low, old->high) < std::tie(low, high)) drop();
    const bool is_new = old == m_pairs_before.end() || old->low != low || old->high != high;
    if (is_new) {
      const bool in_order = m_bodies[at(low)].order < m_bodies[at(high)].order;
      m_pairs.push_back({low, high, in_order ? low : high, in_order ? high : low});
    } else {
      m_pairs.push_back(*old++);
    }
    Pair& now = m_pairs.back();
    now.is_seen = false;
    if (m_time == 0) now.event = -1;
    if (is_new || m_joints_changed) now.is_jointed = m_joints.keepsApart(low, high);
  }
  while (old != m_pairs_before.end()) drop();
  m_joints_changed = false;
  if (m_forgotten.empty()) return;
  const auto forgetPair = [this](Pair& pair) {
    dropMemory(pair);
    for (const std::int32_t id : {pair.a, pair.b}) m_bodies[at(id)].pushed_at = -1, m_bodies[at(id)].push = 0;
  };
  applyForget(
      m_pairs, [this](int id) { return isMovable(m_bodies[at(id)]); }, forgetPair);
}

// Updates the manifold's gaps. True if the bodies hardly moved relative to each other since it was found.
bool SubstepWorld::keepsManifold(Memory& memory, const SubstepBody& a, const SubstepBody& b, Vec2 offset,
                                 double margin) {
  const double most = kKept * std::min(a.thickness, b.thickness);
  if (margin > memory.margin + most || memory.version_a != a.version || memory.version_b != b.version)
    return false;
  const Vec2 moved = offset - memory.offset;
  const auto turnSince = [](Rotation before, Rotation now) { return before.c * now.s - before.s * now.c; };
  const double turn_a = turnSince(memory.rotation_a, a.body.rotation);
  const double turn_b = turnSince(memory.rotation_b, b.body.rotation);
  const double roll = std::fabs(turn_a) * a.reach + std::fabs(turn_b) * b.reach;
  if (!(lengthSquared(moved) <= most * most && roll <= most)) return false;
  for (std::int32_t k = 0; k < memory.manifold.count; ++k) {
    ManifoldPoint& point = memory.manifold.points[at(k)];
    const Vec2 apart = moved + cross(turn_b, point.anchor_b) - cross(turn_a, point.anchor_a);
    point.separation = memory.gap[at(k)] + dot(memory.manifold.normal, apart);
  }
  return true;
}

// Returns the known impulses of the old points whose ids (made of the touching corners) also occur in `now`.
KnownImpulses SubstepWorld::carriedOver(const Memory& memory, const Manifold& now) {
  KnownImpulses known;
  for (std::int32_t k = 0; k < now.count; ++k) {
    for (std::int32_t l = 0; l < memory.manifold.count; ++l) {
      if (memory.manifold.points[at(l)].id != now.points[at(k)].id) continue;
      known.normal[at(k)] = memory.known.normal[at(l)];
      known.friction[at(k)] = memory.known.friction[at(l)];
    }
  }
  return known;
}

// Makes or updates the contact of two shapes. Returns false, and frees it, if the gap exceeds the margin.
bool SubstepWorld::findManifold(std::int32_t& memory, SubstepBody& a, SubstepBody& b, std::int32_t shape_a,
                                std::int32_t shape_b, Vec2 offset) {
  const double margin = marginOf(a, b);
  if (memory >= 0 && keepsManifold(m_memory[at(memory)], a, b, offset, margin)) return true;
  const ReferenceFace kept = memory >= 0 ? m_memory[at(memory)].manifold.reference : ReferenceFace{};
  Manifold manifold;
  turnShapes(a);
  turnShapes(b);
  if (!collide(turnedShape(a, shape_a), turnedShape(b, shape_b), offset, margin, kept, manifold, true)) {
    if (memory >= 0) freeMemory(memory);
    return false;
  }
  if (memory < 0) memory = makeMemory();
  Memory& found = m_memory[at(memory)];
  found.shape_a = shape_a, found.shape_b = shape_b;
  found.known = carriedOver(found, manifold);
  found.manifold = manifold;
  found.offset = offset;
  found.rotation_a = a.body.rotation, found.rotation_b = b.body.rotation;
  found.gap = {manifold.points[0].separation, manifold.points[1].separation};
  found.margin = margin;
  found.version_a = a.version, found.version_b = b.version;
  return true;
}

// Returns a lower bound of the distance. Uses the faces of a much larger body, as its box is mostly empty.
double SubstepWorld::gapOf(SubstepBody& a, SubstepBody& b, Vec2 offset) {
  const double gap = gapBetween(a.box, b.box, offset);
  const bool is_a_large = a.reach > kLarge * b.reach;
  if (!is_a_large && b.reach <= kLarge * a.reach) return gap;
  SubstepBody& large = is_a_large ? a : b;
  const Vec2 to_small = is_a_large ? offset : -offset;
  turnShapes(large);
  double nearest = kEverywhere;
  const std::vector<ConvexShape>& shapes = m_forms[large.form].shapes;
  for (std::int32_t k = 0; k < static_cast<std::int32_t>(shapes.size()); ++k) {
    const double reach = (is_a_large ? b : a).reach;
    nearest = std::min(nearest, std::max(gap, faceGap(turnedShape(large, k), to_small, reach)));
  }
  return nearest;
}

// Returns the distance of two bodies up to which their contacts are searched.
double SubstepWorld::marginOf(const SubstepBody& a, const SubstepBody& b) const {
  const double full = a.margin + b.margin;
  if (a.is_busy && b.is_busy) return std::min(full, calmMargin(a, b) + kPushedAgain * (a.push + b.push));
  return std::min(full, calmMargin(a, b) + m_deviations[at(a.state)] + m_deviations[at(b.state)]);
}

void SubstepWorld::stir(const SubstepBody& b, double by) {
  if (!(by > 0) || b.state == 0 || !isMovable(b)) return;
  double& own = m_deviations[at(m_sets.rootOf(b.state))];
  m_has_stirred = m_has_stirred || own < by;
  own = std::max(own, by);
}

// True if two bodies may touch in this step. Pairs that touch only if pushed are decided later (m_calm).
bool SubstepWorld::mayMeet(Pair& pair) {
  SubstepBody &a = m_bodies[at(pair.a)], &b = m_bodies[at(pair.b)];
  const bool is_met = a.state > 0 || b.state > 0 || a.is_changed || b.is_changed;
  if (!is_met || (!isMovable(a) && !isMovable(b))) return false;
  const Vec2 offset = b.body.place - a.body.place;
  if (a.is_busy && b.is_busy) {  // such pairs mostly touch, so the boxes are a sufficient test
    const double margin = marginOf(a, b);
    if (gapBetween(a.box, b.box, offset) > margin) return false;
    // Bodies stay within the circles around their centres at any rotation.
    if (length(offset) > margin - a.roll - b.roll + a.reach + b.reach) return false;
    const bool are_slow = a.margin <= kSlowMargin * a.thickness && b.margin <= kSlowMargin * b.thickness;
    const double by = are_slow ? 0 : reboundOf(a, b) * calmMargin(a, b);
    stir(a, by);
    stir(b, by);
    return true;
  }
  const double gap = gapOf(a, b, offset);
  if (gap > a.margin + b.margin) return false;
  // Bodies stay within the circles around their centres at any rotation.
  const double rolled = calmMargin(a, b), straight = rolled - a.roll - b.roll;
  const double nearer = std::min(rolled - gap, straight + a.reach + b.reach - length(offset));
  if (nearer < 0) {
    m_calm.push_back({nearer, static_cast<std::int32_t>(&pair - m_pairs.data())});
    return false;
  }
  const double by = std::max({deviationOf(a), deviationOf(b), reboundOf(a, b) * rolled});
  unite(a, b);
  stir(a, by);
  stir(b, by);
  return true;
}

// Chooses the pairs that may touch. Bodies that fall or fly together do not, at any speed. A body that may
// touch another one may be pushed off its path, by a distance that depends on their relative speed, with all
// bodies that it touches. Pairs within that distance may touch as well, and so on.
void SubstepWorld::choosePairs() {
  m_calm.clear();
  m_deviations.assign(m_states.size(), 0);
  m_sets.reset(m_states.size());
  for (Pair& pair : m_pairs) pair.is_examined = !pair.is_jointed && mayMeet(pair);
  passStirsOn();
  for (const Calm& calm : m_calm) m_pairs[at(calm.pair)].is_examined = isReached(calm);
}

// Like choosePairs(), for bodies that have just woken, whose states are those from `first_state` on. Examines
// only their pairs (m_woken_pairs), and adds the pairs that deviations can reach now.
void SubstepWorld::choosePairsOfWoken(std::size_t first_state) {
  const auto isOfWoken = [&](const Calm& calm) {
    const Pair& pair = m_pairs[at(calm.pair)];
    return at(std::max(m_bodies[at(pair.a)].state, m_bodies[at(pair.b)].state)) >= first_state;
  };
  std::erase_if(m_calm, isOfWoken);
  m_deviations.resize(m_states.size(), 0);
  m_sets.extend(m_states.size());
  for (const std::int32_t i : m_woken_pairs) {
    Pair& pair = m_pairs[at(i)];
    pair.is_examined = !pair.is_jointed && mayMeet(pair);
  }
  passStirsOn();
  for (const Calm& calm : m_calm) {
    bool& is_examined = m_pairs[at(calm.pair)].is_examined;
    if (is_examined || !isReached(calm)) continue;
    is_examined = true;
    m_woken_pairs.push_back(calm.pair);
  }
  std::sort(m_woken_pairs.begin(), m_woken_pairs.end());
}

bool SubstepWorld::isReached(const Calm& calm) const {
  const Pair& pair = m_pairs[at(calm.pair)];
  return calm.nearer +
             (m_deviations[at(m_bodies[at(pair.a)].state)] + m_deviations[at(m_bodies[at(pair.b)].state)]) >=
         0;
}

// Spreads deviations (m_deviations) to touching bodies, alternately forwards and backwards over the pairs,
// because a row of bodies may be listed in either order.
void SubstepWorld::passStirsOn() {
  m_joints.visitWorking([&](int a, int b) {
    if (a >= 0) stir(m_bodies[at(a)], kEverywhere);
    stir(m_bodies[at(b)], kEverywhere);
  });
  const auto pass = [this](const Calm& calm) {
    const Pair& pair = m_pairs[at(calm.pair)];
    const SubstepBody &a = m_bodies[at(pair.a)], &b = m_bodies[at(pair.b)];
    stir(b, deviationOf(a) + calm.nearer);
    stir(a, deviationOf(b) + calm.nearer);
  };
  m_has_stirred = !m_calm.empty();
  for (int sweep = 0; std::exchange(m_has_stirred, false); ++sweep) {
    if (sweep == kMaxSweeps) return m_deviations.assign(m_deviations.size(), kEverywhere);
    ++m_counters.sweeps;
    if (sweep % 2 == 0) {
      std::for_each(m_calm.begin(), m_calm.end(), pass);
    } else {
      std::for_each(m_calm.rbegin(), m_calm.rend(), pass);
    }
  }
  for (std::size_t i = 1; i < m_deviations.size(); ++i)
    m_deviations[i] = m_deviations[at(m_sets.rootOf(static_cast<int>(i)))];
}

void SubstepWorld::updatePair(std::int32_t index) {
  Pair& pair = m_pairs[at(index)];
  if (pair.is_seen) return;
  if (!pair.is_examined && pair.first < 0 && !pair.is_touching) return;
  SubstepBody &a = m_bodies[at(pair.a)], &b = m_bodies[at(pair.b)];
  const bool is_met = a.state > 0 || b.state > 0 || a.is_changed || b.is_changed;
  if (!is_met || (!isMovable(a) && !isMovable(b))) return;
  pair.is_seen = true;
  const Vec2 offset = b.body.place - a.body.place;
  if (!pair.is_examined) {
    endPair(pair);
    dropMemory(pair);
    return;
  }
  const double linger = kLinger * std::min(a.thickness, b.thickness);
  bool is_near = false;
  double deepest = 0;
  std::int32_t old = pair.first, last = -1;
  pair.first = -1;
  const auto shapes_a = static_cast<std::int32_t>(m_forms[a.form].shapes.size());
  const auto shapes_b = static_cast<std::int32_t>(m_forms[b.form].shapes.size());
  for (std::int32_t i = 0; i < shapes_a; ++i) {
    for (std::int32_t j = 0; j < shapes_b; ++j) {
      std::int32_t memory = -1;
      if (old >= 0 && m_memory[at(old)].shape_a == i && m_memory[at(old)].shape_b == j) {
        memory = old;
        old = m_memory[at(old)].next;
      }
      if (!findManifold(memory, a, b, i, j, offset)) continue;
      (last >= 0 ? m_memory[at(last)].next : pair.first) = memory;
      last = memory;
      Memory& known = m_memory[at(memory)];
      known.next = -1;
      Contact& contact = m_contacts.emplace_back();
      contact.pair = index, contact.memory = memory;
      contact.a = pair.a, contact.b = pair.b;
      for (std::int32_t k = 0; k < known.manifold.count; ++k) {
        const ManifoldPoint& point = known.manifold.points[at(k)];
        is_near = is_near || point.separation <= linger;
        deepest = std::max(deepest, -point.separation);
      }
    }
  }
  if (pair.is_pushing && deepest > kSunk * std::min(a.thickness, b.thickness) && isOverloaded(a, b)) {
    ++m_counters.sunk;
  }
  if (!is_near && !pair.is_pushing) endPair(pair);
  pair.is_pushing = false;
  m_deepest = std::max(m_deepest, deepest);
  if (pair.first >= 0) shake(a, b, deepest);
}

// Marks both bodies as shaken, unless they are slow relative to each other and overlap little.
void SubstepWorld::shake(SubstepBody& a, SubstepBody& b, double depth) {
  const double thickness = std::min(a.thickness, b.thickness);
  if (depth < kCalmDepth * thickness && speedBetween(a, b) < kCalm * thickness) return;
  a.is_shaken = a.is_shaken || isMovable(a);
  b.is_shaken = b.is_shaken || isMovable(b);
}

// Wakes the body and its group, if it sleeps. begin() must follow for what this adds to m_active.
void SubstepWorld::wakeInStep(std::int32_t id) {
  if (!m_bodies[at(id)].is_asleep) return;
  int member = id;
  do {
    m_active.push_back(member);
    member = m_bodies[at(member)].ring;
  } while (member != id);
  wakeRing(id);
}

// Wakes the sleeping bodies of contacts from `first_contact` on, with their groups. True if any woke.
bool SubstepWorld::wakeTouched(std::size_t first_contact) {
  const std::size_t before = m_active.size();
  for (std::size_t i = first_contact; i < m_contacts.size(); ++i) {
    wakeInStep(m_contacts[i].a);
    wakeInStep(m_contacts[i].b);
  }
  for (std::size_t i = before; i < m_active.size(); ++i) begin(m_active[i]);
  return m_active.size() > before;
}

// Lists each pair of these bodies once in m_woken_pairs.
void SubstepWorld::listPairsOf(std::span<const std::int32_t> bodies) {
  if (m_pair_ends.empty()) {
    m_pair_ends.assign(m_bodies.size() + 1, 0);
    for (const Pair& pair : m_pairs) ++m_pair_ends[at(pair.a)], ++m_pair_ends[at(pair.b)];
    std::partial_sum(m_pair_ends.begin(), m_pair_ends.end(), m_pair_ends.begin());
    m_pair_numbers.resize(2 * m_pairs.size());
    for (std::int32_t i = static_cast<std::int32_t>(m_pairs.size()); i-- > 0;) {
      for (const std::int32_t id : {m_pairs[at(i)].a, m_pairs[at(i)].b})
        m_pair_numbers[at(--m_pair_ends[at(id)])] = i;
    }
  }
  m_woken_pairs.clear();
  for (const std::int32_t id : bodies) {
    const auto numbers = m_pair_numbers.begin();
    m_woken_pairs.insert(m_woken_pairs.end(), numbers + m_pair_ends[at(id)],
                         numbers + m_pair_ends[at(id + 1)]);
  }
  std::sort(m_woken_pairs.begin(), m_woken_pairs.end());
  m_woken_pairs.erase(std::unique(m_woken_pairs.begin(), m_woken_pairs.end()), m_woken_pairs.end());
}

// Repeats the update until no more bodies wake, because a woken body may wake others.
void SubstepWorld::updateContacts() {
  m_contacts.clear();
  m_deepest = 0;
  reserveFor(m_contacts, m_pairs.size());
  reserveFor(m_memory, m_pairs.size());
  m_pair_ends.clear();
  const std::size_t awake = m_active.size();
  choosePairs();
  for (std::size_t i = 0; i < m_pairs.size(); ++i) {
    if (i + kFetched < m_pairs.size() && m_pairs[i + kFetched].first >= 0)
      fetchLines(&m_memory[at(m_pairs[i + kFetched].first)], sizeof(Memory));
    updatePair(static_cast<std::int32_t>(i));
  }
  for (std::size_t first = 0;;) {
    const std::size_t active = m_active.size(), states = m_states.size();
    if (!wakeTouched(first)) break;
    first = m_contacts.size();
    listPairsOf(std::span(m_active).subspan(active));
    choosePairsOfWoken(states);
    for (const std::int32_t i : m_woken_pairs) updatePair(i);
  }
  const bool have_woken = m_active.size() > awake;
  if (have_woken) sortActive();
  for (const std::int32_t id : m_changed) {
    m_bodies[at(id)].is_changed = false;
    if (!m_bodies[at(id)].exists) m_free.push_back(id);
  }
  m_changed.clear();
  m_counters.contacts += static_cast<std::int64_t>(m_contacts.size());
  sequence(!m_is_shuffled && !have_woken);
}

// Sorts contacts by the order of their bodies, which may differ from the order of their ids.
void SubstepWorld::sequence(bool is_sorted) {
  m_sequence.resize(m_contacts.size());
  for (std::size_t i = 0; i < m_sequence.size(); ++i) m_sequence[i] = {0, 0, static_cast<std::int32_t>(i)};
  if (is_sorted) return;
  for (Turn& turn : m_sequence) {
    const Contact& contact = m_contacts[at(turn.contact)];
    turn.order_a = m_bodies[at(contact.a)].order;
    turn.order_b = m_bodies[at(contact.b)].order;
  }
  std::sort(m_sequence.begin(), m_sequence.end(), [](const Turn& x, const Turn& y) {
    return std::tie(x.order_a, x.order_b, x.contact) < std::tie(y.order_a, y.order_b, y.contact);
  });
}

}  // namespace naiad::physics

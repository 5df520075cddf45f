// A SubstepWorld's contacts: kept from step to step, coloured and put into rows within one.
#include <algorithm>
#include <bit>
#include <cmath>
#include <tuple>
#include <utility>

#include "physics/geometry/Reserve.h"
#include "physics/geometry/ShapeDistance.h"
#include "physics/substep/SubstepWorld.h"

namespace naiad::physics {

namespace {

// Bodies of one colour's contacts are all different, so these are solved for side by side. Contacts with what
// cannot move have colours of their own, and come last: they hold the others.
constexpr std::int32_t kColours = 64;
constexpr std::int32_t kUncoloured = 2 * kColours;  // one after the other
// In thicknesses of the thinner body.
constexpr double kMaxPush = 0.2;      // per tick: the greatest speed at which overlap is undone
constexpr double kFast = 4;           // per tick: what comes so fast is stopped at once
constexpr double kSlowMargin = 0.12;  // what moves by less throws nothing off its path
constexpr double kLinger = 0.01;      // a larger gap ends a contact
constexpr double kCalm = 0.05;        // per tick: what moves by less against each other may lie for long …
constexpr double kCalmDepth = 0.1;    // … if it overlaps by less
constexpr double kKept = 0.005;  // by how much bodies move against each other before they are looked at again
constexpr std::size_t kFetched = 8;     // contacts ahead
constexpr std::size_t kCacheLine = 64;  // bytes
constexpr std::size_t kFetchedOfBody = 5 * kCacheLine;
// In what acceleration adds to a speed in a tick: slower impacts do not bounce.
constexpr float kRest = 2;
constexpr double kPushedAgain = 0.5;   // of what pushed a body in the last step: it may again
constexpr double kEverywhere = 1e300;  // metric cells
constexpr double kLarge = 4;           // times the size of another body
// Over the pairs that fly past each other. A push that has not gone all its way by then may reach all of
// them.
constexpr int kMaxSweeps = 32;

// Of any two of their points, at the start of a step.
double speedBetween(const SubstepBody& a, const SubstepBody& b) {
  return length(b.body.velocity - a.body.velocity) + std::fabs(a.body.spin) * a.reach +
         std::fabs(b.body.spin) * b.reach;
}

// Did it push in the last step, and does it only carry what lies still? What a blow drives deep into
// something is to come out fast. All springs of a body are of one kind: what lies on it would press it into
// the floor if the floor's were the weaker one.
bool isLasting(const std::array<KnownImpulse, 2>& normal, const SubstepBody& a, const SubstepBody& b) {
  return normal[0].kept + normal[1].kept > 0 && !a.is_shaken && !b.is_shaken;
}

// They are at least so far apart.
double gapBetween(const Bounds& a, const Bounds& b, Vec2 offset) {
  return std::max(std::max(offset.x + b.lower.x - a.upper.x, a.lower.x - b.upper.x - offset.x),
                  std::max(offset.y + b.lower.y - a.upper.y, a.lower.y - b.upper.y - offset.y));
}

// Of the speed at which two bodies meet: by how much the speed of the lighter one may change.
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
    for (const std::int32_t id : {a, b}) wakeRing(id);
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
}

// Brings the gaps up to date, if the bodies have hardly moved against each other since they were found.
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

// Do the two shapes touch, or nearly? Their contact is made if there is none yet, or freed.
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
  found.manifold = manifold;
  found.offset = offset;
  found.rotation_a = a.body.rotation, found.rotation_b = b.body.rotation;
  found.gap = {manifold.points[0].separation, manifold.points[1].separation};
  found.margin = margin;
  found.version_a = a.version, found.version_b = b.version;
  return true;
}

// A long body that lies aslant is far from most of what its box holds: the faces of its shapes say more.
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

// How far around two bodies their contacts are searched for.
double SubstepWorld::marginOf(const SubstepBody& a, const SubstepBody& b) const {
  const double full = a.margin + b.margin;
  if (a.is_busy && b.is_busy) return std::min(full, calmMargin(a, b) + kPushedAgain * (a.push + b.push));
  return std::min(full, calmMargin(a, b) + m_stirs[at(a.state)] + m_stirs[at(b.state)]);
}

void SubstepWorld::stir(const SubstepBody& b, double by) {
  if (b.state == 0 || !isMovable(b)) return;
  double& own = m_stirs[at(m_sets.rootOf(b.state))];
  m_has_stirred = m_has_stirred || own < by;
  own = std::max(own, by);
}

// May they meet in this step? If they do as soon as one is pushed, that is put off.
bool SubstepWorld::mayMeet(Pair& pair) {
  SubstepBody &a = m_bodies[at(pair.a)], &b = m_bodies[at(pair.b)];
  const bool is_met = a.state > 0 || b.state > 0 || a.is_changed || b.is_changed;
  if (!is_met || (!isMovable(a) && !isMovable(b))) return false;
  const Vec2 offset = b.body.place - a.body.place;
  if (a.is_busy && b.is_busy) {  // they mostly do
    const double margin = marginOf(a, b);
    if (gapBetween(a.box, b.box, offset) > margin) return false;
    // However they turn, they stay within their circles.
    if (length(offset) > margin - a.roll - b.roll + a.reach + b.reach) return false;
    const bool are_slow = a.margin <= kSlowMargin * a.thickness && b.margin <= kSlowMargin * b.thickness;
    const double by = are_slow ? 0 : reboundOf(a, b) * calmMargin(a, b);
    stir(a, by);
    stir(b, by);
    return true;
  }
  const double gap = gapOf(a, b, offset);
  if (gap > a.margin + b.margin) return false;
  // However they turn, they stay within their circles.
  const double rolled = calmMargin(a, b), straight = rolled - a.roll - b.roll;
  const double nearer = std::min(rolled - gap, straight + a.reach + b.reach - length(offset));
  if (nearer < 0) {
    m_calm.push_back({nearer, static_cast<std::int32_t>(&pair - m_pairs.data())});
    return false;
  }
  const double by = std::max({stirOf(a), stirOf(b), reboundOf(a, b) * rolled});
  unite(a, b);
  stir(a, by);
  stir(b, by);
  return true;
}

// Bodies that fall or fly together do not meet, however fast they are. What may meet something on its own
// path may come off it, as far as the speed at which they meet says, and with it all that it touches; that is
// how far around its path further ones are searched for, and then around the paths of those.
void SubstepWorld::choosePairs() {
  m_calm.clear();
  m_stirs.assign(m_states.size(), 0);
  m_sets.reset(m_states.size());
  for (Pair& pair : m_pairs) pair.is_examined = !pair.is_jointed && mayMeet(pair);
  m_joints.visitWorking([&](int a, int b) {
    if (a >= 0) stir(m_bodies[at(a)], kEverywhere);
    stir(m_bodies[at(b)], kEverywhere);
  });
  passStirsOn();
  for (std::size_t i = 1; i < m_stirs.size(); ++i)
    m_stirs[i] = m_stirs[at(m_sets.rootOf(static_cast<int>(i)))];
  for (const Calm& calm : m_calm) {
    Pair& pair = m_pairs[at(calm.pair)];
    const double by = m_stirs[at(m_bodies[at(pair.a)].state)] + m_stirs[at(m_bodies[at(pair.b)].state)];
    pair.is_examined = calm.nearer + by >= 0;
  }
}

// There and back: along a row the pairs stand in the order of its bodies, or in that order reversed.
void SubstepWorld::passStirsOn() {
  const auto pass = [this](const Calm& calm) {
    const Pair& pair = m_pairs[at(calm.pair)];
    const SubstepBody &a = m_bodies[at(pair.a)], &b = m_bodies[at(pair.b)];
    stir(b, stirOf(a) + calm.nearer);
    stir(a, stirOf(b) + calm.nearer);
  };
  m_has_stirred = !m_calm.empty();
  for (int sweep = 0; std::exchange(m_has_stirred, false); ++sweep) {
    if (sweep == kMaxSweeps) return m_stirs.assign(m_stirs.size(), kEverywhere);
    ++m_counters.sweeps;
    if (sweep % 2 == 0) {
      std::for_each(m_calm.begin(), m_calm.end(), pass);
    } else {
      std::for_each(m_calm.rbegin(), m_calm.rend(), pass);
    }
  }
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
        for (std::int32_t l = 0; l < known.count; ++l) {
          if (known.id[at(l)] != point.id) continue;
          contact.impulse.normal[at(k)] = known.normal[at(l)];
          contact.impulse.friction[at(k)] = known.friction[at(l)];
        }
      }
    }
  }
  if (!is_near && !pair.is_pushing) endPair(pair);
  pair.is_pushing = false;
  m_deepest = std::max(m_deepest, deepest);
  if (pair.first >= 0) shake(a, b, deepest);
}

// Do they move against each other, or overlap, so much that neither only lies there?
void SubstepWorld::shake(SubstepBody& a, SubstepBody& b, double depth) {
  const double thickness = std::min(a.thickness, b.thickness);
  if (depth < kCalmDepth * thickness && speedBetween(a, b) < kCalm * thickness) return;
  a.is_shaken = a.is_shaken || isMovable(a);
  b.is_shaken = b.is_shaken || isMovable(b);
}

// Wakes what is touched by what moves, and all that fell asleep with it. Was there any?
bool SubstepWorld::wakeTouched(std::size_t first_contact) {
  const std::size_t before = m_active.size();
  for (std::size_t i = first_contact; i < m_contacts.size(); ++i) {
    for (const std::int32_t id : {m_contacts[i].a, m_contacts[i].b}) {
      if (!m_bodies[at(id)].is_asleep) continue;
      int member = id;
      do {
        m_active.push_back(member);
        member = m_bodies[at(member)].ring;
      } while (member != id);
      wakeRing(id);
    }
  }
  for (std::size_t i = before; i < m_active.size(); ++i) begin(m_active[i]);
  if (m_active.size() == before) return false;
  std::sort(m_active.begin(), m_active.end(),
            [&](int x, int y) { return m_bodies[at(x)].order < m_bodies[at(y)].order; });
  return true;
}

// A pair of which one body wakes the other may give work to further pairs.
void SubstepWorld::updateContacts() {
  m_contacts.clear();
  m_deepest = 0;
  const auto pairs = static_cast<std::int32_t>(m_pairs.size());
  reserveFor(m_contacts, m_pairs.size());
  reserveFor(m_memory, m_pairs.size());
  bool is_sorted = !m_is_shuffled;
  for (std::size_t first = 0;;) {
    choosePairs();
    for (std::int32_t i = 0; i < pairs; ++i) updatePair(i);
    if (!wakeTouched(first)) break;
    first = m_contacts.size();
    is_sorted = false;
  }
  for (const std::int32_t id : m_changed) {
    m_bodies[at(id)].is_changed = false;
    if (!m_bodies[at(id)].exists) m_free.push_back(id);
  }
  m_changed.clear();
  m_counters.contacts += static_cast<std::int64_t>(m_contacts.size());
  sequence(is_sorted);
}

// By the order of the bodies, which may not be that of their ids.
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

void SubstepWorld::chooseColours() {
  std::array<std::int32_t, kUncoloured + 1> counts = {};
  for (const Turn& turn : m_sequence) {
    Contact& contact = m_contacts[at(turn.contact)];
    SubstepBody &a = m_bodies[at(contact.a)], &b = m_bodies[at(contact.b)];
    const bool moves_a = isMovable(a), moves_b = isMovable(b);
    if (moves_a && moves_b) {
      contact.colour = std::countr_one(a.colours | b.colours);
      const std::uint64_t bit = contact.colour < kColours ? std::uint64_t{1} << contact.colour : 0;
      a.colours |= bit;
      b.colours |= bit;
    } else {
      SubstepBody& mover = moves_a ? a : b;
      contact.colour = std::countr_one(mover.held_colours);
      mover.held_colours |= contact.colour < kColours ? std::uint64_t{1} << contact.colour : 0;
      contact.colour += contact.colour < kColours ? kColours : 0;
    }
    const bool is_coloured =
        contact.colour < kColours || (!(moves_a && moves_b) && contact.colour < kUncoloured);
    if (!is_coloured) contact.colour = kUncoloured;
    ++counts[at(contact.colour)];
  }
  std::int32_t start = 0;
  for (std::int32_t& count : counts) start += std::exchange(count, start);
  m_by_colour.resize(m_contacts.size());
  for (const Turn& turn : m_sequence) {
    m_by_colour[at(counts[at(m_contacts[at(turn.contact)].colour)]++)] = turn.contact;
  }
}

// Contacts of a colour lie all over the memory: what they are made of is on its way while others are filled
// in.
void SubstepWorld::fetch(const Contact& contact) const {
  const auto fetchAll = [](const auto& object) {
    for (std::size_t i = 0; i < sizeof object; i += kCacheLine) {
      __builtin_prefetch(reinterpret_cast<const char*>(&object) + i);
    }
  };
  fetchAll(m_memory[at(contact.memory)].manifold);
  for (const std::int32_t id : {contact.a, contact.b}) {
    const auto* p_body = reinterpret_cast<const char*>(&m_bodies[at(id)]);
    for (std::size_t i = 0; i < kFetchedOfBody; i += kCacheLine) __builtin_prefetch(p_body + i);
  }
}

void SubstepWorld::fillRows() {
  m_rows.clear(m_by_colour.size(), m_h);
  std::int32_t colour = -1;
  std::size_t in_block = 0;
  for (std::size_t turn = 0; turn < m_by_colour.size(); ++turn) {
    if (turn + kFetched < m_by_colour.size()) fetch(m_contacts[at(m_by_colour[turn + kFetched])]);
    Contact& contact = m_contacts[at(m_by_colour[turn])];
    if (contact.colour != colour || in_block == kLanes || colour == kUncoloured) {
      m_rows.beginBlock();
      in_block = 0;
      colour = contact.colour;
    }
    ++in_block;
    const SubstepBody &a = m_bodies[at(contact.a)], &b = m_bodies[at(contact.b)];
    ContactRow row;
    row.a = a.state, row.b = b.state;
    row.inverse_mass_a = a.inverse_mass;
    row.inverse_mass_b = b.inverse_mass;
    row.inverse_inertia_a = a.inverse_inertia;
    row.inverse_inertia_b = b.inverse_inertia;
    row.velocity = b.body.velocity - a.body.velocity;
    row.spin_a = static_cast<float>(a.body.spin), row.spin_b = static_cast<float>(b.body.spin);
    row.friction = static_cast<float>(std::sqrt(a.body.friction * b.body.friction));
    row.restitution = static_cast<float>(std::max(a.body.restitution, b.body.restitution));
    row.max_push = static_cast<float>(kMaxPush * std::min(a.thickness, b.thickness));
    row.is_held = !isMovable(a) || !isMovable(b);
    row.is_lasting = isLasting(contact.impulse.normal, a, b);
    row.fast = static_cast<float>((row.is_lasting ? kCalm : kFast) * std::min(a.thickness, b.thickness));
    const auto gain = [&](const SubstepBody& of) {
      return of.state > 0 ? std::fabs(of.kick.x) + std::fabs(of.kick.y) : 0.0f;
    };
    row.rest = kRest / m_h * std::max(gain(a), gain(b));
    contact.place = m_rows.add(row, m_memory[at(contact.memory)].manifold, contact.impulse);
  }
  m_counters.blocks += static_cast<std::int64_t>(m_rows.blocks());
}

void SubstepWorld::storeContacts() {
  for (const Contact& contact : m_contacts) {
    const ContactImpulse impulse = m_rows.impulse(contact.place);
    Memory& known = m_memory[at(contact.memory)];
    known.count = known.manifold.count;
    for (std::int32_t k = 0; k < known.count; ++k) {
      known.id[at(k)] = known.manifold.points[at(k)].id;
      known.normal[at(k)] = impulse.normal[at(k)];
      known.friction[at(k)] = impulse.friction[at(k)];
    }
    if (impulse.first < 0) continue;
    Pair& pair = m_pairs[at(contact.pair)];
    pair.is_pushing = true;
    m_bodies[at(pair.a)].pushed_at = m_bodies[at(pair.b)].pushed_at = m_steps;
    if (pair.event >= 0) m_events[at(pair.event)].impulse += double{impulse.total};
    if (pair.is_touching) continue;
    pair.is_touching = true;
    pair.event = static_cast<std::int32_t>(m_events.size());
    const Vec2 normal = pair.a == pair.low ? known.manifold.normal : -known.manifold.normal;
    m_events.push_back({m_time + std::max(double{impulse.first}, 0.0), pair.low, pair.high, true,
                        double{impulse.total}, normal});
  }
}

}  // namespace naiad::physics

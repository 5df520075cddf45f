// Contacts of a SubstepWorld as rows: divides them into colours and batches, fills rows, stores the results.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <utility>

#include "physics/substep/Fetch.h"
#include "physics/substep/SubstepWorld.h"

namespace naiad::physics {

namespace {

// Contacts of one colour have no movable body in common, so they are solved in parallel. Contacts with
// immovable bodies have their own colours, which are solved last, because they hold the other bodies.
constexpr std::int32_t kColours = 64;
constexpr std::int32_t kUncoloured = 2 * kColours;  // without a colour: solved one after the other
constexpr std::size_t kBatch = 1024;                // rows in a batch (230 kB), unless one group has more
// Speeds in units of the thinner body's thickness per tick.
constexpr double kMaxPush = 0.2;  // maximum speed at which overlap is undone
constexpr double kFast = 4;       // approaches faster than this are stopped at once
constexpr std::size_t kFetchedOfBody = 5 * kCacheLine;
// Slower impacts do not bounce; in units of the speed that acceleration adds in a tick.
constexpr float kRest = 2;

// True if the contact pushed in the last step and neither body is shaken, because a body that a blow drove
// deep into another must leave it fast. All contacts of a shaken body have one softness. Otherwise a
// load would press the body into the floor if the floor's contact were softer.
bool isLasting(const KnownImpulses& known, const SubstepBody& a, const SubstepBody& b) {
  return known.normal[0].kept + known.normal[1].kept > 0 && !a.is_shaken && !b.is_shaken;
}

}  // namespace

void SubstepWorld::chooseColours() {
  m_sets.reset(m_states.size());
  m_energy.begin(m_states.size());
  m_driven.clear();
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
      m_energy.hold(mover.state);
      if (a.state > 0 && b.state > 0) m_driven.emplace_back(a.state, b.state);
    }
    const bool is_coloured =
        contact.colour < kColours || (!(moves_a && moves_b) && contact.colour < kUncoloured);
    if (!is_coloured) contact.colour = kUncoloured;
    contact.state = std::max(a.state, b.state);
    if (!moves_a || !moves_b) continue;
    m_energy.watch(a.state);
    m_energy.watch(b.state);
    if (a.state > 0 && b.state > 0) m_sets.unite(a.state, b.state);
  }
  m_joints.visitLinks([this](int a, int b) {
    if (a >= 0) unite(m_bodies[at(a)], m_bodies[at(b)]);
  });
}

// Divides contacts into batches, each with all bodies that touch one of its kinematic ones; only one if there
// are joints or magnets, which are not listed by group.
void SubstepWorld::chooseBatches() {
  m_batches.assign(1, {});
  m_batch_of.assign(m_states.size(), 0);
  m_by_batch.resize(m_states.size() - 1);
  if (m_contacts.size() > kBatch && m_joints.isEmpty() && m_magnets.empty()) {
    if (!m_driven.empty()) m_batch_sets = m_sets;
    for (const auto& [a, b] : m_driven) m_batch_sets.unite(a, b);
    UnionFind& sets = m_driven.empty() ? m_sets : m_batch_sets;
    m_turn_counts.assign(m_states.size(), 0);  // number of contacts, by root
    for (const Contact& contact : m_contacts) ++m_turn_counts[at(sets.rootOf(contact.state))];
    std::size_t rows = 0;
    for (std::size_t state = 1; state < m_states.size(); ++state) {
      const std::size_t root = at(sets.rootOf(static_cast<int>(state)));
      if (root == state && rows > 0 && rows + m_turn_counts[root] > kBatch) {
        m_batches.emplace_back();
        rows = 0;
      }
      if (root == state) rows += m_turn_counts[root];
      m_batch_of[state] = root == state ? static_cast<std::int32_t>(m_batches.size()) - 1 : m_batch_of[root];
    }
  }
  sortByBatch();
}

void SubstepWorld::sortByBatch() {
  constexpr std::size_t kTurns = kUncoloured + 1;  // number of colours of a batch
  m_turn_counts.assign(m_batches.size() * kTurns, 0);
  const auto turnOf = [&](const Contact& contact) {
    return at(m_batch_of[at(contact.state)]) * kTurns + at(contact.colour);
  };
  for (const Contact& contact : m_contacts) ++m_turn_counts[turnOf(contact)];
  std::size_t start = 0;
  for (std::size_t i = 0; i < m_turn_counts.size(); ++i) {
    const std::size_t count = std::exchange(m_turn_counts[i], start);
    start += count;
    Batch& batch = m_batches[i / kTurns];
    batch.contacts += count;
    batch.blocks += i % kTurns == kUncoloured ? count : (count + kLanes - 1) / kLanes;
  }
  m_by_colour.resize(m_contacts.size());
  for (const Turn& turn : m_sequence)
    m_by_colour[m_turn_counts[turnOf(m_contacts[at(turn.contact)])]++] = turn.contact;
  for (std::size_t state = 1; state < m_states.size(); ++state) ++m_batches[at(m_batch_of[state])].states;
  m_turn_counts.assign(1, 0);
  for (const Batch& batch : m_batches) m_turn_counts.push_back(m_turn_counts.back() + batch.states);
  for (std::size_t state = 1; state < m_states.size(); ++state)
    m_by_batch[m_turn_counts[at(m_batch_of[state])]++] = static_cast<std::int32_t>(state);
}

// Returns the contact that is kFetched turns ahead, to prefetch the data that it refers to; null at the end.
// The contact itself was prefetched earlier, because contacts of a colour are scattered in memory.
[[gnu::always_inline]] inline const SubstepWorld::Contact* SubstepWorld::contactAhead(
    std::span<const std::int32_t> contacts, std::size_t turn) const {
  const std::size_t ahead = turn + kFetched;
  if (ahead + kFetched < contacts.size())
    fetchLines(&m_contacts[at(contacts[ahead + kFetched])], sizeof(Contact));
  return ahead < contacts.size() ? &m_contacts[at(contacts[ahead])] : nullptr;
}

// Gives contacts with heavy loads on jointed bodies to the joints.
void SubstepWorld::giveLoads() {
  for (const bool is_held : {false, true}) {
    for (const Turn& turn : m_sequence) {
      Contact& contact = m_contacts[at(turn.contact)];
      const SubstepBody &a = m_bodies[at(contact.a)], &b = m_bodies[at(contact.b)];
      if ((isMovable(a) && isMovable(b)) == is_held) continue;
      const double max_push = kMaxPush * std::min(a.thickness, b.thickness);
      contact.load =
          m_joints.addLoad(m_bodies, contact.a, contact.b, m_memory[at(contact.memory)].manifold, max_push);
    }
  }
}

void SubstepWorld::addRow(Contact& contact) {
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
  if (row.is_held) {
    const SubstepBody& driver = isMovable(a) ? b : a;
    row.is_driven = driver.state > 0;
    row.driver = driver.body.velocity;
  }
  const Memory& memory = m_memory[at(contact.memory)];
  row.is_given = m_joints.solvesLoad(contact.load);
  row.is_lasting = !row.is_given && isLasting(memory.known, a, b);
  row.fast = static_cast<float>((row.is_lasting ? kCalm : kFast) * std::min(a.thickness, b.thickness));
  const auto gain = [&](const SubstepBody& of) {
    return of.state > 0 ? std::fabs(of.kick.x) + std::fabs(of.kick.y) : 0.0f;
  };
  row.rest = kRest / m_h * std::max(gain(a), gain(b));
  if (hasFrictionParts())
    row.friction = static_cast<float>(frictionOf(contact.a, contact.b, memory.manifold));
  contact.place = m_rows.add(row, memory.manifold, memory.known);
  if (row.is_given) m_joints.setPlace(contact.load, contact.place);
}

void SubstepWorld::fillRows(std::span<const std::int32_t> contacts) {
  std::int32_t colour = -1;
  std::size_t in_block = 0;
  for (std::size_t turn = 0; turn < contacts.size(); ++turn) {
    if (const Contact* const p_ahead = contactAhead(contacts, turn)) {
      fetchLines(&m_memory[at(p_ahead->memory)], offsetof(Memory, known) + sizeof(KnownImpulses));
      fetchLines(&m_bodies[at(p_ahead->a)], kFetchedOfBody);
      fetchLines(&m_bodies[at(p_ahead->b)], kFetchedOfBody);
    }
    Contact& contact = m_contacts[at(contacts[turn])];
    if (contact.colour != colour || in_block == kLanes || colour == kUncoloured) {
      if (turn > 0) m_rows.finishBlock();
      m_rows.beginBlock();
      in_block = 0;
      colour = contact.colour;
    }
    ++in_block;
    addRow(contact);
  }
  if (!contacts.empty()) m_rows.finishBlock();
  m_counters.blocks += static_cast<std::int64_t>(m_rows.blocks());
}

void SubstepWorld::storeImpulses(std::span<const std::int32_t> contacts) {
  for (std::size_t turn = 0; turn < contacts.size(); ++turn) {
    if (const Contact* const p_ahead = contactAhead(contacts, turn))
      fetchLines(&m_memory[at(p_ahead->memory)].known, sizeof(KnownImpulses));
    Contact& contact = m_contacts[at(contacts[turn])];
    contact.pushed = m_rows.read(contact.place, m_memory[at(contact.memory)].known);
  }
}

void SubstepWorld::reportContacts() {
  for (const Contact& contact : m_contacts) {
    if (contact.pushed.first < 0) continue;
    const double impulse = contact.pushed.total;
    Pair& pair = m_pairs[at(contact.pair)];
    pair.is_pushing = true;
    m_bodies[at(pair.a)].pushed_at = m_bodies[at(pair.b)].pushed_at = m_steps;
    if (pair.event >= 0) m_events[at(pair.event)].impulse += impulse;
    if (pair.is_touching) continue;
    pair.is_touching = true;
    pair.event = static_cast<std::int32_t>(m_events.size());
    const Vec2 from_a = m_memory[at(contact.memory)].manifold.normal;
    const Vec2 normal = pair.a == pair.low ? from_a : -from_a;
    m_events.push_back(
        {m_time + std::max(double{contact.pushed.first}, 0.0), pair.low, pair.high, true, impulse, normal});
  }
}

}  // namespace naiad::physics

#include "engine/world/Mover.h"

#include <bit>
#include <optional>

#include "engine/events/EventOut.h"
#include "engine/world/ClassName.h"
#include "engine/world/CollisionRule.h"
#include "engine/world/EventCollision.h"
#include "engine/world/EventDispatch.h"
#include "engine/world/Object.h"
#include "engine/world/ObjectRegistry.h"
#include "engine/world/Views.h"
#include "engine/world/WorldLog.h"
#include "engine/world/WorldState.h"
#include "engine/world/WorldStore.h"

namespace df {

namespace {

// The published engine compares floats, so a box that touches the boundary to within a float's precision is
// inside, even if exactly it is not.
[[gnu::noinline]] bool touchesAsFloats(const FixedBox& a, const FixedBox& b) {
  const auto overlap = [](Fixed a_begin, Fixed a_size, Fixed b_begin, Fixed b_size) {
    const auto begin_a = static_cast<float>(toCells(a_begin));
    const auto begin_b = static_cast<float>(toCells(b_begin));
    return begin_a <= begin_b + static_cast<float>(toCells(b_size)) &&
           begin_b <= begin_a + static_cast<float>(toCells(a_size));
  };
  return overlap(a.corner.x, a.size.x, b.corner.x, b.size.x) &&
         overlap(a.corner.y, a.size.y, b.corner.y, b.size.y);
}

}  // namespace

SweptMove::End SweptMove::run(EventDispatch& events, WorldStore& store, ObjectKey mover, FixedVector& where) {
  const FixedVector from = store.position(mover.slot);
  m_met.clear();
  Moment since;
  for (int stage = 1; store.collides(mover.slot); ++stage) {
    const SweepPath path(store.box(mover.slot), from, where);
    ++(stage == 1 ? store.moverStats().swept : store.moverStats().swept_again);
    m_list.fill(store, mover.slot, path, HitList::kBlock, since, &m_met);
    if (m_list.hits().empty()) return End::kTarget;

    const Verdict verdict = sendHits(events, store, mover, path);
    if (verdict.outcome == Outcome::kGone) return End::kNone;
    const bool is_blocked = verdict.outcome == Outcome::kBlocked;
    if (!is_blocked && !m_list.end()) return End::kTarget;
    if (is_blocked || stage == kMaxStages) {
      const FixedVector stop = path.sweep().before(is_blocked ? verdict.moment : *m_list.end());
      if (stop == from || store.position(mover.slot) != from) return End::kNone;
      where = stop;
      return End::kContact;
    }
    since = *m_list.end();
    for (const Hit& hit : m_list.hits()) m_met.insert(hit.key);
  }
  return End::kTarget;
}

// Handlers may begin other moves, which use other lists.
SweptMove::Verdict SweptMove::sendHits(EventDispatch& events, const WorldStore& store, ObjectKey mover,
                                       const SweepPath& path) {
  Verdict verdict{Outcome::kFree, {}};
  EventCollision event(store.object(mover.slot), nullptr, Vector());
  for (const Hit& hit : m_list.hits()) {
    if (verdict.outcome == Outcome::kBlocked && hit.moment > verdict.moment) break;
    if (!store.isCurrent(hit.key)) continue;
    if (store.handlesEvents(mover.slot) || store.handlesEvents(hit.key.slot)) {
      event.setObject2(store.object(hit.key.slot));
      event.setPosition(Vector::fromFixed(path.sweep().before(hit.moment)));
      if (!events.sendToBoth(mover, hit.key, event)) return {Outcome::kGone, {}};
      if (!store.isCurrent(hit.key)) continue;
    }
    if (verdict.outcome == Outcome::kBlocked) continue;
    const CollisionRule pair(store, mover.slot, hit.key.slot);
    if (pair.blocks(path.from(), path.to())) verdict = {Outcome::kBlocked, hit.moment};
  }
  return verdict;
}

Mover::Mover(ObjectRegistry& objects, Views& views, EventDispatch& events, const WorldState& state)
    : m_store(objects.store()), m_objects(objects), m_views(views), m_events(events), m_state(state) {}

void Mover::moveAll() {
  WorldStore& store = m_store;
  const WorldStore::Walk walk(store);
  for (std::size_t word = 0; word * 64 < walk.size(); ++word) {
    // Objects that enter during the update wait for the next one.
    const std::size_t left = walk.size() - word * 64;
    std::uint64_t waiting = left < 64 ? (std::uint64_t{1} << left) - 1 : ~std::uint64_t{0};
    for (std::uint64_t turns = 0; (turns = store.updateMasks().turns[word] & waiting) != 0;) {
      const int bit = std::countr_zero(turns);
      int next = bit + 1;
      if ((store.updateMasks().walkers[word] >> bit & 1) != 0 && m_depth < kMaxDepth) {
        next = moveWalkers(word, turns);
      } else if ((store.updateMasks().fliers[word] >> bit & 1) != 0) {
        next = bit + moveFliers(walk[word * 64 + static_cast<std::size_t>(bit)],
                                store.updateMasks().fliers[word] & waiting,
                                store.updateMasks().consecutive[word], bit);
      } else {
        ++store.moverStats().special;
        updateObject(store.key(walk[word * 64 + static_cast<std::size_t>(bit)]));
      }
      waiting &= next < 64 ? ~std::uint64_t{0} << next : 0;
    }
  }
}

// Moves all walkers up to the next turn of another kind, or up to a walker that would touch an Object or
// leave the world; finishes the turn of that walker, too. Returns the bit after the last turn.
int Mover::moveWalkers(std::size_t word, std::uint64_t turns) {
  WorldStore& store = m_store;
  const std::uint64_t others = turns & ~store.updateMasks().walkers[word];
  const std::uint64_t run = turns & ((others & -others) - 1);
  const int last = 63 - std::countl_zero(run);
  std::vector<ObjectKey>& met = m_lists[m_depth];
  met.clear();
  const std::uint64_t left = store.walk(word, run, flightBounds(), met);
  if (left == 0) return last + 1;
  const int bit = std::countr_zero(left);
  const ObjectKey key = store.key(store.entry(word * 64 + static_cast<std::size_t>(bit)));
  if (store.hasPrecise()) {
    filterCollisions(store, key.slot,
                     store.worldBox(key.slot, store.position(key.slot) + store.velocity(key.slot)), met);
  }
  if (met.empty()) {
    ++store.moverStats().deferred;
    updateObject(key);
  } else {
    ++store.moverStats().met;
    finishWalk(key, met);
  }
  return bit + 1;
}

// Finishes a walker's turn, given the Objects that it touches at its target.
void Mover::finishWalk(ObjectKey key, std::vector<ObjectKey>& others) {
  WorldStore& store = m_store;
  const FixedVector velocity = store.velocity(key.slot);
  const FixedVector where = store.position(key.slot) + velocity;
  ++m_depth;
  const bool free = collide(key, where, others);
  if (free) place(key, where);
  --m_depth;
  if (store.isCurrent(key)) finishUpdate(key, velocity, !free);
}

// Moves a run of fliers in consecutive slots. Returns how many turns were taken.
int Mover::moveFliers(WorldStore::Slot first, std::uint64_t fliers, std::uint64_t consecutive, int bit) {
  const std::uint64_t run = (fliers >> bit) & (consecutive >> bit | 1);
  const int count = std::countr_one(run);
  WorldStore& store = m_store;
  const auto done = static_cast<int>(store.fly(first, static_cast<std::size_t>(count), flightBounds()));
  store.moverStats().flown += static_cast<std::uint64_t>(done);
  if (done == count) return count;
  ++store.moverStats().deferred;
  updateObject(store.key(first + static_cast<WorldStore::Slot>(done)));
  return done + 1;
}

void Mover::updateObject(ObjectKey key) {
  WorldStore& store = m_store;
  const WorldStore::Slot s = key.slot;
  const FixedVector velocity = store.velocity(s);
  bool blocked = false;
  if (velocity != FixedVector{} || store.testsAtRest(s)) {
    const FixedVector where = store.position(s) + velocity;
    if (WorldStore::isPosition(where)) {
      blocked = move(key, where) != 0;
    } else {
      m_objects.log().refuse(nameOf(*store.object(s)), "the next position");
      blocked = true;
    }
    if (!store.isCurrent(key)) return;
  }
  finishUpdate(key, velocity, blocked);
}

void Mover::finishUpdate(ObjectKey key, FixedVector velocity, bool blocked) {
  WorldStore& store = m_store;
  const WorldStore::Slot s = key.slot;
  FixedVector next = store.velocity(s);
  // A handler has set another velocity: whether that is blocked is not known yet.
  if (next != velocity) blocked = false;
  const FixedVector acceleration = store.acceleration(s);
  if (acceleration != FixedVector{} && WorldStore::isVelocity(next + acceleration)) {
    next = next + acceleration;
    store.setDerived(s, true);
  }
  store.settle(s, next, blocked);
}

int Mover::moveObject(Object* p_o, Vector where) {
  if (!m_objects.owns(p_o)) {
    m_objects.log().writeOnce(
        "WM.moveObject() of " +
        std::string(p_o == nullptr ? "a null pointer" : "an Object that is not in the world (any more)"));
    return -1;
  }
  const auto target = toFixed(where);
  return target ? move(p_o->key(), *target) : m_objects.log().refuse(nameOf(*p_o), "moveObject");
}

int Mover::move(ObjectKey mover, FixedVector where) {
  if (m_depth >= kMaxDepth) return -1;
  const int depth = m_depth++;
  using End = SweptMove::End;
  End end = End::kTarget;
  const WorldStore& store = m_store;
  if (store.collides(mover.slot)) {
    if (store.isSwept(mover.slot)) {
      end = m_swept[depth].run(m_events, m_store, mover, where);
    } else if (!collideAt(mover, where, m_lists[depth])) {
      end = End::kNone;
    }
  }
  if (end != End::kNone) place(mover, where);
  --m_depth;
  return end == End::kTarget ? 0 : -1;
}

// Tests the target, not the path, and sends the collision events. Returns true if the mover may move.
bool Mover::collideAt(ObjectKey mover, FixedVector where, std::vector<ObjectKey>& others) {
  const WorldStore& store = m_store;
  const FixedBox box = store.worldBox(mover.slot, where);
  others.clear();
  if (const std::optional<bool> moves = store.touchingTarget(mover.slot, box, others)) return *moves;
  filterCollisions(store, mover.slot, box, others);
  return others.empty() || collide(mover, where, others);
}

bool Mover::collide(ObjectKey mover, FixedVector where, const std::vector<ObjectKey>& others) {
  const WorldStore& store = m_store;
  const FixedVector from = store.position(mover.slot);
  bool free = true;
  EventCollision event(store.object(mover.slot), nullptr, Vector::fromFixed(where));
  for (const ObjectKey other : others) {
    if (!store.isCurrentUnchecked(other)) continue;
    event.setObject2(store.object(other.slot));
    if (!m_events.sendToBoth(mover, other, event)) return false;
    if (!store.isCurrentUnchecked(other)) continue;
    if (CollisionRule(store, mover.slot, other.slot).blocks(from, where)) free = false;
  }
  return free;
}

void Mover::place(ObjectKey mover, FixedVector where) {
  WorldStore& store = m_store;
  const bool leaves = !isInWorld(mover.slot, where) && isInWorld(mover.slot, store.position(mover.slot));
  store.setPosition(mover.slot, where);
  if (store.has(mover.slot, WorldStore::kFollowed)) m_views.moved(mover, where);
  if (leaves) m_events.deliver(mover, EventOut());
}

// True if an Object at `where` would be inside the world, as out events define it.
bool Mover::isInWorld(std::uint32_t slot, FixedVector where) const {
  return m_state.compat ? touchesAsFloats(m_store.worldBox(slot, where), m_views.boundary())
                        : m_views.isInside(where);
}

// Returns bounds such that a move that ends inside them does not leave the world.
FixedBox Mover::flightBounds() const {
  const FixedBox& boundary = m_views.boundary();
  const bool anywhere = !m_state.compat || !m_store.hasBoxesOffPosition();
  return anywhere ? boundary : FixedBox{boundary.corner, {}};
}

}  // namespace df

#include "engine/world/SweptMove.h"

#include "engine/world/CollisionRule.h"
#include "engine/world/EventCollision.h"
#include "engine/world/EventDispatch.h"
#include "engine/world/WorldStore.h"

namespace df {

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

// A handler may begin moves of its own, but those have lists of their own.
SweptMove::Verdict SweptMove::sendHits(EventDispatch& events, const WorldStore& store, ObjectKey mover,
                                       const SweepPath& path) {
  Verdict verdict{Outcome::kFree, {}};
  EventCollision event(store.object(mover.slot), nullptr, Vector());
  for (const Hit& hit : m_list.hits()) {
    if (verdict.outcome == Outcome::kBlocked && hit.moment > verdict.moment) break;
    if (!store.isCurrent(hit.key)) continue;
    if (store.hears(mover.slot) || store.hears(hit.key.slot)) {
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

}  // namespace df

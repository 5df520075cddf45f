// Swept moves of the oracle (docs/collisions.md), tested along the whole path.
#include <algorithm>

#include "Oracle.h"

namespace oracle {

/// Returns when the move hits the other Object; nullopt if it does not.
std::optional<Time> World::hitTime(const Object* p_o, const SweepPath& path, const Object* p_other) {
  const FixedBox others = p_other->getWorldBox(p_other->position);
  // A quick test first, because most Objects are far away.
  const FixedBox& box = p_o->box;
  if (others.corner.x > std::max(path.from.x, path.to.x) + box.corner.x + box.size.x ||
      others.corner.y > std::max(path.from.y, path.to.y) + box.corner.y + box.size.y ||
      others.corner.x + others.size.x < std::min(path.from.x, path.to.x) + box.corner.x ||
      others.corner.y + others.size.y < std::min(path.from.y, path.to.y) + box.corner.y) {
    return std::nullopt;
  }
  if (!isPrecise(p_o, p_other)) return firstTouch(path, box, others);

  const auto time = firstShare(path, box, p_o->mask, others, p_other->mask);
  ++m_counters.precise_pairs;
  if (!time) ++m_counters.precise_rejected;
  return time;
}

/// Returns all hits of the move, sorted by time; equal times are in creation order.
World::HitList World::getHits(const Object* p_o, const SweepPath& path) {
  HitList hits;
  if (!p_o->active || !p_o->isSolid()) return hits;
  for (Object* p_other : m_updates) {
    if (p_other == p_o || !p_other->active || !p_other->isSolid()) continue;
    if (const auto time = hitTime(p_o, path, p_other)) hits.push_back({p_other, *time});
  }
  std::stable_sort(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) { return a.time < b.time; });
  return hits;
}

/// Drops the hits after the first that blocks in the present state. Returns whether one blocks.
bool World::cutAtFirstBlock(HitList& hits, const Object* p_o, const SweepPath& path) const {
  const auto blocks = [&](const Hit& hit) {
    const Verdict verdict = judge(p_o, hit.p_other, path);
    return verdict == Verdict::HARD_BLOCK || verdict == Verdict::SOFT_BLOCK;
  };
  const auto first = std::find_if(hits.begin(), hits.end(), blocks);
  if (first == hits.end()) return false;
  const Time time = first->time;
  std::erase_if(hits, [&](const Hit& hit) { return time < hit.time; });
  return true;
}

int World::moveSwept(Object* p_o, const SweepPath& path) {
  ++m_counters.swept_moves;
  ObjectList met;
  Time begin;
  bool met_soft = false;
  for (bool last_stage = false; !last_stage;) {
    // The list is fixed before the first event.
    HitList hits = getHits(p_o, path);
    std::erase_if(hits, [&](const Hit& hit) {
      return hit.time < begin || std::find(met.begin(), met.end(), hit.p_other) != met.end();
    });
    last_stage = !cutAtFirstBlock(hits, p_o, path);
    if (!last_stage) begin = hits.back().time;

    std::optional<Time> blocked;
    for (const Hit& hit : hits) {
      if (blocked && *blocked < hit.time) break;  // the mover stops before this hit
      if (hit.p_other->gone) continue;
      met.push_back(hit.p_other);
      if (!met_soft && (p_o->solidness == df::SOFT || hit.p_other->solidness == df::SOFT)) {
        met_soft = true;
        ++m_counters.met_soft;
      }
      sendToBoth(p_o, hit.p_other, path.before(hit.time));
      if (p_o->gone) return -1;
      if (hit.p_other->gone) continue;

      const Verdict verdict = judge(p_o, hit.p_other, path);
      if (verdict == Verdict::MOVES_OUT) ++m_counters.moved_out;
      if (verdict != Verdict::HARD_BLOCK && verdict != Verdict::SOFT_BLOCK) continue;
      if (!blocked) ++(verdict == Verdict::HARD_BLOCK ? m_counters.blocked_hard : m_counters.blocked_soft);
      if (!blocked) blocked = hit.time;
    }

    if (blocked) {  // the mover stops just before the hit, unless a handler has moved it
      ++m_counters.swept_blocked;
      if (p_o->position != path.from) return -1;
      if (path.before(*blocked) != path.from) ++m_counters.swept_stopped;
      place(p_o, path.before(*blocked));
      return -1;
    }
    // The blocking Object may be gone: search the rest of the path in the world as it is now.
    if (!last_stage) ++m_counters.swept_passed_on;
  }
  place(p_o, path.to);
  return 0;
}

/// Returns the first hit that a swept move to `where` would find.
Contact World::firstContact(const Object* p_o, FixedVector where) {
  const SweepPath path{p_o->position, where};
  const HitList hits = getHits(p_o, path);
  if (hits.empty()) return {nullptr, {1, 1}, where};
  return {hits.front().p_other, hits.front().time, path.before(hits.front().time)};
}

}  // namespace oracle

// Moves of the oracle's Objects: the book's moveObject() and the rules that block a move.
#include "Oracle.h"

namespace oracle {

// Listings 4.109, 4.111 and 4.113.
int World::moveNow(Object* p_o, FixedVector where) {
  if (!p_o->active) {  // an inactive Object does not collide and gets no events
    p_o->position = where;
    return 0;
  }
  const SweepPath path{p_o->position, where};
  if (p_o->isSolid()) {
    if (p_o->options.swept || m_swept_collisions) return moveSwept(p_o, path);
    if (!moveAtOnce(p_o, path)) return -1;
  }
  place(p_o, where);  // nothing blocks the move
  return 0;
}

// Functions for a pair of Objects.

/// Sends the event to both Objects. Either handler may delete either Object.
void World::sendToBoth(Object* p_o, Object* p_other, FixedVector where) {
  ++m_counters.collisions;
  if (p_o->active) m_handlers.collision(p_o, p_o, p_other, where);
  if (p_o->gone || p_other->gone) return;
  if (p_other->active) m_handlers.collision(p_other, p_o, p_other, where);
}

/// Returns whether the other Object blocks the mover, in their present state.
World::Verdict World::judge(const Object* p_o, const Object* p_other, const SweepPath& path) const {
  // If both are HARD, the mover cannot move.
  const bool hard_block = p_o->solidness == df::HARD && p_other->solidness == df::HARD;
  // A mover with no_soft cannot move onto SOFT.
  const bool soft_block = p_o->no_soft && p_other->solidness == df::SOFT;
  if (!hard_block && !soft_block) return Verdict::PASSES;

  if (p_o->options.may_move_out) {
    const FixedBox at_start = p_o->getWorldBox(path.from);
    const FixedBox at_end = p_o->getWorldBox(path.to);
    const FixedBox others = p_other->getWorldBox(p_other->position);
    if (boxIntersectsBox(at_start, others) && gap(at_end, others) > gap(at_start, others))
      return Verdict::MOVES_OUT;
  }
  return hard_block ? Verdict::HARD_BLOCK : Verdict::SOFT_BLOCK;
}

bool World::isPrecise(const Object* p_o, const Object* p_other) const {
  return p_o->options.precise || p_other->options.precise;
}

bool World::shareCellAt(const Object* p_o, FixedVector where, const Object* p_other) {
  const bool share =
      shareCell(p_o->getWorldBox(where), p_o->mask, p_other->getWorldBox(p_other->position), p_other->mask);
  ++m_counters.precise_pairs;
  if (!share) ++m_counters.precise_rejected;
  return share;
}

// Collisions at the target, as in the book.

// Listing 4.108.
ObjectList World::getCollisions(const Object* p_o, FixedVector where) {
  ObjectList collision_list;
  const FixedBox box = p_o->getWorldBox(where);
  for (Object* p_temp_o : m_updates) {
    if (!boxIntersectsBox(p_temp_o->getWorldBox(p_temp_o->position), box)) continue;
    if (p_temp_o == p_o) continue;  // an Object does not collide with itself
    if (p_temp_o->active && p_temp_o->isSolid() &&
        (!isPrecise(p_o, p_temp_o) || shareCellAt(p_o, where, p_temp_o))) {
      collision_list.push_back(p_temp_o);
    }
  }
  return collision_list;
}

/// Sends the collisions of a move that is not swept. Returns true if the move is allowed.
bool World::moveAtOnce(Object* p_o, const SweepPath& path) {
  const ObjectList list = getCollisions(p_o, path.to);
  bool hard_block = false;
  bool soft_block = false;
  bool met_soft = false;
  for (Object* p_temp_o : list) {
    if (p_temp_o->gone) continue;
    if (p_o->solidness == df::SOFT || p_temp_o->solidness == df::SOFT) met_soft = true;
    sendToBoth(p_o, p_temp_o, path.to);
    if (p_o->gone) break;
    if (p_temp_o->gone) continue;

    const Verdict verdict = judge(p_o, p_temp_o, path);
    if (verdict == Verdict::HARD_BLOCK) hard_block = true;
    if (verdict == Verdict::SOFT_BLOCK) soft_block = true;
    if (verdict == Verdict::MOVES_OUT) ++m_counters.moved_out;
  }
  if (met_soft) ++m_counters.met_soft;
  if (p_o->gone) return false;
  if (hard_block) ++m_counters.blocked_hard;
  if (soft_block) ++m_counters.blocked_soft;
  return !hard_block && !soft_block;
}

}  // namespace oracle

// The actions of a random world's scripts, one function each.

#include "Script.h"

namespace oracle {

/// Returns the target of an action: usually `self`, else `other`, else any Object. -1: none.
int Script::someone(Rng& rng, int self, int other) const {
  const int roll = rng.below(10);
  int id = self;
  if (roll >= 5 && roll < 8 && other >= 0) id = other;
  if (roll >= 8 && !m_present.empty()) {
    id = m_present[static_cast<std::size_t>(rng.below(static_cast<int>(m_present.size())))];
  }
  return isPresent(id) ? id : -1;
}

/// Does one random action.
void Script::act(Rng& rng, int self, int other) {
  const int id = someone(rng, self, other);
  if (id < 0) return;
  switch (rng.below(m_world.options.any ? 24 : 19)) {
    case 0:
    case 1:
      return bear(rng, m_actor.getPosition(id));
    case 2:
      return die(id, true);
    case 3:
      return die(id, false);
    case 4:
    case 5:
      return move(id, nearby(rng, m_actor.getPosition(id)));
    case 6:  // no displacement, but a test for collisions
      return move(id, m_actor.getPosition(id));
    case 7:
      return m_actor.setPosition(id, nearby(rng, m_actor.getPosition(id)));
    case 8:
      return m_actor.setPosition(id, m_world.randomPosition(rng));
    case 9:
    case 10:
      return m_actor.setVelocity(id, m_world.randomVelocity(rng));
    case 11:
      return m_actor.setSolidness(id, m_world.randomSolidness(rng));
    case 12:
      return m_actor.setBox(id, m_world.randomBox(rng));
    case 13:
      return m_actor.setNoSoft(id, rng.chance(m_world.no_soft_percent));
    case 14:
      return m_actor.setActive(id, rng.chance(60));
    case 15:
      return remove(id);
    case 16:  // removed and inserted at once: now the last in order
      remove(id);
      return insert(id);
    case 17:
      return m_actor.setAcceleration(id, m_world.randomAcceleration(rng));
    case 18:  // a jump across the world
      return move(id, m_world.randomPosition(rng));
    case 19:
    case 20:
      return m_actor.setOptions(id, m_world.options.randomOptions(rng));
    case 21:
      return m_actor.setMask(id, m_world.options.randomMask(rng));
    case 22:
      if (m_world.options.scripts_sweep) m_actor.setSweptCollisions(rng.chance(50));
      return;
    default:  // far enough to hit others on the path, but not farther and farther
      if (m_world.kind == Kind::FAR && rng.chance(50)) return move(id, m_world.randomPosition(rng));
      if (m_world.isLost(m_actor.getPosition(id))) return;
      return move(id, m_actor.getPosition(id) + m_world.randomVelocity(rng));
  }
}

/// Lets a GLASS Object react to a hit.
void Script::give(Rng& rng, int id) {
  const int what = rng.below(10);
  if (what < 5) die(id, true);
  if (what == 5) die(id, false);
  if (what == 6) m_actor.setSolidness(id, df::SPECTRAL);
  if (what == 7) m_actor.setActive(id, false);
  if (what == 8) remove(id);
}

void Script::bear(Rng& rng, FixedVector near) {
  if (m_births_left == 0 || static_cast<int>(m_present.size() + m_removed.size()) >= m_world.population_limit)
    return;
  --m_births_left;
  if (m_colliding) ++m_births;
  Spec spec = m_world.randomSpec(rng);
  if (rng.chance(50)) spec.position = nearby(rng, near);
  create(spec);
}

void Script::die(int id, bool by_hand) {
  if (!isPresent(id)) return;
  Role& role = m_cast[static_cast<std::size_t>(id)];
  if (m_colliding && !role.marked) ++m_deaths;
  role.marked = true;
  if (by_hand) {
    m_actor.deleteByHand(id);
  } else {
    m_actor.markForDelete(id);
  }
}

void Script::remove(int id) {
  m_cast[static_cast<std::size_t>(id)].present = false;
  std::erase(m_present, id);
  m_removed.push_back(id);
  m_actor.remove(id);
}

void Script::insert(int id) {
  Role& role = m_cast[static_cast<std::size_t>(id)];
  role.present = true;
  role.marked = false;
  std::erase(m_removed, id);
  m_present.push_back(id);
  m_actor.insert(id);
}

/// Inserts some removed Objects again and deletes a few.
void Script::readmit() {
  const std::vector<int> removed = m_removed;
  for (const int id : removed) {
    Rng rng = draw(id);
    const int what = rng.below(100);
    if (what < 5) m_actor.deleteByHand(id);
    if (what >= 60) insert(id);
  }
}

void Script::move(int id, FixedVector where) {
  if (!isPresent(id) || m_moves_left == 0) return;
  --m_moves_left;
  const bool colliding = m_colliding;
  const int result = m_actor.moveObject(id, where);
  m_colliding = colliding;
  m_log.add({Happening::MOVED, id, 0, 0, where, result});
}

FixedVector Script::nearby(Rng& rng, FixedVector position) const {
  const auto step = [&] {
    const Fixed distance = rng.between(-2 * df::kFixedOne, 2 * df::kFixedOne);
    return distance - distance % m_world.grain;
  };
  const Fixed dx = step();
  return position + FixedVector{dx, step()};
}

}  // namespace oracle

#include "Script.h"

#include <algorithm>

namespace oracle {

void Script::begin() {
  for (const Spec& spec : m_world.objects) {
    create(spec);
  }
}

void Script::create(const Spec& spec) {
  const int id = created();
  m_cast.push_back({spec.temper});
  m_present.push_back(id);
  m_largest = std::max(m_largest, static_cast<int>(m_present.size()));
  m_actor.create(id, spec);
}

void Script::beginTick() {
  m_moves_left = m_world.moves_per_tick;
  m_births_left = 60;
  m_colliding = false;
  readmit();
  Rng rng(mix(m_world.seed ^ mix(static_cast<std::uint64_t>(~m_tick++))));
  while (m_present.size() < 2) create(m_world.randomSpec(rng));
}

Rng Script::draw(int id) {
  Role& role = m_cast[static_cast<std::size_t>(id)];
  const auto number = static_cast<std::uint64_t>(id) << 32 | static_cast<std::uint64_t>(role.events++);
  return Rng(mix(m_world.seed ^ mix(number)));
}

void Script::onStep(int id) {
  m_log.add({Happening::STEP, id});
  Rng rng = draw(id);
  m_colliding = false;
  const int what = rng.below(1000);
  if (what < 25) act(rng, id, -1);
  if (what == 25) {  // a level load
    for (int i = rng.below(30); i >= 0; --i) bear(rng, m_world.randomPosition(rng));
  }
  if (!isPresent(id)) return;
  if (what > 980) m_actor.setVelocity(id, m_world.randomVelocity(rng));

  // Who has got lost comes home, so that worlds do not run empty.
  const FixedVector position = m_actor.getPosition(id);
  const FixedVector from_corner = position - m_world.area.corner;
  const Fixed far = df::fromCells(20);
  const bool lost = from_corner.x < -far || from_corner.x > m_world.area.size.x + far ||
                    from_corner.y < -far || from_corner.y > m_world.area.size.y + far;
  if (lost) {
    m_actor.setAcceleration(id, {});
    m_actor.setVelocity(id, m_world.randomVelocity(rng));
    m_actor.setPosition(id, m_world.randomPosition(rng));
  }
}

void Script::onCollision(int id, int object1, int object2, FixedVector where) {
  m_log.add({Happening::COLLISION, id, object1, object2, where});
  Rng rng = draw(id);
  ++m_handled;
  m_colliding = true;
  const int other = id == object1 ? object2 : object1;
  switch (m_cast[static_cast<std::size_t>(id)].temper) {
    case Temper::QUIET:
      if (rng.chance(4)) act(rng, id, other);
      break;
    case Temper::LIVELY:
      if (rng.chance(50)) act(rng, id, other);
      if (rng.chance(15)) act(rng, id, other);
      break;
    case Temper::BULLET:
      if (m_actor.getSolidness(other) == df::HARD && rng.chance(40)) die(other, rng.chance(30));
      if (rng.chance(60)) die(id, rng.chance(50));
      break;
    case Temper::PARENT:
      if (rng.chance(30)) bear(rng, where);
      if (rng.chance(20)) act(rng, id, other);
      break;
    case Temper::STUBBORN:
      if (rng.chance(70)) move(object1, where);
      if (rng.chance(10)) act(rng, id, other);
      break;
  }
}

void Script::onOut(int id) {
  m_log.add({Happening::OUT, id});
  Rng rng = draw(id);
  ++m_handled;
  m_colliding = true;
  const int what = rng.below(100);
  if (what < 40) {
    m_actor.setPosition(id, m_world.randomPosition(rng));
  } else if (what < 70) {  // back the way it came
    m_actor.setVelocity(id, FixedVector{} - m_actor.getVelocity(id));
  } else if (what < 75) {
    die(id, rng.chance(50));
  } else if (what < 85) {
    move(id, m_world.randomPosition(rng));
  } else if (what < 95) {
    act(rng, id, -1);
  }
}

void Script::onDestroyed(int id) {
  m_log.add({Happening::DESTROYED, id});
  m_cast[static_cast<std::size_t>(id)].present = false;
  std::erase(m_present, id);
  std::erase(m_removed, id);
}

/// Whom an action is for: mostly oneself, else the other of the collision, else anybody. -1 is nobody.
int Script::someone(Rng& rng, int self, int other) const {
  const int whom = rng.below(10);
  int id = self;
  if (whom >= 5 && whom < 8 && other >= 0) id = other;
  if (whom >= 8 && !m_present.empty()) {
    id = m_present[static_cast<std::size_t>(rng.below(static_cast<int>(m_present.size())))];
  }
  return isPresent(id) ? id : -1;
}

/// Do one thing, anything.
void Script::act(Rng& rng, int self, int other) {
  const int id = someone(rng, self, other);
  if (id < 0) return;
  switch (rng.below(18)) {
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
    case 6:  // moves nothing, but tests for collisions
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
    case 16:  // out and in again at once: now the last in order
      remove(id);
      return insert(id);
    default:
      return m_actor.setAcceleration(id, m_world.randomAcceleration(rng));
  }
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

/// Some of those that were removed come back, some never do.
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

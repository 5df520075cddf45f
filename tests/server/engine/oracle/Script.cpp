#include "Script.h"

#include <algorithm>

namespace oracle {

void Script::begin() {
  m_actor.setSweptCollisions(m_world.options.sweep_all);
  for (const Spec& spec : m_world.objects) {
    create(spec);
  }
}

void Script::create(const Spec& spec) {
  const int id = created();
  m_cast.push_back({.temper = spec.temper});
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
  for (const int id : m_present) {  // because DEAF Objects have no handler that does this
    if (m_cast[static_cast<std::size_t>(id)].temper == Temper::DEAF) comeHome(rng, id);
  }
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
  if (what == 25) {  // like a game that loads a level
    for (int i = rng.below(30); i >= 0; --i) bear(rng, m_world.randomPosition(rng));
  }
  if (!isPresent(id)) return;
  if (what > 980) m_actor.setVelocity(id, m_world.randomVelocity(rng));

  comeHome(rng, id);
}

/// Puts an Object that is far away back, so that worlds do not run empty and no position leaves its range.
void Script::comeHome(Rng& rng, int id) {
  if (!m_world.isLost(m_actor.getPosition(id))) return;
  m_actor.setAcceleration(id, {});
  m_actor.setVelocity(id, m_world.randomVelocity(rng));
  m_actor.setPosition(id, m_world.randomPosition(rng));
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
    case Temper::GLASS:
      if (id == object2) give(rng, id);
      break;
    case Temper::DEAF:
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
  } else if (what < 70) {  // reverse
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

}  // namespace oracle

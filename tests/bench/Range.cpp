#include "Range.h"

#include <optional>

#include "engine/managers/WorldManager.h"
#include "engine/world/EventCollision.h"
#include "engine/world/WorldLog.h"
#include "tests/server/engine/oracle/OracleGeometry.h"

namespace bench {
namespace {

df::Box toBox(const df::FixedBox& box) {
  return {df::Vector::fromFixed(box.corner), df::toCells(box.size.x), df::toCells(box.size.y)};
}

// Returns the first time at which the mover collides with the other Object.
std::optional<oracle::Time> meeting(const oracle::SweepPath& path, const Flier& own,
                                    const df::FixedBox& obstacle, const Flier& other) {
  if (own.mask.empty() || other.mask.empty()) return oracle::firstTouch(path, own.box, obstacle);
  return oracle::firstShare(path, own.box, own.mask, obstacle, other.mask);
}

}  // namespace

/// Counts its collision events: separately those in which it moved and those in which it was hit.
class Shooter : public df::Object {
 public:
  explicit Shooter(const Make& make) {
    setSolidness(make.solidness);
    setNoSoft(make.no_soft);
    setSwept(make.swept);
  }

  int eventHandler(const df::Event* p_e) override {
    if (p_e->getType() != df::COLLISION_EVENT) return 0;
    const auto* p_collision = static_cast<const df::EventCollision*>(p_e);
    ++(p_collision->getObject1() == this ? as_mover : as_other);
    return 1;
  }

  int as_mover = 0;
  int as_other = 0;
};

/// Expectation and result of one turn.
struct Range::Turn {
  bool must_meet;
  bool is_right;
};

Range::Range(const Make& older, const Make& younger) : m_scope(m_world), m_makes{older, younger} {
  m_world.log().setSink([](const std::string& /*line*/) {});
  WM.setBoundary(df::Box(df::Vector(-1e6, -1e6), 1e6, 1e6));
  for (int i : {0, 1}) m_p_shooters[i] = new Shooter(m_makes[i]);
}

Range::~Range() {
  m_world.shutDown();
}

void Range::sweepAll() {
  WM.setSweptCollisions();
  for (Make& make : m_makes) make.swept = true;
}

void Range::set(const Flier& older, const Flier& younger) {
  m_fliers[0] = older;
  m_fliers[1] = younger;
  for (int i : {0, 1}) {
    m_p_shooters[i]->setBox(toBox(m_fliers[i].box));
    m_p_shooters[i]->setPosition(df::Vector::fromFixed(m_fliers[i].position));
    m_p_shooters[i]->setVelocity(df::Vector::fromFixed(m_fliers[i].velocity));
    if (m_fliers[i].mask.empty()) continue;
    m_p_shooters[i]->setMask(m_fliers[i].mask);
    m_p_shooters[i]->setPrecise();
  }
}

bool Range::block(int mover) const {
  const Make& own = m_makes[mover];
  const Make& its = m_makes[1 - mover];
  if (its.solidness == df::SOFT) return own.no_soft;
  return own.solidness == df::HARD && its.solidness == df::HARD;
}

Range::Turn Range::turnOf(int mover, const df::FixedVector* p_before, const df::FixedVector* p_after) const {
  const int other = 1 - mover;
  const Flier& own = m_fliers[mover];
  const Flier& its = m_fliers[other];
  const df::FixedBox obstacle = its.boxAt(mover == 0 ? p_before[other] : p_after[other]);
  const oracle::SweepPath path{p_before[mover], p_before[mover] + own.velocity};
  const std::optional<oracle::Time> time = meeting(path, own, obstacle, its);
  const df::FixedVector end = time && block(mover) ? path.before(*time) : path.to;
  const int expected = time ? 1 : 0;
  const bool is_told = m_p_shooters[mover]->as_mover == expected && m_p_shooters[other]->as_other == expected;
  return {time.has_value(), is_told && (!m_makes[mover].swept || p_after[mover] == end)};
}

bool Range::haveSwapped(const df::FixedVector* p_before, const df::FixedVector* p_after) const {
  const df::FixedBox begin[2] = {m_fliers[0].boxAt(p_before[0]), m_fliers[1].boxAt(p_before[1])};
  const df::FixedBox end[2] = {m_fliers[0].boxAt(p_after[0]), m_fliers[1].boxAt(p_after[1])};
  const auto along = [&](df::Fixed df::FixedVector::*axis, df::Fixed df::FixedVector::*cross) {
    const auto overlap = [cross](const df::FixedBox& a, const df::FixedBox& b) {
      return a.corner.*cross <= b.corner.*cross + b.size.*cross &&
             b.corner.*cross <= a.corner.*cross + a.size.*cross;
    };
    const auto isBehind = [axis](const df::FixedBox& a, const df::FixedBox& b) {
      return a.corner.*axis + a.size.*axis < b.corner.*axis;
    };
    if (!overlap(begin[0], begin[1]) || !overlap(end[0], begin[1]) || !overlap(end[0], end[1])) return false;
    return (isBehind(begin[0], begin[1]) && isBehind(end[1], end[0])) ||
           (isBehind(begin[1], begin[0]) && isBehind(end[0], end[1]));
  };
  return along(&df::FixedVector::x, &df::FixedVector::y) || along(&df::FixedVector::y, &df::FixedVector::x);
}

void Range::tick(Account& account) {
  df::FixedVector before[2];
  df::FixedVector after[2];
  for (int i : {0, 1}) {
    before[i] = m_fliers[i].position;
    m_p_shooters[i]->as_mover = m_p_shooters[i]->as_other = 0;
  }
  WM.update();
  for (int i : {0, 1}) {
    after[i] = df::toFixed(m_p_shooters[i]->getPosition()).value_or(df::FixedVector{});
    m_fliers[i].position = after[i];
  }

  bool hit = false;
  bool through = false;
  bool ghost = false;
  for (int i : {0, 1}) {
    if ((!m_makes[i].swept && !m_judge_unswept) || m_fliers[i].velocity == df::FixedVector{}) continue;
    const Turn turn = turnOf(i, before, after);
    hit |= turn.must_meet;
    if (!turn.is_right) (turn.must_meet ? through : ghost) = true;
  }
  const bool solid = m_fliers[0].mask.empty();  // shots may fly through holes
  const bool all_swept = m_makes[0].swept && m_makes[1].swept;
  const bool told = m_p_shooters[0]->as_mover + m_p_shooters[1]->as_mover > 0;
  if (solid && all_swept && !told && haveSwapped(before, after)) through = true;
  ++account.shots;
  account.hits += hit ? 1 : 0;
  account.through += through ? 1 : 0;
  account.ghosts += ghost ? 1 : 0;
  if (all_swept && !told) {
    const oracle::SweepPath relative{before[0], before[0] + m_fliers[0].velocity - m_fliers[1].velocity};
    if (meeting(relative, m_fliers[0], m_fliers[1].boxAt(before[1]), m_fliers[1])) ++account.simultaneous;
  }
}

bool areMet(const Flier& a, const Flier& b) {
  const df::FixedBox a_box = a.boxAt(a.position);
  const df::FixedBox b_box = b.boxAt(b.position);
  if (!oracle::boxIntersectsBox(a_box, b_box)) return false;
  return a.mask.empty() || b.mask.empty() || oracle::shareCell(a_box, a.mask, b_box, b.mask);
}

}  // namespace bench

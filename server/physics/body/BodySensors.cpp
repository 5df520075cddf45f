#include "physics/body/BodySensors.h"

#include <algorithm>
#include <cmath>

#include "physics/body/BodyImpacts.h"
#include "physics/body/BodyObstacles.h"
#include "physics/impact/ImpactTime.h"

namespace df {

namespace {

using naiad::physics::BodyContact;
using naiad::physics::BodyState;
using naiad::physics::BodyTable;
using naiad::physics::ImpactBody;
using naiad::physics::ImpactShape;
using naiad::physics::Metric;
using naiad::physics::Place;
using naiad::physics::RelativeMotion;
using naiad::physics::Vec2;

// The shape of the Object's box, and its middle.
Vec2 boxOf(const Metric& metric, const FixedBox& box, ImpactBody& body) {
  body.shape = ImpactShape::kBox;
  body.half = 0.5 * metric.fromCells(Vector::fromFixed(box.size));
  return metric.fromCells(Vector::fromFixed(box.corner)) + body.half;
}

}  // namespace

BodySensors::Mover BodySensors::moverOf(const WorldStore& store, const BodyTable& table,
                                        const BodyState& state) {
  Mover mover;
  mover.key = state.key;
  mover.order = state.order;
  mover.is_body = true;
  mover.is_soft = state.is_soft;
  const FixedBox box = store.box(state.key.slot);
  Vec2 offset;
  if (!BodyImpacts::canHave(table.form(state.index), table.metric, box, mover.shape, offset)) {
    offset = boxOf(table.metric, box, mover.shape);
  }
  mover.shape.place = state.start + offset;
  mover.displacement = state.place - state.start;
  return mover;
}

BodySensors::Mover BodySensors::moverOf(const WorldStore& store, const Metric& metric, ObjectKey key) {
  Mover mover;
  mover.key = key;
  mover.order = store.order(key.slot);
  mover.is_soft = store.solidness(key.slot) == SOFT;
  const Vec2 offset = boxOf(metric, store.box(key.slot), mover.shape);
  mover.shape.place = metric.placeOf(store.position(key.slot)) + offset;
  return mover;
}

void BodySensors::add(const Mover& a, const Mover& b) {
  const bool is_swapped = a.is_body && b.is_body && b.order < a.order;
  m_pairs.push_back(is_swapped ? Touch{b, a} : Touch{a, b});
}

// A body that moves, or is SOFT itself, may begin to touch an Object.
void BodySensors::findObjectPairs(const WorldStore& store, const Metric& metric) {
  m_asking.clear();
  m_surroundings.clear();
  for (std::size_t i = 0; i < m_movers.size(); ++i) {
    const Mover& mover = m_movers[i];
    if (mover.displacement == Vec2{} && !mover.is_soft) continue;
    const Vec2 middle = 0.5 * mover.displacement;
    const Vec2 half = halfExtentOf(mover.shape) + Vec2{std::fabs(middle.x), std::fabs(middle.y)};
    m_asking.push_back(i);
    m_surroundings.addRegion(regionOf(metric, mover.shape.place + middle, half));
  }
  m_surroundings.query(store, [&](std::size_t number, ObjectKey key) {
    const Mover& mover = m_movers[m_asking[number]];
    if (mover.is_soft || store.solidness(key.slot) == SOFT) add(mover, moverOf(store, metric, key));
  });
}

bool BodySensors::wereTouching(const Touch& touch) const {
  return std::any_of(m_touching.begin(), m_touching.end(), [&](const Touch& other) {
    return other.first.key == touch.first.key && other.second.key == touch.second.key;
  });
}

void BodySensors::step(const WorldStore& store, const BodyTable& table, const std::vector<BodyState>& states,
                       std::vector<BodyContact>& contacts) {
  m_movers.clear();
  m_pairs.clear();
  for (const BodyState& state : states) {
    if (state.is_hard || state.is_soft) m_movers.push_back(moverOf(store, table, state));
  }
  if (m_movers.empty() && m_touching.empty()) return;
  findObjectPairs(store, table.metric);
  for (const Mover& mover : m_movers) {
    if (!mover.is_soft) continue;
    for (const Mover& other : m_movers) {
      const bool is_duplicate = other.is_soft && other.order <= mover.order;
      if (other.key != mover.key && !is_duplicate) add(mover, other);
    }
  }
  // What a body touched that stands still now.
  for (const Touch& touch : m_touching) {
    const bool is_listed = std::any_of(m_pairs.begin(), m_pairs.end(), [&](const Touch& pair) {
      return pair.first.key == touch.first.key && pair.second.key == touch.second.key;
    });
    if (is_listed || touch.second.is_body) continue;
    const auto at = std::find_if(m_movers.begin(), m_movers.end(),
                                 [&](const Mover& mover) { return mover.key == touch.first.key; });
    const ObjectKey other = touch.second.key;
    if (at == m_movers.end() || !store.isCurrent(other) || !store.collides(other.slot)) continue;
    add(*at, moverOf(store, table.metric, other));
  }
  m_now.clear();
  for (const Touch& pair : m_pairs) {
    const Vec2 offset = pair.second.shape.place - pair.first.shape.place;
    const Vec2 displacement = pair.second.displacement - pair.first.displacement;
    const bool is_touching =
        naiad::physics::touchOf(pair.first.shape, pair.second.shape, offset + displacement).gap <=
        naiad::physics::kImpactSlop;
    if (is_touching) m_now.push_back(pair);
    BodyContact contact{0, pair.first.key, pair.second.key, pair.first.order, pair.second.order, 0, true};
    if (!wereTouching(pair)) {
      const bool is_inside = naiad::physics::touchOf(pair.first.shape, pair.second.shape, offset).gap <=
                             naiad::physics::kImpactSlop;
      const double time =
          is_inside ? 0
                    : naiad::physics::forecastImpact(pair.first.shape, pair.second.shape,
                                                     RelativeMotion{offset, displacement, {}}, 1,
                                                     naiad::physics::restSpeed(displacement, {}), false)
                          .time;
      if (time < 0 && !is_touching) continue;
      contact.time = time < 0 ? 1 : time;
      contacts.push_back(contact);
    }
    if (is_touching) continue;
    contact.time = 1;
    contact.is_begin = false;
    contacts.push_back(contact);
  }
  std::swap(m_touching, m_now);
}

}  // namespace df

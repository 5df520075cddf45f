#include "physics/body/BodySensors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include "physics/body/BodyImpacts.h"
#include "physics/body/BodyObstacles.h"
#include "physics/impact/ImpactTime.h"

namespace naiad::physics {

namespace {

// Sets the shape of the Object's box; returns the box's middle.
Vec2 boxOf(const Metric& metric, const FixedBox& box, ImpactBody& body) {
  body.shape = ImpactShape::kBox;
  body.half = 0.5 * metric.fromCells(Vector::fromFixed(box.size));
  return metric.fromCells(Vector::fromFixed(box.corner)) + body.half;
}

}  // namespace

bool BodySensors::isBefore(const Touch& a, const Touch& b) {
  return std::tie(a.first.slot, a.second.slot, a.first.generation, a.second.generation) <
         std::tie(b.first.slot, b.second.slot, b.first.generation, b.second.generation);
}

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

void BodySensors::add(std::size_t a, std::size_t b) {
  const Mover &one = m_movers[a], &other = m_movers[b];
  if (one.is_body && other.is_body && other.order < one.order) std::swap(a, b);
  m_pairs.push_back(
      {{m_movers[a].key, m_movers[b].key}, static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b)});
}

// Sorts the pairs by slots. Many pairs get a radix sort by bytes, which skips bytes that are equal in all.
void BodySensors::sortPairs() {
  constexpr std::size_t kMany = 256;
  if (m_pairs.size() < kMany) return std::sort(m_pairs.begin(), m_pairs.end(), isPairBefore);
  const auto keyOf = [](const Pair& pair) {
    return std::uint64_t{pair.touch.first.slot} << 32 | pair.touch.second.slot;
  };
  std::uint64_t differing = 0;
  for (const Pair& pair : m_pairs) differing |= keyOf(pair) ^ keyOf(m_pairs[0]);
  m_sorted.resize(m_pairs.size());
  for (int shift = 0; shift < 64; shift += 8) {
    if ((differing >> shift & 255) == 0) continue;
    std::array<std::uint32_t, 256> starts = {};
    for (const Pair& pair : m_pairs) ++starts[keyOf(pair) >> shift & 255];
    std::uint32_t start = 0;
    for (std::uint32_t& count : starts) start += std::exchange(count, start);
    for (const Pair& pair : m_pairs) m_sorted[starts[keyOf(pair) >> shift & 255]++] = pair;
    m_pairs.swap(m_sorted);
  }
}

// Finds the bodies that cross a SOFT body's path. The tree has only the SOFT bodies; all others query it.
void BodySensors::findBodyPairs() {
  m_boxes.clear();
  m_ids.clear();
  const auto sweptBox = [&](const Mover& mover) {
    const Vec2 from = mover.shape.place - m_movers[0].shape.place, to = from + mover.displacement;
    const Vec2 half = halfExtentOf(mover.shape);
    const auto margin = [](double x, double y) {  // larger than the rounding error
      return kImpactSlop + 1e-9 * (1 + std::max(std::fabs(x), std::fabs(y)));
    };
    const Vec2 wide = half + Vec2{margin(from.x, to.x), margin(from.y, to.y)};
    return SweptBox{Vec2{std::min(from.x, to.x), std::min(from.y, to.y)} - wide,
                    Vec2{std::max(from.x, to.x), std::max(from.y, to.y)} + wide};
  };
  for (std::size_t i = 0; i < m_bodies; ++i) {
    if (!m_movers[i].is_soft) continue;
    m_ids.push_back(static_cast<int>(i));
    m_boxes.push_back(sweptBox(m_movers[i]));
  }
  if (m_ids.empty()) return;
  m_soft.update(m_boxes, m_ids, static_cast<int>(m_bodies));
  m_soft.queryPairs([&](int i, int j) { add(static_cast<std::size_t>(i), static_cast<std::size_t>(j)); });
  for (std::size_t i = 0; i < m_bodies; ++i) {
    if (m_movers[i].is_soft) continue;
    m_soft.query(sweptBox(m_movers[i]), [&](int soft) { add(static_cast<std::size_t>(soft), i); });
  }
}

// Finds the Objects that a body may begin to touch, because it moves or is SOFT.
void BodySensors::findObjectPairs(const WorldStore& store, const Metric& metric) {
  m_asking.clear();
  m_surroundings.clear();
  for (std::size_t i = 0; i < m_bodies; ++i) {
    const Mover& mover = m_movers[i];
    if (mover.displacement == Vec2{} && !mover.is_soft) continue;
    const Vec2 middle = 0.5 * mover.displacement;
    const Vec2 half = halfExtentOf(mover.shape) + Vec2{std::fabs(middle.x), std::fabs(middle.y)};
    m_asking.push_back(i);
    m_surroundings.addRegion(regionOf(metric, mover.shape.place + middle, half));
  }
  m_surroundings.query(store, [&](std::size_t number, ObjectKey key) {
    if (!m_movers[m_asking[number]].is_soft && store.solidness(key.slot) != SOFT) return;
    m_movers.push_back(moverOf(store, metric, key));
    add(m_asking[number], m_movers.size() - 1);
  });
}

// Adds the pairs that touched at the end of the last tick but are not near each other in this one. The
// contact of a pair without a SOFT member may last, but not as a sensor's.
void BodySensors::findPartedPairs(const WorldStore& store, const Metric& metric, BodyContacts& contacts) {
  if (m_touching.empty()) return;
  m_by_slot.clear();
  for (std::size_t i = 0; i < m_bodies; ++i) m_by_slot.push_back(static_cast<std::uint32_t>(i));
  std::sort(m_by_slot.begin(), m_by_slot.end(),
            [&](std::uint32_t a, std::uint32_t b) { return m_movers[a].key.slot < m_movers[b].key.slot; });
  const auto bodyOf = [&](ObjectKey key) {
    const auto found = std::lower_bound(
        m_by_slot.begin(), m_by_slot.end(), key.slot,
        [&](std::uint32_t index, std::uint32_t slot) { return m_movers[index].key.slot < slot; });
    return found != m_by_slot.end() && m_movers[*found].key == key ? std::size_t{*found} : m_movers.size();
  };
  std::size_t next = 0;
  const std::size_t listed = m_pairs.size();
  for (const Touch& touch : m_touching) {
    while (next < listed && isBefore(m_pairs[next].touch, touch)) ++next;
    if (next < listed && m_pairs[next].touch == touch) continue;
    const std::size_t first = bodyOf(touch.first);
    std::size_t second = bodyOf(touch.second);
    const bool is_object = second >= m_bodies && store.isCurrent(touch.second) &&
                           store.collides(touch.second.slot) &&
                           !store.has(touch.second.slot, WorldStore::kBody);
    if (first >= m_bodies || (second >= m_bodies && !is_object)) {
      contacts.end(touch.first, touch.second, 0);
      continue;
    }
    if (is_object) {
      second = m_movers.size();
      m_movers.push_back(moverOf(store, metric, touch.second));
    }
    if (!m_movers[first].is_soft && !m_movers[second].is_soft) {
      contacts.handOver(touch.first, touch.second);
      continue;
    }
    m_pairs.push_back({touch, static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(second)});
  }
  if (m_pairs.size() > listed) sortPairs();
}

// Tests whether the pair touches now and since when, and adds the start or end of its contact.
void BodySensors::examine(const Pair& pair, bool were_touching, BodyContacts& contacts) {
  const Mover &first = m_movers[pair.a], &second = m_movers[pair.b];
  const Vec2 offset = second.shape.place - first.shape.place;
  const Vec2 displacement = second.displacement - first.displacement;
  const auto touch = [&](Vec2 apart) { return touchOf(first.shape, second.shape, apart).gap <= kImpactSlop; };
  const bool is_touching = touch(offset + displacement);
  if (is_touching) m_now.push_back(pair.touch);
  if (is_touching && were_touching) return;
  BodyContact contact{0, first.key, second.key, first.order, second.order, 0, true, BodySolver::kSensor};
  if (!were_touching) {
    const double time =
        touch(offset) ? 0
                      : forecastImpact(first.shape, second.shape, RelativeMotion{offset, displacement, {}}, 1,
                                       restSpeed(displacement, {}), false)
                            .time;
    if (time < 0 && !is_touching) return;
    contact.time = time < 0 ? 1 : time;
    contacts.add(contact);
  }
  if (is_touching) return;
  contacts.end(first.key, second.key, 1);
}

void BodySensors::step(const WorldStore& store, const BodyTable& table, const std::vector<BodyState>& states,
                       BodyContacts& contacts) {
  if (!store.hasHadSoft() && m_touching.empty()) return;
  m_movers.clear();
  m_pairs.clear();
  for (const BodyState& state : states) {
    if (state.is_hard || state.is_soft) m_movers.push_back(moverOf(store, table, state));
  }
  m_bodies = m_movers.size();
  if (m_movers.empty() && m_touching.empty()) return;
  findBodyPairs();
  findObjectPairs(store, table.metric);
  sortPairs();
  findPartedPairs(store, table.metric, contacts);
  m_now.clear();
  m_examined += static_cast<std::int64_t>(m_pairs.size());
  std::size_t next = 0;
  for (const Pair& pair : m_pairs) {
    while (next < m_touching.size() && isBefore(m_touching[next], pair.touch)) ++next;
    examine(pair, next < m_touching.size() && m_touching[next] == pair.touch, contacts);
  }
  std::swap(m_touching, m_now);
}

}  // namespace naiad::physics

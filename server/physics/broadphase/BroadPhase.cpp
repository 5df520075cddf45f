#include "physics/broadphase/BroadPhase.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdlib>
#include <limits>
#include <utility>

namespace naiad::physics {

namespace {

// Bodies that lie in one another by the dozen part in the same way whether each is pushed by all or by the
// nearest, and all are too many.
constexpr std::size_t kMaxHeaped = 32;   // of which a proxy keeps all pairs that it finds …
constexpr std::size_t kKeptHeaped = 16;  // … and of more only the nearest
constexpr std::size_t kCollected = 64;   // before the farthest are dropped
// All pairs of a tree are found in about the time that it takes to ask for those of a quarter of its bodies.
constexpr std::size_t kManyShare = 4;
constexpr std::size_t kMany = 16;  // of fewer, each is asked for

std::int64_t twiceMiddle(std::int64_t lower, std::int64_t upper) {
  return lower + upper;
}

// Are their middles nearer than the smaller of them is wide? Those of a body on a large one are not.
bool areHeaped(const GridBounds& a, const GridBounds& b) {
  const std::int64_t x = std::abs(twiceMiddle(a.lower_x, a.upper_x) - twiceMiddle(b.lower_x, b.upper_x));
  const std::int64_t y = std::abs(twiceMiddle(a.lower_y, a.upper_y) - twiceMiddle(b.lower_y, b.upper_y));
  return x < 2 * std::min(a.upper_x - a.lower_x, b.upper_x - b.lower_x) &&
         y < 2 * std::min(a.upper_y - a.lower_y, b.upper_y - b.lower_y);
}

double squareOfDistance(const GridBounds& a, const GridBounds& b) {
  const auto x = static_cast<double>(twiceMiddle(a.lower_x, a.upper_x) - twiceMiddle(b.lower_x, b.upper_x));
  const auto y = static_cast<double>(twiceMiddle(a.lower_y, a.upper_y) - twiceMiddle(b.lower_y, b.upper_y));
  return x * x + y * y;
}

std::uint64_t keyOf(const BroadPhasePair& pair) {
  return static_cast<std::uint64_t>(pair.id_a) << 32 | pair.id_b;
}

}  // namespace

std::int32_t BroadPhase::add(std::uint32_t id, const GridBounds& wide, bool moves, std::uint64_t order) {
  std::int32_t proxy;
  if (m_free.empty()) {
    proxy = static_cast<std::int32_t>(m_proxies.size());
    m_proxies.push_back({});
  } else {
    proxy = m_free.back();
    m_free.pop_back();
  }
  m_proxies[index(proxy)] = {id, moves, false, false, false, false, 0, order, wide};
  ++m_count;
  m_loose.push_back(proxy);
  markChanged(proxy);
  return proxy;
}

void BroadPhase::remove(std::int32_t proxy) {
  Proxy& own = m_proxies[index(proxy)];
  assert(!own.is_removed);
  own.is_removed = true;
  own.is_filed = false;
  --m_count;
  markChanged(proxy);  // its number is free only after its pairs are gone
}

bool BroadPhase::move(std::int32_t proxy, const GridBounds& tight, const GridBounds& wide) {
  if (contains(m_proxies[index(proxy)].bounds, tight)) return false;
  set(proxy, wide);
  return true;
}

void BroadPhase::set(std::int32_t proxy, const GridBounds& bounds) {
  Proxy& own = m_proxies[index(proxy)];
  own.bounds = bounds;
  markChanged(proxy);
  if (!own.is_filed) return;
  const SweptBox box = relative(bounds);
  own.is_filed = overlaps(m_tree.box(proxy), box);
  if (own.is_filed) {
    m_tree.grow(proxy, box);
    ++m_widened;
  } else {
    m_loose.push_back(proxy);
  }
}

SweptBox BroadPhase::relative(const GridBounds& bounds) const {
  const auto from = [](std::int64_t x, std::int64_t origin) { return static_cast<double>(x - origin); };
  return {{from(bounds.lower_x, m_origin.lower_x), from(bounds.lower_y, m_origin.lower_y)},
          {from(bounds.upper_x, m_origin.lower_x), from(bounds.upper_y, m_origin.lower_y)}};
}

void BroadPhase::fileAll() {
  m_boxes.clear();
  m_numbers.clear();
  m_loose.clear();
  m_widened = 0;
  m_origin = m_proxies[0].bounds;
  for (std::size_t i = 0; i < m_proxies.size(); ++i) {
    if (m_proxies[i].is_removed) continue;
    m_proxies[i].is_filed = true;
    m_boxes.push_back(relative(m_proxies[i].bounds));
    m_numbers.push_back(static_cast<int>(i));
  }
  m_tree.update(m_boxes, m_numbers, static_cast<int>(m_proxies.size()));
}

void BroadPhase::markChanged(std::int32_t proxy) {
  if (m_proxies[index(proxy)].changed) return;
  m_proxies[index(proxy)].changed = true;
  m_changed.push_back(proxy);
}

bool BroadPhase::isBefore(std::int32_t a, std::int32_t b) const {
  const Proxy &one = m_proxies[index(a)], &other = m_proxies[index(b)];
  return one.order != other.order ? one.order < other.order : a < b;
}

void BroadPhase::keepNearest() {
  std::nth_element(m_heaped.begin(), m_heaped.begin() + kKeptHeaped - 1, m_heaped.end(),
                   [](const Heaped& x, const Heaped& y) {
                     if (x.square != y.square) return x.square < y.square;
                     return x.order != y.order ? x.order < y.order : keyOf(x.pair) < keyOf(y.pair);
                   });
  m_heaped.resize(kKeptHeaped);
}

// Of two changed proxies, the one that comes first finds the pair.
BroadPhase::Proxy& BroadPhase::finderOf(std::int32_t a, std::int32_t b) {
  Proxy &one = m_proxies[index(a)], &other = m_proxies[index(b)];
  return one.changed && !(other.changed && isBefore(b, a)) ? one : other;
}

bool BroadPhase::isHeap(const Proxy& a, const Proxy& b) const {
  return m_thins_crowds && a.moves && b.moves && areHeaped(a.bounds, b.bounds);
}

// Of those that find too many the pairs are looked for once more, one after the other.
void BroadPhase::findAllPairs() {
  fileAll();
  for (Proxy& own : m_proxies) {
    own.heaped = 0;
    if (own.changed) own.is_thinned = false;
  }
  bool is_crowded = false;
  m_tree.queryPairs([&](int a, int b) {
    const Proxy &one = m_proxies[index(a)], &other = m_proxies[index(b)];
    if (!(one.changed || other.changed) || !(one.moves || other.moves)) return;
    if (isHeap(one, other) && ++finderOf(a, b).heaped > kMaxHeaped) {
      is_crowded = true;
      return;
    }
    m_found.push_back(one.id < other.id ? BroadPhasePair{one.id, other.id, a, b}
                                        : BroadPhasePair{other.id, one.id, b, a});
  });
  if (!is_crowded) return;
  std::erase_if(m_found, [&](const BroadPhasePair& pair) {
    return finderOf(pair.proxy_a, pair.proxy_b).heaped > kMaxHeaped;
  });
  for (const std::int32_t proxy : m_changed) {
    if (!m_proxies[index(proxy)].is_removed && m_proxies[index(proxy)].heaped > kMaxHeaped) findPairs(proxy);
  }
}

void BroadPhase::findPairs(std::int32_t proxy) {
  Proxy& own = m_proxies[index(proxy)];
  const GridBounds bounds = own.bounds;
  m_heaped.clear();
  own.is_thinned = false;
  double farthest = std::numeric_limits<double>::infinity();  // of those that may be kept
  visitAll(bounds, [&](std::int32_t other) {
    const Proxy& that = m_proxies[index(other)];
    if (other == proxy || (that.changed && isBefore(other, proxy)) || !(own.moves || that.moves)) return;
    const BroadPhasePair pair = own.id < that.id ? BroadPhasePair{own.id, that.id, proxy, other}
                                                 : BroadPhasePair{that.id, own.id, other, proxy};
    const GridBounds& its = that.bounds;
    if (!isHeap(own, that)) {
      m_found.push_back(pair);
      return;
    }
    const double square = squareOfDistance(bounds, its);
    if (square > farthest) return;
    m_heaped.push_back({square, that.order, pair});
    if (m_heaped.size() < kCollected) return;
    own.is_thinned = true;
    keepNearest();
    farthest = m_heaped.back().square;
  });
  if (m_heaped.size() > kMaxHeaped || (own.is_thinned && m_heaped.size() > kKeptHeaped)) {
    own.is_thinned = true;
    keepNearest();
  }
  m_has_thinned = m_has_thinned || own.is_thinned;
  for (const Heaped& heaped : m_heaped) m_found.push_back(heaped.pair);
}

// By digits of eight bits, those left out that all have in common.
void BroadPhase::sortFound() {
  std::array<std::array<std::uint32_t, 256>, 8> counts = {};
  for (const BroadPhasePair& pair : m_found) {
    const std::uint64_t key = keyOf(pair);
    for (std::size_t digit = 0; digit < 8; ++digit) ++counts[digit][key >> (8 * digit) & 255];
  }
  m_spare.resize(m_found.size());
  for (std::size_t digit = 0; digit < 8 && !m_found.empty(); ++digit) {
    std::array<std::uint32_t, 256>& count = counts[digit];
    if (count[keyOf(m_found[0]) >> (8 * digit) & 255] == m_found.size()) continue;
    std::uint32_t start = 0;
    for (std::uint32_t& c : count) start += std::exchange(c, start);
    for (const BroadPhasePair& pair : m_found) m_spare[count[keyOf(pair) >> (8 * digit) & 255]++] = pair;
    m_found.swap(m_spare);
  }
}

std::span<const BroadPhasePair> BroadPhase::updatePairs() {
  if (m_changed.empty()) return m_pairs;
  m_found.clear();
  if (m_changed.size() >= kMany && m_changed.size() * kManyShare >= m_count) {
    findAllPairs();
  } else {
    if (isUntidy()) fileAll();
    for (const std::int32_t proxy : m_changed) {
      if (!m_proxies[index(proxy)].is_removed) findPairs(proxy);
    }
  }
  sortFound();
  // Old pairs of changed bodies were found again if they still are any.
  m_spare.clear();
  std::size_t next = 0;
  for (const BroadPhasePair& pair : m_pairs) {
    if (m_proxies[index(pair.proxy_a)].changed || m_proxies[index(pair.proxy_b)].changed) continue;
    while (next < m_found.size() && keyOf(m_found[next]) < keyOf(pair)) m_spare.push_back(m_found[next++]);
    m_spare.push_back(pair);
  }
  m_spare.insert(m_spare.end(), m_found.begin() + static_cast<std::ptrdiff_t>(next), m_found.end());
  m_pairs.swap(m_spare);
  std::erase_if(m_loose, [this](std::int32_t proxy) { return m_proxies[index(proxy)].is_removed; });
  for (const std::int32_t proxy : m_changed) {
    m_proxies[index(proxy)].changed = false;
    if (m_proxies[index(proxy)].is_removed) m_free.push_back(proxy);
  }
  m_changed.clear();
  return m_pairs;
}

}  // namespace naiad::physics

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
constexpr int kCrowd = 64;               // so many in one place are looked for first
constexpr double kBeyond = std::numeric_limits<double>::infinity();
constexpr std::uint64_t kLastOrder = std::numeric_limits<std::uint64_t>::max();
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

Vec2 widthOf(const GridBounds& a) {
  return {static_cast<double>(a.upper_x - a.lower_x), static_cast<double>(a.upper_y - a.lower_y)};
}

// Is it about as large as all of a crowd?
bool areAlike(Vec2 width, Vec2 narrowest, Vec2 widest) {
  const auto areAlong = [](double own, double least, double most) {
    return 2 * std::min(own, least) >= std::max(own, most);
  };
  return areAlong(width.x, narrowest.x, widest.x) && areAlong(width.y, narrowest.y, widest.y);
}

double squareOfDistance(const GridBounds& a, const GridBounds& b) {
  const auto x = static_cast<double>(twiceMiddle(a.lower_x, a.upper_x) - twiceMiddle(b.lower_x, b.upper_x));
  const auto y = static_cast<double>(twiceMiddle(a.lower_y, a.upper_y) - twiceMiddle(b.lower_y, b.upper_y));
  return x * x + y * y;
}

// May so many below it be in one place? Cheap, and blind to some whose bounds are of many sizes.
bool mayBeCrowd(const ImpactTree::Below& below) {
  const double most = 4 * double{below.least};
  return below.bodies >= kCrowd && below.box.high.x - below.box.low.x < most &&
         below.box.high.y - below.box.low.y < most;
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

float BroadPhase::halfOf(const Proxy& proxy) const {
  if (!m_thins_crowds || !proxy.moves) return 0;
  const GridBounds& bounds = proxy.bounds;
  const std::int64_t shorter = std::min(bounds.upper_x - bounds.lower_x, bounds.upper_y - bounds.lower_y);
  return 0.5f * static_cast<float>(shorter);
}

void BroadPhase::fileAll() {
  m_boxes.clear();
  m_halves.clear();
  m_numbers.clear();
  m_loose.clear();
  m_widened = 0;
  m_origin = m_proxies[0].bounds;
  for (std::size_t i = 0; i < m_proxies.size(); ++i) {
    if (m_proxies[i].is_removed) continue;
    m_proxies[i].is_filed = true;
    m_boxes.push_back(relative(m_proxies[i].bounds));
    m_halves.push_back(halfOf(m_proxies[i]));
    m_numbers.push_back(static_cast<int>(i));
  }
  m_tree.update(m_boxes, m_numbers, static_cast<int>(m_proxies.size()), m_halves);
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

void BroadPhase::summarizeCrowds() {
  const auto ofBody = [&](int proxy) -> Crowd {
    const Proxy& own = m_proxies[index(proxy)];
    const SweptBox box = relative(own.bounds);
    const Vec2 middle = 0.5 * (box.low + box.high), width = widthOf(own.bounds);
    const Vec2 widest = own.moves ? width : Vec2{kBeyond, kBeyond};
    return {{middle, middle}, width, widest, own.order, own.changed ? own.order : kLastOrder};
  };
  const auto joins = [](const Crowd& a, const Crowd& b) -> Crowd {
    return {join(a.middles, b.middles),
            {std::min(a.narrowest.x, b.narrowest.x), std::min(a.narrowest.y, b.narrowest.y)},
            {std::max(a.widest.x, b.widest.x), std::max(a.widest.y, b.widest.y)},
            std::min(a.first, b.first),
            std::max(a.last, b.last)};
  };
  m_tree.summarize(m_crowds, ofBody, joins);
}

// Are there many below it, and each areHeaped() with all others?
bool BroadPhase::isCrowd(const ImpactTree::Below& below) const {
  if (below.bodies < kCrowd) return false;
  const Crowd& crowd = m_crowds[index(below.node)];
  const Vec2 spread = crowd.middles.high - crowd.middles.low;
  return spread.x < crowd.narrowest.x && spread.y < crowd.narrowest.y && crowd.widest.x < kBeyond;
}

// All that touch the bounds of a crowd count as having found too many. Where a crowd was in the last update
// it is looked for in any case.
void BroadPhase::findCrowds() {
  const auto comeTo = [](int /*proxy*/) {};
  m_crowds.clear();
  bool may_be = m_was_crowded;
  m_tree.walk(
      [&](const ImpactTree::Below& below) {
        may_be = may_be || mayBeCrowd(below);
        return below.bodies >= kCrowd && !may_be;
      },
      comeTo);
  if (!may_be) return;
  summarizeCrowds();
  m_tree.walk(
      [&](const ImpactTree::Below& below) {
        if (!isCrowd(below)) return below.bodies >= kCrowd;
        m_tree.query(below.box, [&](int proxy) { m_proxies[index(proxy)].heaped = kCrowd; });
        return false;
      },
      comeTo);
}

bool BroadPhase::isLike(const Proxy& a, const Proxy& b) const {
  const Vec2 width = widthOf(b.bounds);
  return m_thins_crowds && a.moves && b.moves && areAlike(widthOf(a.bounds), width, width);
}

// Of those that find too many the pairs are looked for once more, one after the other. Within a crowd that is
// done for all, so it is left out here.
void BroadPhase::findAllPairs() {
  fileAll();
  for (Proxy& own : m_proxies) {
    own.heaped = 0;
    if (own.changed) own.is_thinned = false;
  }
  findCrowds();
  const auto find = [&](int a, int b) {
    ++m_looks;
    const Proxy &one = m_proxies[index(a)], &other = m_proxies[index(b)];
    if (!(one.changed || other.changed) || !(one.moves || other.moves)) return;
    if (isHeap(one, other) && ++finderOf(a, b).heaped > kMaxHeaped) return;
    m_found.push_back(one.id < other.id ? BroadPhasePair{one.id, other.id, a, b}
                                        : BroadPhasePair{other.id, one.id, b, a});
  };
  if (m_crowds.empty()) {
    m_tree.queryPairs(find);
  } else {
    m_tree.queryPairs(find, [&](const ImpactTree::Below& below) { return isCrowd(below); });
  }
  const auto isCrowded = [&](std::int32_t proxy) { return m_proxies[index(proxy)].heaped > kMaxHeaped; };
  const bool is_crowded = std::any_of(m_changed.begin(), m_changed.end(), isCrowded);
  m_was_crowded = is_crowded;
  if (!is_crowded) return m_crowds.clear();
  std::erase_if(m_found, [&](const BroadPhasePair& pair) {
    return finderOf(pair.proxy_a, pair.proxy_b).heaped > kMaxHeaped;
  });
  if (m_crowds.empty()) summarizeCrowds();
  // By where they are: what one has looked at is still in the processor's cache for the next.
  m_tree.walk([](const ImpactTree::Below& /*below*/) { return true; },
              [&](int proxy) {
                if (m_proxies[index(proxy)].changed && isCrowded(proxy)) findPairs(proxy);
              });
  m_crowds.clear();
}

void BroadPhase::findPairs(std::int32_t proxy) {
  Proxy& own = m_proxies[index(proxy)];
  const GridBounds bounds = own.bounds;
  const SweptBox box = relative(bounds);
  const Vec2 middle = 0.5 * (box.low + box.high);
  m_heaped.clear();
  std::size_t heaped = 0;
  double farthest = std::numeric_limits<double>::infinity();  // of those that may be kept, and of these …
  std::uint64_t last = 0;                                     // … the last
  const auto find = [&](std::int32_t other) {
    ++m_looks;
    const Proxy& that = m_proxies[index(other)];
    if (other == proxy || (that.changed && isBefore(other, proxy)) || !(own.moves || that.moves)) return;
    const BroadPhasePair pair = own.id < that.id ? BroadPhasePair{own.id, that.id, proxy, other}
                                                 : BroadPhasePair{that.id, own.id, other, proxy};
    const bool is_heaped = isHeap(own, that);
    if (!is_heaped && !isLike(own, that)) {
      m_found.push_back(pair);
      return;
    }
    heaped += is_heaped ? 1 : 0;
    const double square = squareOfDistance(bounds, that.bounds);
    if (square > farthest) return;
    m_heaped.push_back({square, that.order, pair});
    if (heaped <= kMaxHeaped || m_heaped.size() < kCollected) return;
    keepNearest();
    farthest = m_heaped.back().square;
    last = m_heaped.back().order;
  };
  // Do all below it find this one themselves, or are they like it, and others nearer?
  const auto isLeftOut = [&](const ImpactTree::Below& below) {
    if (m_crowds.empty()) return false;
    const Crowd& crowd = m_crowds[index(below.node)];
    if (crowd.last < own.order) return true;
    if (!own.moves || !areAlike(widthOf(bounds), crowd.narrowest, crowd.widest)) return false;
    const Vec2 over = middle - crowd.middles.high, under = crowd.middles.low - middle;
    const Vec2 apart = {std::max({over.x, under.x, 0.0}), std::max({over.y, under.y, 0.0})};
    const double square = 4 * lengthSquared(apart);
    return square > farthest || (square == farthest && crowd.first > last);
  };
  visitAll(
      bounds, [&](const ImpactTree::Below& below) { return overlaps(below.box, box) && !isLeftOut(below); },
      find, own.is_filed && !m_crowds.empty() ? proxy : kNone);
  own.is_thinned = heaped > kMaxHeaped;
  if (own.is_thinned && m_heaped.size() > kKeptHeaped) keepNearest();
  m_has_thinned = m_has_thinned || own.is_thinned;
  for (const Heaped& kept : m_heaped) m_found.push_back(kept.pair);
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

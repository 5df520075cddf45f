#include "physics/broadphase/BroadPhase.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <utility>

namespace naiad::physics {

namespace {

// Limits for crowds. Dozens of overlapping bodies separate equally well if each is pushed only by the nearest
// others, and all pairs would be too many.
constexpr std::size_t kMaxHeaped = 32;   // a proxy with at most this many kHeaped pairs keeps them all
constexpr std::size_t kKeptHeaped = 16;  // number of nearest pairs that a proxy with more pairs keeps
constexpr std::size_t kCollected = 64;   // number of collected pairs at which the farthest are dropped
constexpr int kCrowd = 64;               // minimum number of bodies in a crowd that findCrowds() finds
constexpr double kBeyond = std::numeric_limits<double>::infinity();
constexpr std::uint64_t kLastOrder = std::numeric_limits<std::uint64_t>::max();
// Finding all pairs with the tree takes about as long as queries for one in this many bodies.
constexpr std::size_t kManyShare = 4;
constexpr std::size_t kMany = 16;  // if fewer bodies have changed, each is queried alone

std::int64_t twiceMiddle(std::int64_t lower, std::int64_t upper) {
  return lower + upper;
}

// True if the centres are nearer than the smaller one is wide: rarely for a small body on a large one.
bool areHeaped(const GridBounds& a, const GridBounds& b) {
  const std::int64_t x = std::abs(twiceMiddle(a.lower_x, a.upper_x) - twiceMiddle(b.lower_x, b.upper_x));
  const std::int64_t y = std::abs(twiceMiddle(a.lower_y, a.upper_y) - twiceMiddle(b.lower_y, b.upper_y));
  return x < 2 * std::min(a.upper_x - a.lower_x, b.upper_x - b.lower_x) &&
         y < 2 * std::min(a.upper_y - a.lower_y, b.upper_y - b.lower_y);
}

Vec2 widthOf(const GridBounds& a) {
  return {static_cast<double>(a.upper_x - a.lower_x), static_cast<double>(a.upper_y - a.lower_y)};
}

// True if a body is about as large as all bodies of a crowd.
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

// True if many bodies below the node may be in one place. The test is cheap, but misses some crowds of mixed
// sizes. `usual` is the mean of half the shorter side of moving bodies.
bool mayBeCrowd(const ImpactTree::Below& below, double usual) {
  const double most = 4 * std::max(double{below.least}, 2 * usual);
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
  markChanged(proxy);  // its number can be reused only after its pairs are removed
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

bool BroadPhase::isSmaller(std::int32_t a, std::int32_t b) const {
  const auto areaOf = [&](std::int32_t proxy) {
    const Vec2 width = widthOf(m_proxies[index(proxy)].bounds);
    return width.x * width.y;
  };
  const double one = areaOf(a), other = areaOf(b);
  return one != other ? one < other : isBefore(a, b);
}

void BroadPhase::Nearest::clear() {
  found.clear();
  farthest = kBeyond;
  last = 0;
}

void BroadPhase::Nearest::keep() {
  if (found.size() <= kKeptHeaped) return;
  std::nth_element(found.begin(), found.begin() + kKeptHeaped - 1, found.end(),
                   [](const Heaped& x, const Heaped& y) {
                     if (x.square != y.square) return x.square < y.square;
                     return x.order != y.order ? x.order < y.order : keyOf(x.pair) < keyOf(y.pair);
                   });
  found.resize(kKeptHeaped);
  farthest = found.back().square;
  last = found.back().order;
}

BroadPhase::Kind BroadPhase::kindOf(const Proxy& a, const Proxy& b) const {
  if (!m_thins_crowds || !a.moves || !b.moves) return Kind::kOther;
  if (areHeaped(a.bounds, b.bounds)) return Kind::kHeaped;
  const Vec2 width = widthOf(b.bounds);
  return areAlike(widthOf(a.bounds), width, width) ? Kind::kAlike : Kind::kUnlike;
}

// Returns which of the two finds the pair: the changed one. If both have changed, the smaller one for
// kUnlike, otherwise the first one (isBefore()).
std::int32_t BroadPhase::finderOf(std::int32_t a, std::int32_t b, Kind kind) const {
  const bool is_one = m_proxies[index(a)].changed, is_other = m_proxies[index(b)].changed;
  if (is_one != is_other) return is_one ? a : b;
  if (kind == Kind::kUnlike) return isSmaller(a, b) ? a : b;
  return isBefore(b, a) ? b : a;
}

// True if the body has more than kMaxHeaped pairs of kind kHeaped, even if the other body finds the pair.
bool BroadPhase::isInCrowd(std::int32_t proxy) {
  const Proxy& own = m_proxies[index(proxy)];
  const SweptBox box = relative(own.bounds);
  std::size_t heaped = 0;
  visitAll(
      own.bounds,
      [&](const ImpactTree::Below& below) { return heaped <= kMaxHeaped && overlaps(below.box, box); },
      [&](std::int32_t other) {
        ++m_looks;
        const bool is_heaped = other != proxy && kindOf(own, m_proxies[index(other)]) == Kind::kHeaped;
        heaped += is_heaped ? 1 : 0;
      },
      own.is_filed ? proxy : kNone);
  return heaped > kMaxHeaped;
}

void BroadPhase::summarizeCrowds() {
  const auto ofBody = [&](int proxy) -> Crowd {
    const Proxy& own = m_proxies[index(proxy)];
    const SweptBox box = relative(own.bounds);
    const Vec2 middle = 0.5 * (box.low + box.high), width = widthOf(own.bounds);
    const Vec2 widest = own.moves ? width : Vec2{kBeyond, kBeyond};
    return {{middle, middle}, width, widest, width, own.order, own.changed ? own.order : kLastOrder};
  };
  const auto joins = [](const Crowd& a, const Crowd& b) -> Crowd {
    return {join(a.middles, b.middles),
            {std::min(a.narrowest.x, b.narrowest.x), std::min(a.narrowest.y, b.narrowest.y)},
            {std::max(a.widest.x, b.widest.x), std::max(a.widest.y, b.widest.y)},
            a.widths + b.widths,
            std::min(a.first, b.first),
            std::max(a.last, b.last)};
  };
  m_tree.summarize(m_crowds, ofBody, joins);
}

// True if the bodies below the node are many, all can move, and they are so near that most of them overlap.
bool BroadPhase::isCrowd(const ImpactTree::Below& below) const {
  if (below.bodies < kCrowd) return false;
  const Crowd& crowd = m_crowds[index(below.node)];
  const Vec2 spread = below.bodies * (crowd.middles.high - crowd.middles.low);
  return spread.x < crowd.widths.x && spread.y < crowd.widths.y && crowd.widest.x < kBeyond;
}

// Marks all bodies that touch a crowd's bounds as crowded. After an update with a crowd, skips mayBeCrowd().
void BroadPhase::findCrowds() {
  const auto comeTo = [](int /*proxy*/) {};
  m_crowds.clear();
  bool may_be = m_was_crowded;
  const auto still = std::count(m_halves.begin(), m_halves.end(), 0.0f);
  const double moving = std::max(static_cast<double>(m_halves.size()) - static_cast<double>(still), 1.0);
  const double usual = std::accumulate(m_halves.begin(), m_halves.end(), 0.0) / moving;
  m_tree.walk(
      [&](const ImpactTree::Below& below) {
        may_be = may_be || mayBeCrowd(below, usual);
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

// Finds all bodies' pairs at once, except those within a crowd; then those of each crowded body separately.
void BroadPhase::findAllPairs() {
  fileAll();
  for (Proxy& own : m_proxies) {
    own.heaped = 0;
    if (own.changed) own.is_thinned = false;
  }
  findCrowds();
  const auto isCrowded = [&](std::int32_t proxy) { return m_proxies[index(proxy)].heaped > kMaxHeaped; };
  const auto find = [&](int a, int b) {
    ++m_looks;
    Proxy &one = m_proxies[index(a)], &other = m_proxies[index(b)];
    if (!(one.changed || other.changed) || !(one.moves || other.moves)) return;
    if (one.moves && other.moves && m_thins_crowds && areHeaped(one.bounds, other.bounds))
      ++one.heaped, ++other.heaped;
    const bool may_be_crowded = one.heaped > kMaxHeaped || other.heaped > kMaxHeaped;
    if (may_be_crowded && isCrowded(finderOf(a, b, kindOf(one, other)))) return;
    m_found.push_back(one.id < other.id ? BroadPhasePair{one.id, other.id, a, b}
                                        : BroadPhasePair{other.id, one.id, b, a});
  };
  if (m_crowds.empty()) {
    m_tree.queryPairs(find);
  } else {
    m_tree.queryPairs(find, [&](const ImpactTree::Below& below) { return isCrowd(below); });
  }
  const bool is_crowded = std::any_of(m_changed.begin(), m_changed.end(), isCrowded);
  m_was_crowded = is_crowded;
  if (!is_crowded) return m_crowds.clear();
  std::erase_if(m_found, [&](const BroadPhasePair& pair) {
    const Proxy &one = m_proxies[index(pair.proxy_a)], &other = m_proxies[index(pair.proxy_b)];
    return isCrowded(finderOf(pair.proxy_a, pair.proxy_b, kindOf(one, other)));
  });
  if (m_crowds.empty()) summarizeCrowds();
  // Visits them in the order of the tree, because data read for a neighbour is still in the cache.
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
  m_larger.clear();
  std::size_t heaped = 0;
  bool is_asked = false, is_in_crowd = false;
  const auto isLimited = [&] {  // computed only if it is needed
    if (!std::exchange(is_asked, true)) is_in_crowd = isInCrowd(proxy);
    return is_in_crowd;
  };
  const auto find = [&](std::int32_t other) {
    ++m_looks;
    if (other == proxy) return;
    const Proxy& that = m_proxies[index(other)];
    if (!own.moves && !that.moves) return;
    const Kind kind = kindOf(own, that);
    if (finderOf(proxy, other, kind) != proxy) return;
    const BroadPhasePair pair = own.id < that.id ? BroadPhasePair{own.id, that.id, proxy, other}
                                                 : BroadPhasePair{that.id, own.id, other, proxy};
    if (kind == Kind::kOther || (kind == Kind::kUnlike && isSmaller(other, proxy))) {
      m_found.push_back(pair);
      return;
    }
    heaped += kind == Kind::kHeaped ? 1 : 0;
    Nearest& nearest = kind == Kind::kUnlike ? m_larger : m_heaped;
    const double square = squareOfDistance(bounds, that.bounds);
    if (square > nearest.farthest) return;
    nearest.found.push_back({square, that.order, pair});
    if (nearest.found.size() < kCollected) return;
    if (kind == Kind::kUnlike ? isLimited() : heaped > kMaxHeaped) nearest.keep();
  };
  // True if all bodies below the node search for the pair themselves, or nearer pairs have been found.
  const Vec2 width = widthOf(bounds);
  const auto isLeftOut = [&](const ImpactTree::Below& below) {
    if (m_crowds.empty()) return false;
    const Crowd& crowd = m_crowds[index(below.node)];
    const Vec2 over = middle - crowd.middles.high, under = crowd.middles.low - middle;
    const Vec2 span = {std::max(-over.x, -under.x),
                       std::max(-over.y, -under.y)};  // distance to the farthest centre
    const bool are_heaped =
        span.x < std::min(crowd.narrowest.x, width.x) && span.y < std::min(crowd.narrowest.y, width.y);
    // True if none of them is so large that it would be in m_larger.
    const bool are_near = are_heaped || (crowd.widest.x <= 2 * width.x && crowd.widest.y <= 2 * width.y);
    if (crowd.last < own.order && (!own.moves || are_near)) return true;
    const bool has_smaller = 2 * crowd.narrowest.x < width.x || 2 * crowd.narrowest.y < width.y;
    if (!own.moves || crowd.widest.x == kBeyond) return false;
    if (has_smaller && !are_heaped && crowd.last == kLastOrder) return false;
    const Vec2 apart = {std::max({over.x, under.x, 0.0}), std::max({over.y, under.y, 0.0})};
    const double square = 4 * lengthSquared(apart);
    if (!are_near) return square > std::max(m_heaped.farthest, m_larger.farthest);
    return square > m_heaped.farthest || (square == m_heaped.farthest && crowd.first > m_heaped.last);
  };
  visitAll(
      bounds, [&](const ImpactTree::Below& below) { return overlaps(below.box, box) && !isLeftOut(below); },
      find, own.is_filed && !m_crowds.empty() ? proxy : kNone);
  own.is_thinned = heaped > kMaxHeaped;
  if (own.is_thinned) m_heaped.keep();
  if (m_larger.found.size() > kKeptHeaped && isLimited()) {
    m_larger.keep();
    own.is_thinned = true;
  }
  m_has_thinned = m_has_thinned || own.is_thinned;
  for (const Nearest* p_nearest : {&m_heaped, &m_larger}) {
    for (const Heaped& kept : p_nearest->found) m_found.push_back(kept.pair);
  }
}

// A radix sort by digits of eight bits. Skips digits that are equal in all keys.
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
  // The pairs of changed bodies have been searched for again, so their old pairs are dropped.
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

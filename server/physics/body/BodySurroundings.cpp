#include "physics/body/BodySurroundings.h"

#include <algorithm>
#include <tuple>

namespace naiad::physics {

namespace {

// If there are at most this many Objects other than bodies, they are listed and compared with each region,
// because in a heap a query of the grid would mostly find the heap's own bodies.
constexpr std::size_t kFew = 128;
constexpr std::size_t kScanned = 16;   // for that list, at most this many Objects per region are examined
constexpr std::size_t kTogether = 32;  // number of consecutive regions whose common area is compared first

// Regions that begin in one tile of 8 by 8 cells, and are not larger than a tile, share a query of the grid.
constexpr int kTileBits = df::kFixedBits + 3;
constexpr Fixed kLargest = Fixed{1} << kTileBits;

bool isLarge(const FixedBox& region) {
  return region.size.x > kLargest || region.size.y > kLargest;
}

// The area around several regions. At the limits of positions, it may exceed the maximum size of a box.
struct Span {
  FixedVector low, high;

  explicit Span(const FixedBox& box) : low(box.corner), high(box.corner + box.size) {}
  void add(const FixedBox& box) {
    const FixedVector end = box.corner + box.size;
    low = {std::min(low.x, box.corner.x), std::min(low.y, box.corner.y)};
    high = {std::max(high.x, end.x), std::max(high.y, end.y)};
  }
  bool mayTouch(const FixedBox& box) const {
    return box.corner.x <= high.x && box.corner.y <= high.y && low.x <= box.corner.x + box.size.x &&
           low.y <= box.corner.y + box.size.y;
  }
};

}  // namespace

void BodySurroundings::addRegion(const FixedBox& region) {
  const auto number = static_cast<std::uint32_t>(m_regions.size());
  m_regions.push_back({region.corner.x >> kTileBits, region.corner.y >> kTileBits, number, region});
}

void BodySurroundings::search(const WorldStore& store) {
  m_found.clear();
  if (m_regions.empty()) return;
  listOthers(store) ? searchOthers() : searchGrid(store);
}

// Fills m_others with the Objects other than bodies. Returns false if there are too many.
bool BodySurroundings::listOthers(const WorldStore& store) {
  m_others.clear();
  const WorldStore::Walk walk(store);
  if (walk.size() > kScanned * m_regions.size()) return false;
  for (std::size_t i = 0; i < walk.size(); ++i) {
    const WorldStore::Slot slot = walk[i];
    if (slot == WorldStore::kNoSlot || store.has(slot, WorldStore::kBody) || !store.collides(slot)) continue;
    if (m_others.size() == kFew) return false;
    m_others.push_back({store.key(slot), store.worldBox(slot, store.position(slot))});
  }
  return true;
}

void BodySurroundings::searchOthers() {
  for (std::size_t begin = 0, end = 0; begin < m_regions.size() && !m_others.empty(); begin = end) {
    end = std::min(begin + kTogether, m_regions.size());
    Span place(m_regions[begin].region);
    for (std::size_t i = begin + 1; i < end; ++i) place.add(m_regions[i].region);
    m_close.clear();
    for (const Other& other : m_others) {
      if (place.mayTouch(other.box)) m_close.push_back(other);
    }
    for (std::size_t i = begin; i < end; ++i) {
      std::uint32_t turn = 0;
      for (const Other& other : m_close) {
        if (intersects(other.box, m_regions[i].region))
          m_found.push_back({m_regions[i].number, turn++, other.key});
      }
    }
  }
}

void BodySurroundings::searchGrid(const WorldStore& store) {
  constexpr WorldStore::Slot kNoSlot = ~WorldStore::Slot{0};
  std::sort(m_regions.begin(), m_regions.end(), [](const Region& a, const Region& b) {
    return std::tie(a.tile_y, a.tile_x, a.number) < std::tie(b.tile_y, b.tile_x, b.number);
  });
  for (std::size_t i = 0, end = 0; i < m_regions.size(); i = end) {
    const Region& first = m_regions[i];
    Span place(first.region);
    const auto isBeside = [&](const Region& region) {
      return region.tile_x == first.tile_x && region.tile_y == first.tile_y && !isLarge(first.region) &&
             !isLarge(region.region);
    };
    for (end = i + 1; end < m_regions.size() && isBeside(m_regions[end]); ++end) {
      place.add(m_regions[end].region);
    }
    m_near.clear();
    store.touching({place.low, place.high - place.low}, kNoSlot, m_near);
    std::erase_if(m_near, [&](ObjectKey key) { return store.has(key.slot, WorldStore::kBody); });
    for (std::size_t k = i; k < end; ++k) {
      std::uint32_t turn = 0;
      for (const ObjectKey key : m_near) {
        const bool is_near =
            intersects(store.worldBox(key.slot, store.position(key.slot)), m_regions[k].region);
        if (is_near) m_found.push_back({m_regions[k].number, turn, key});
        ++turn;
      }
    }
  }
  std::sort(m_found.begin(), m_found.end(), [](const Found& a, const Found& b) {
    return std::tie(a.number, a.turn) < std::tie(b.number, b.turn);
  });
}

}  // namespace naiad::physics

#include "physics/body/BodyObstacles.h"

#include <algorithm>

#include "physics/geometry/Index.h"

namespace naiad::physics {

namespace {

// Converts a place to a position in the world, clamped to the range of positions.
FixedVector clamped(const Metric& metric, const Place& place) {
  if (metric.isInRange(place)) return metric.fixedOf(place);
  const Vector at = metric.cellsOf(place);
  const auto clamp = [](double x) { return std::clamp(x, -df::kMaxCells, df::kMaxCells); };
  return *toFixed(Vector(clamp(at.x()), clamp(at.y())));
}

std::uint64_t faceKey(int side, Fixed line) {
  return static_cast<std::uint64_t>(line) * 0x9e3779b97f4a7c15u + static_cast<std::uint64_t>(side);
}

bool overlap(const BoxArea& a, const BoxArea& b, std::size_t axis) {
  return a.low[axis] < b.high[axis] && b.low[axis] < a.high[axis];
}

// Returns the cell of an area's middle; only areas in equal cells need equal numbers.
std::uint64_t cellOf(const BoxArea& area) {
  const auto middle = [&](std::size_t i) {
    return static_cast<std::uint64_t>((area.low[i] + (area.high[i] - area.low[i]) / 2) >> df::kFixedBits);
  };
  return middle(0) << 32 ^ (middle(1) & 0xffffffffu);
}

}  // namespace

void BodyObstacles::beginTick() {
  for (Tile& tile : m_tiles) tile.is_near = false;
}

void BodyObstacles::markNear(ObjectKey key) {
  const auto at = std::lower_bound(m_tiles.begin(), m_tiles.end(), key,
                                   [](const Tile& tile, ObjectKey k) { return tile.key.slot < k.slot; });
  if (at == m_tiles.end() || at->key.slot != key.slot) {
    m_tiles.insert(at, Tile{})->key = key;
    return;
  }
  if (at->key != key) at->is_known = false;  // a new Object has taken the slot
  at->key = key;
  at->is_near = true;
}

// True if a box at a hidden side has changed or gone; then adds it to m_changed.
bool BodyObstacles::hasLostNeighbour(const WorldStore& store, const Tile& tile) {
  for (const auto& [key, area] : tile.neighbours) {
    if (isObstacle(store, key) && BoxArea::of(store.worldBox(key.slot, store.position(key.slot))) == area)
      continue;
    m_changed.push_back(area);
    return true;
  }
  return false;
}

// Lists the boxes that were near and have changed or gone, updates the tiles, and marks stale blocks.
void BodyObstacles::findChanges(const WorldStore& store) {
  m_changed.clear();
  m_far.clear();
  m_has_news = false;
  for (Tile& tile : m_tiles) {
    const bool is_there = isObstacle(store, tile.key);
    const BoxArea area =
        is_there ? BoxArea::of(store.worldBox(tile.key.slot, store.position(tile.key.slot))) : BoxArea{};
    bool is_same = is_there && tile.is_known && tile.area == area;
    if (!is_same && tile.area != BoxArea{}) m_changed.push_back(tile.area);
    if (!tile.is_near) m_far.push_back(tile.key);
    if (is_same && tile.is_near && hasLostNeighbour(store, tile)) is_same = false;
    if (is_same && tile.is_near) continue;
    m_has_news = true;
    tile.is_known = false;
    tile.area = area;
  }
  if (!m_has_news) return;
  std::erase_if(m_tiles, [](const Tile& tile) { return !tile.is_near; });
  if (m_changed.empty()) return;
  Fixed widest = 0;
  for (const BoxArea& area : m_changed) widest = std::max(widest, area.high[0] - area.low[0]);
  const auto isBefore = [](const BoxArea& a, Fixed x) { return a.low[0] < x; };
  std::sort(m_changed.begin(), m_changed.end(),
            [](const BoxArea& a, const BoxArea& b) { return a.low[0] < b.low[0]; });
  for (Block& block : m_blocks) {
    const BoxArea& whole = block.shape.whole;
    auto at = std::lower_bound(m_changed.begin(), m_changed.end(), whole.low[0] - widest - BoxUnion::kGap,
                               isBefore);
    for (; at != m_changed.end() && at->low[0] <= whole.high[0] + BoxUnion::kGap && !block.is_stale; ++at) {
      if (BoxUnion::areTouching(whole, *at)) markStale(block);
    }
  }
}

// Finds the crowded cells, whose tiles are not merged, because each would examine all others.
void BodyObstacles::findCrowds() {
  constexpr std::size_t kMany = 16;  // tiles whose middle is in one cell
  m_crowds.clear();
  for (const Tile& tile : m_tiles) {
    if (!tile.is_known) m_crowds.push_back(cellOf(tile.area));
  }
  std::sort(m_crowds.begin(), m_crowds.end());
  std::size_t kept = 0;
  for (std::size_t i = 0, end = 0; i < m_crowds.size(); i = end) {
    while (end < m_crowds.size() && m_crowds[end] == m_crowds[i]) ++end;
    if (end - i > kMany) m_crowds[kept++] = m_crowds[i];
  }
  m_crowds.resize(kept);
}

bool BodyObstacles::isInCrowd(const Tile& tile) const {
  return !m_crowds.empty() && std::binary_search(m_crowds.begin(), m_crowds.end(), cellOf(tile.area));
}

// Removes stale blocks; the tiles that had one must search again.
void BodyObstacles::dropStale() {
  if (!m_has_stale) return;
  m_has_stale = false;
  m_numbers.assign(m_blocks.size(), kUnknown);
  m_faces.clear();
  int kept = 0;
  for (std::size_t i = 0; i < m_blocks.size(); ++i) {
    if (m_blocks[i].is_stale) {
      m_dropped.push_back(m_blocks[i]);
      continue;
    }
    m_numbers[i] = kept;
    m_blocks[at(kept)] = m_blocks[i];
    listFaces(kept++);
  }
  m_blocks.resize(at(kept));
  for (Tile& tile : m_tiles) {
    if (!tile.is_known) continue;
    for (int& block : tile.blocks) {
      if (block >= 0) block = m_numbers[at(block)];
      if (block == kUnknown) tile.is_known = false;
    }
  }
}

void BodyObstacles::listFaces(int block) {
  const BoxUnion::Block& shape = m_blocks[at(block)].shape;
  for (int side = 0; side < kBoxSides; ++side) {
    if (shape.is_complete[at(side)]) m_faces.emplace(faceKey(side, shape.whole.line(side)), block);
  }
}

// Call if a side of this tile is a part of the block. If it was another Object's, that one is not alone now.
void BodyObstacles::share(Block& block, const Tile& tile) {
  if (!block.is_whole_object || block.key == tile.key) return;
  block.is_whole_object = false;
  block.size = {};  // so that the solver finds its contacts again
}

// Returns the known block with the face of which this side of a tile is a part, or kUnknown.
int BodyObstacles::blockOf(const Tile& tile, int side) {
  const std::size_t along = BoxArea::alongOf(side);
  const auto [first, last] = m_faces.equal_range(faceKey(side, tile.area.line(side)));
  int found = kUnknown;
  for (auto face = first; face != last; ++face) {
    Block& block = m_blocks[at(face->second)];
    const BoxArea& whole = block.shape.whole;
    if (block.is_stale || whole.line(side) != tile.area.line(side) ||
        whole.low[along] > tile.area.low[along] || whole.high[along] < tile.area.high[along])
      continue;
    if (found == kUnknown) {
      share(block, tile);
      found = face->second;
    } else if (block.shape.is_cut) {  // two parts of a very long face have met
      markStale(block);
    }
  }
  return found;
}

// Returns a new block. It reaches over all near tiles that lie on one line, unless a gap is too long.
BoxUnion::Block BodyObstacles::shapeAt(const Tile& tile, int side) {
  const std::size_t along = BoxArea::alongOf(side);
  const Fixed line = tile.area.line(side), most = 2 * BoxUnion::kMaxReach;
  Fixed from = tile.area.low[along], to = tile.area.high[along];
  m_row.clear();
  for (const Tile& other : m_tiles) {
    if (BoxUnion::isBehind(other.area, side, line))
      m_row.emplace_back(other.area.low[along], other.area.high[along]);
  }
  std::sort(m_row.begin(), m_row.end());
  const auto own = std::lower_bound(m_row.begin(), m_row.end(), std::pair(from, to));
  for (auto next = own; next != m_row.end() && next->first - to <= most; ++next)
    to = std::max(to, next->second);
  for (auto next = own; next != m_row.begin() && from - std::prev(next)->second <= most; --next)
    from = std::min(from, std::prev(next)->first);
  return m_union.blockAt(tile.area, side, from, to);
}

int BodyObstacles::addBlock(const Tile& tile, int side, const BoxUnion::Block& shape) {
  for (int i = 0; i < kBoxSides; ++i) {  // shorter faces on these lines are no longer complete
    if (!shape.is_complete[at(i)]) continue;
    const std::size_t along = BoxArea::alongOf(i);
    const auto [first, last] = m_faces.equal_range(faceKey(i, shape.whole.line(i)));
    for (auto face = first; face != last; ++face) {
      Block& other = m_blocks[at(face->second)];
      const BoxArea &its = other.shape.whole, &own = shape.whole;
      if (its == own && other.shape.area == shape.area && !other.is_stale) {
        share(other, tile);
        return face->second;
      }
      const bool is_part = its.low[along] >= own.low[along] && its.high[along] <= own.high[along] &&
                           (its.low[along] > own.low[along] || its.high[along] < own.high[along]);
      if (its.line(i) == own.line(i) && (is_part || (shape.is_cut && i == side && overlap(its, own, along))))
        markStale(other);
    }
  }
  Block& block = m_blocks.emplace_back();
  block.shape = shape;
  block.key = tile.key;
  block.side = side;
  block.is_whole_object = shape.area == tile.area;
  const int number = static_cast<int>(m_blocks.size()) - 1;
  listFaces(number);
  return number;
}

// Marks blocks stale in which there is now a hole next to this tile.
void BodyObstacles::dropHollow(const Tile& tile) {
  for (Block& block : m_blocks) {
    if (block.is_fresh || block.is_stale || !BoxUnion::areTouching(block.shape.whole, tile.area)) continue;
    for (int side = 0; side < kBoxSides; ++side) {
      if (tile.blocks[at(side)] == kHidden) continue;
      for (const bool is_upper_end : {false, true}) {
        const auto point = m_union.openPoint(tile.area, side, is_upper_end);
        const BoxArea& whole = block.shape.whole;
        const bool is_inside = point[0] > whole.low[0] && point[0] < whole.high[0] &&
                               point[1] > whole.low[1] && point[1] < whole.high[1];
        if (is_inside) markStale(block);
      }
    }
  }
}

// Finds the block of each side of a tile that is not hidden by others.
void BodyObstacles::findBlocks(Tile& tile) {
  tile.is_known = true;
  tile.neighbours.clear();
  if (isInCrowd(tile) || m_union.look(tile.area) == 1) {
    tile.blocks.fill(kUnknown);
    if (!isInCrowd(tile)) dropHollow(tile);
    tile.blocks.fill(addBlock(tile, kLeftSide, {tile.area, tile.area, {true, true, true, true}}));
    return;
  }
  for (int side = 0; side < kBoxSides; ++side) {
    const bool is_hidden = m_union.isHidden(tile.area, side);
    tile.blocks[at(side)] = is_hidden ? kHidden : kUnknown;
    if (is_hidden) m_union.listBeside(tile.area, side, tile.neighbours);
  }
  dropHollow(tile);
  for (int side = 0; side < kBoxSides; ++side) {
    int& block = tile.blocks[at(side)];
    if (block == kHidden) continue;
    block = blockOf(tile, side);
    if (block == kUnknown) block = addBlock(tile, side, shapeAt(tile, side));
  }
}

// Gives the solver's id of a dropped block to a new one in its place, which the solver then only changes.
void BodyObstacles::replace(const Block& old) {
  const auto tile = std::lower_bound(m_tiles.begin(), m_tiles.end(), old.key,
                                     [](const Tile& a, ObjectKey k) { return a.key.slot < k.slot; });
  const auto isFor = [&](const Block& block) {
    const bool is_other_object =
        (block.is_whole_object || old.is_whole_object) && block.key != old.key;  // has its own contacts
    return block.id < 0 && !is_other_object && BoxUnion::areTouching(block.shape.area, old.shape.area);
  };
  Block* p_new = nullptr;
  if (tile != m_tiles.end() && tile->key == old.key) {
    const int block = tile->blocks[at(old.side)];
    if (block >= 0 && isFor(m_blocks[at(block)])) p_new = &m_blocks[at(block)];
  }
  const auto [first, last] = m_faces.equal_range(faceKey(old.side, old.shape.whole.line(old.side)));
  for (auto face = first; face != last && p_new == nullptr; ++face) {
    if (isFor(m_blocks[at(face->second)])) p_new = &m_blocks[at(face->second)];
  }
  if (p_new == nullptr) return m_removed.push_back(old.id);
  p_new->id = old.id;
  p_new->size = old.size;
}

// Drops the blocks of which no tile is near.
void BodyObstacles::keepNear() {
  for (Block& block : m_blocks) block.is_near = false;
  for (const Tile& tile : m_tiles) {
    for (const int block : tile.blocks) {
      if (block >= 0) m_blocks[at(block)].is_near = true;
    }
  }
  for (Block& block : m_blocks) {
    if (!block.is_near) markStale(block);
  }
  dropStale();
  for (const Block& old : m_dropped) {
    if (old.id >= 0) replace(old);
  }
  m_dropped.clear();
}

void BodyObstacles::update(const WorldStore& store) {
  constexpr int kMaxRounds = 4;  // blocks found in this update are not stale, so two suffice
  m_removed.clear();
  findChanges(store);
  if (!m_has_news) return;
  m_union.setStore(store);
  dropStale();
  for (Block& block : m_blocks) block.is_fresh = false;
  findCrowds();
  for (int round = 0; round < kMaxRounds; ++round) {
    for (Tile& tile : m_tiles) {
      if (!tile.is_known) findBlocks(tile);
    }
    if (!m_has_stale) break;
    dropStale();
  }
  keepNear();
}

FixedBox regionOf(const Metric& metric, const Place& centre, Vec2 half) {
  constexpr double kFarthest = 1 << 28;  // metric cells to either side, so that the box's size is in range
  const Vec2 reach = {std::min(half.x, kFarthest), std::min(half.y, kFarthest)};
  const FixedVector low = clamped(metric, centre + -reach), high = clamped(metric, centre + reach);
  return {{low.x - 1, low.y - 1}, {high.x - low.x + 2, high.y - low.y + 2}};
}

}  // namespace naiad::physics

// The obstacles of a solver: HARD Objects without mass that bodies may hit in this tick.
//
// The world's grid finds the Objects; they are kept while a body is near. All other Objects cost nothing.
// Objects that touch are merged to blocks (BoxUnion.h), which solvers get in place of the Objects.
#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <utility>
#include <vector>

#include "engine/world/WorldStore.h"
#include "physics/body/BoxUnion.h"
#include "physics/body/Metric.h"
#include "physics/body/WorldNames.h"

namespace naiad::physics {

class BodyObstacles {
 public:
  struct Block {
    BoxUnion::Block shape;
    ObjectKey key;                 ///< the Object from which the block was found
    int side = 0;                  ///< and the side of it; no other block has both
    bool is_whole_object = false;  ///< true if the block is this Object's box
    bool is_near = false;
    bool is_fresh = true;   ///< found in the last update
    bool is_stale = false;  ///< true if boxes have changed since the block was found
    int id = -1;            ///< id in the solver; −1: not added yet
    FixedVector size;       ///< size in the solver
  };

  /// Begins a tick; markNear() marks the Objects that are near.
  void beginTick();
  void markNear(ObjectKey key);
  /// Finds the blocks of the Objects that are near. Call after markNear(); may be repeated in a tick.
  void update(const WorldStore& store);
  /// Returns the blocks that are near, in the order in which they were found. The solver adds those without
  /// an id.
  std::vector<Block>& blocks() { return m_blocks; }
  /// Returns the solver's ids of blocks that are no longer near, which it removes.
  const std::vector<int>& removedIds() const { return m_removed; }
  /// Returns the Objects that are no longer near.
  const std::vector<ObjectKey>& farObjects() const { return m_far; }

  /// True if the Object is an obstacle: solid, HARD and not a body.
  static bool isObstacle(const WorldStore& store, ObjectKey key) {
    return store.isCurrent(key) && store.collides(key.slot) && store.solidness(key.slot) == HARD &&
           !store.has(key.slot, WorldStore::kBody);
  }

 private:
  static constexpr int kHidden = -1, kUnknown = -2;
  struct Tile {
    ObjectKey key;
    bool is_near = true;
    bool is_known = false;  // true if `blocks` is valid
    BoxArea area = {};
    std::array<int, kBoxSides> blocks = {};       // by side: index in m_blocks, kHidden or kUnknown
    std::vector<BoxUnion::Neighbour> neighbours;  // boxes at hidden sides
  };

  bool hasLostNeighbour(const WorldStore& store, const Tile& tile);
  void findChanges(const WorldStore& store);
  void findCrowds();
  bool isInCrowd(const Tile& tile) const;
  void dropHollow(const Tile& tile);
  void findBlocks(Tile& tile);
  static void share(Block& block, const Tile& tile);
  int blockOf(const Tile& tile, int side);
  BoxUnion::Block shapeAt(const Tile& tile, int side);
  int addBlock(const Tile& tile, int side, const BoxUnion::Block& shape);
  void listFaces(int block);
  void markStale(Block& block) { m_has_stale = block.is_stale = true; }
  void dropStale();
  void keepNear();
  void replace(const Block& old);

  std::vector<Tile> m_tiles;  // by slot
  std::vector<Block> m_blocks;
  std::unordered_multimap<std::uint64_t, int>
      m_faces;                   // blocks by the sides and lines of their complete faces
  std::vector<Block> m_dropped;  // blocks dropped in this update, which new ones may replace
  std::vector<BoxArea> m_changed;
  std::vector<std::uint64_t> m_crowds;  // cells with many tiles of which the blocks are unknown, sorted
  std::vector<std::pair<Fixed, Fixed>> m_row;  // scratch memory of shapeAt()
  std::vector<int> m_removed;
  std::vector<int> m_numbers;
  std::vector<ObjectKey> m_far;
  BoxUnion m_union;
  bool m_has_news = false;
  bool m_has_stale = false;
};

/// Returns the box that extends by `half` to each side of `centre`, slightly enlarged, in world coordinates.
FixedBox regionOf(const Metric& metric, const Place& centre, Vec2 half);

}  // namespace naiad::physics

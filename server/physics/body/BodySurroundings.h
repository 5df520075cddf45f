// Finds the Objects without mass near many bodies.
//
// Bodies close to each other share a query of the world's grid: in a heap each query returns the whole heap.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/world/WorldStore.h"
#include "physics/body/WorldNames.h"

namespace naiad::physics {

class BodySurroundings {
 public:
  void clear() { m_regions.clear(); }
  /// Adds a region to the next query. Regions are numbered from 0 since clear().
  void addRegion(const FixedBox& region);
  /// Calls visit(number, key) for each Object in the store's grid that is not a body and touches the region
  /// with that number, edges included. The order is by numbers, then by creation.
  template <class Visit>
  void query(const WorldStore& store, Visit visit) {
    search(store);
    for (const Found& found : m_found) visit(static_cast<std::size_t>(found.number), found.key);
  }

 private:
  struct Region {
    std::int64_t tile_x, tile_y;
    std::uint32_t number;
    FixedBox region;
  };
  struct Found {
    std::uint32_t number;
    std::uint32_t turn;  // index in creation order
    ObjectKey key;
  };
  struct Other {
    ObjectKey key;
    FixedBox box;  // in world coordinates
  };
  void search(const WorldStore& store);
  bool listOthers(const WorldStore& store);
  void searchOthers();
  void searchGrid(const WorldStore& store);

  std::vector<Region> m_regions;
  std::vector<Found> m_found;
  std::vector<ObjectKey> m_near;
  std::vector<Other> m_others, m_close;  // sorted by creation order
};

}  // namespace naiad::physics

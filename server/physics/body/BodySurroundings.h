// The Objects without mass that are near many bodies.
//
// The world's grid is asked once for bodies that are in one place, not once for each: in a heap each question
// would find the heap again.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/world/WorldStore.h"
#include "physics/body/WorldNames.h"

namespace naiad::physics {

class BodySurroundings {
 public:
  void clear() { m_regions.clear(); }
  /// Adds a region to the next query. The first since clear() has number 0, the next 1, and so on.
  void addRegion(const FixedBox& region);
  /// Calls visit(number, key) for each Object in the store's grid that is no body and touches the region of
  /// that number, edges included: by numbers, then in creation order.
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
    std::uint32_t turn;  // in creation order
    ObjectKey key;
  };
  struct Other {
    ObjectKey key;
    FixedBox box;  // in the world
  };
  void search(const WorldStore& store);
  bool listOthers(const WorldStore& store);
  void searchOthers();
  void searchGrid(const WorldStore& store);

  std::vector<Region> m_regions;
  std::vector<Found> m_found;
  std::vector<ObjectKey> m_near;
  std::vector<Other> m_others, m_close;  // in creation order
};

}  // namespace naiad::physics

// From where one client's positions are counted: a window around its view, so that they take few bits.
//
// A view that leaves the window gets another one, in another slot; snapshots name it only once the client has
// confirmed it.
#pragma once

#include <array>
#include <cstdint>

#include "shared/replica/SnapshotCodec.h"

namespace naiad {

class OriginChoice {
 public:
  /// The view is here now. The slot that the client has to be told of anew; 0: none.
  std::uint32_t note(CellPosition view_corner, const WorldRecord& world, std::uint64_t newest_order);
  /// The client has what the slot holds now.
  void arrived(std::uint32_t slot);

  /// The slot that snapshots name; 0: none yet.
  std::uint32_t slot() const { return m_slot; }
  const Origin& window() const { return m_origins[m_slot]; }
  const Origin& at(std::uint32_t slot) const { return m_origins[slot]; }

 private:
  std::array<Origin, kOriginSlots + 1> m_origins;
  std::uint32_t m_slot = 0;
  std::uint32_t m_newest = 0;  ///< the slot set last
};

}  // namespace naiad

// The origin of one client's positions: a window around its view, so that positions take few bits.
//
// A view that leaves the window gets another one, in another slot. Snapshots name the new slot only once the
// client has confirmed it.
#pragma once

#include <array>
#include <cstdint>

#include "shared/replica/SnapshotCodec.h"

namespace naiad {

class OriginChoice {
 public:
  /// The view has moved. Returns the slot whose window has to be sent; 0: none.
  std::uint32_t updateWindow(CellPosition view_corner, const WorldRecord& world, std::uint64_t newest_order);
  /// The client has received the slot as it is now.
  void confirmArrival(std::uint32_t slot);

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

// One slot of the published world, and the cells in which it may be drawn.
#pragma once

#include <cstdint>

#include "host/snapshot/InterestGrid.h"
#include "shared/replica/Limits.h"
#include "shared/replica/Records.h"

namespace naiad {

/// The slot under which characters drawn outside any object's draw() are published.
inline constexpr std::uint32_t kLooseSlot = kMaxSlots - 1;

struct PublishedModel {
  /// A model that reaches more cells than this is in every client's interest.
  static constexpr std::int32_t kWide = 24;

  std::uint32_t generation = 0;
  bool alive = false;
  ObjectState state;
  std::uint64_t look_sum = 0;  ///< of the sequence; 0 if it is one character or none
  bool recurs = false;         ///< the look was published before, or changes by itself: worth a name
  std::int32_t reach = 0;      ///< cells from its own that its characters may be drawn in, at most
};

/// The cells in which something of a model may be drawn.
struct ModelOutlook {
  std::uint32_t generation = 0;  ///< 0: the slot is empty
  CompactRect soon;              ///< now, or at the end of some ticks
  CompactRect later;             ///< at any time in these and some more
};

/// As PublishedModel::reach, from its look and body.
std::int32_t reachOf(const PublishedModel& model);
/// The cells in which something of the model may be drawn from `tick` to `ticks` later, and some more.
CellRect sweepOf(const PublishedModel& model, std::uint32_t tick, std::uint32_t ticks);
/// `soon`, `later`: ticks from `tick`.
ModelOutlook outlookOf(const PublishedModel& model, std::uint32_t tick, std::uint32_t soon,
                       std::uint32_t later);

}  // namespace naiad

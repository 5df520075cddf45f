// One slot of the published world, and the cells in which its model may be drawn.
#pragma once

#include <cstdint>

#include "host/snapshot/InterestGrid.h"
#include "shared/replica/Limits.h"
#include "shared/replica/Records.h"

namespace naiad {

/// Slot of the model of all characters that were drawn outside any object's draw().
inline constexpr std::uint32_t kFreeDrawSlot = kMaxSlots - 1;

struct PublishedModel {
  /// Number of cells: a model with a greater reach is of interest to every client.
  static constexpr std::int32_t kWide = 24;

  std::uint32_t generation = 0;
  bool alive = false;
  ObjectState state;
  std::uint64_t look_sum = 0;  ///< checksum of the sequence; 0 if it is empty or a single character
  bool recurs = false;         ///< the look was published before or is animated, so an id for it saves bytes
  std::int32_t reach = 0;      ///< upper bound of the distance of its characters from its position, in cells
};

/// The cells in which any part of a model may be drawn.
struct DrawForecast {
  std::uint32_t generation = 0;  ///< 0: the slot is empty
  CompactRect soon;              ///< box around the cells now and forecastOf()'s `soon` ticks later
  CompactRect later;             ///< cells in all ticks from now until `later` ticks later, and some more
};

/// Computes PublishedModel::reach from the model's look and body.
std::int32_t reachOf(const PublishedModel& model);
/// Returns a rectangle of all cells in which the model may be drawn from `tick` to `tick + ticks`.
CellRect sweepOf(const PublishedModel& model, std::uint32_t tick, std::uint32_t ticks);
/// Computes the forecast. `soon` and `later` are numbers of ticks after `tick`.
DrawForecast forecastOf(const PublishedModel& model, std::uint32_t tick, std::uint32_t soon,
                        std::uint32_t later);

}  // namespace naiad

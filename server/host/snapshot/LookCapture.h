// From what draw() put on the screen to a look, and back: does a published look draw the same cells?
#pragma once

#include <cstddef>
#include <span>

#include "engine/world/WorldView.h"
#include "shared/replica/Look.h"

namespace naiad {

/// Would `look`, at `tick` and `position`, put exactly these characters into exactly these cells?
bool drawsTheSame(const Look& look, std::uint32_t tick, df::FixedVector position,
                  std::span<const df::DrawCommand> commands);

/// The appearance of an object at `position` that drew `commands`: offsets rounded to 1/256 cell, which is
/// what was meant where game code went through floats.
Appearance captureAppearance(df::FixedVector position, std::span<const df::DrawCommand> commands);

/// As above, with offsets in whole cells from the cell that `position` lies in: right at this position
/// whatever the rounding.
Appearance captureCells(df::FixedVector position, std::span<const df::DrawCommand> commands);

/// A sequence of this alone, with characters cut off its end until it fits kMaxLookBytes.
Sequence fitToRecord(Appearance appearance);

}  // namespace naiad

// Converts what draw() put on the screen to a look, and checks whether a look draws what draw() did.
#pragma once

#include <cstddef>
#include <span>

#include "engine/world/WorldView.h"
#include "shared/replica/Look.h"

namespace naiad {

/// True if `look`, at `tick` and `position`, puts exactly these characters into exactly these cells.
bool drawsTheSame(const Look& look, std::uint32_t tick, df::FixedVector position,
                  std::span<const df::DrawCommand> commands);

/// Returns the appearance of an object at `position` that drew `commands`. Offsets are rounded to 1/256 cell,
/// which removes the rounding errors of game code that computes in floats.
Appearance captureAppearance(df::FixedVector position, std::span<const df::DrawCommand> commands);

/// Like captureAppearance(), but with offsets in whole cells from the cell of `position`. It draws the right
/// cells at this position, whatever the rounding.
Appearance captureCells(df::FixedVector position, std::span<const df::DrawCommand> commands);

/// Returns a sequence of this appearance alone, without the last characters if it would exceed kMaxLookBytes.
Sequence fitToRecord(Appearance appearance);

}  // namespace naiad

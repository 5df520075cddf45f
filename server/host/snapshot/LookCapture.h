// Converts the characters that draw() drew to a look, and checks whether a look draws the same characters.
#pragma once

#include <cstddef>
#include <span>

#include "engine/world/WorldView.h"
#include "shared/replica/Look.h"

namespace naiad {

/// True if `look`, at `tick` and `position`, draws exactly the characters of `commands`, in exactly their
/// cells.
bool drawsTheSame(const Look& look, std::uint32_t tick, df::FixedVector position,
                  std::span<const df::DrawCommand> commands);

/// Returns the appearance of an object at `position` that drew `commands`. Offsets are rounded to 1/256 cell,
/// which removes the rounding errors of game code that computes in floats.
Appearance captureAppearance(df::FixedVector position, std::span<const df::DrawCommand> commands);

/// Like captureAppearance(), but with offsets in whole cells from the cell of `position`. It draws the right
/// cells at this position, however the offsets would be rounded.
Appearance captureCells(df::FixedVector position, std::span<const df::DrawCommand> commands);

/// Returns a sequence of only this appearance, without the last characters if all exceed kMaxLookBytes.
Sequence fitToRecord(Appearance appearance);

}  // namespace naiad

// Converts the characters that draw() drew to a look, and checks whether a look draws the same characters.
#pragma once

#include <cstddef>
#include <span>

#include "engine/world/WorldView.h"
#include "shared/replica/Look.h"

namespace naiad {

/// True if `look`, at `tick` and `position`, draws exactly the characters of `commands` in their cells.
bool drawsTheSame(const Look& look, std::uint32_t tick, df::FixedVector position,
                  std::span<const df::DrawCommand> commands);

/// Returns the appearance of an object at `position` that drew `commands`. Offsets are rounded to 1/256 cell,
/// which removes the rounding errors of game code that computes in floats. Characters too far away to be
/// encoded, or beyond kMaxGlyphs, are omitted.
Appearance captureAppearance(df::FixedVector position, std::span<const df::DrawCommand> commands);

/// Like captureAppearance(), but with offsets in whole cells from the cell of `position`. So it draws the
/// right cells at this position even where rounded offsets would not.
Appearance captureCells(df::FixedVector position, std::span<const df::DrawCommand> commands);

/// Returns a sequence of only this appearance, without its last characters if otherwise the encoded sequence
/// would exceed kMaxLookBytes.
Sequence fitToRecord(Appearance appearance);

}  // namespace naiad

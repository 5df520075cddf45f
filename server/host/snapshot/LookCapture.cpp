#include "host/snapshot/LookCapture.h"

#include <algorithm>
#include <cstdlib>

#include "shared/replica/Limits.h"
#include "shared/replica/LookCodec.h"

namespace naiad {

namespace {

CellPosition cellOfCommand(const df::DrawCommand& command) {
  return {df::cellOf(command.position.x), df::cellOf(command.position.y)};
}

/// Appends a glyph unless it is too far away to be encoded, or `out` has kMaxGlyphs already.
void append(Appearance& out, std::int64_t dx, std::int64_t dy, const df::DrawCommand& command) {
  if (std::max(std::abs(dx), std::abs(dy)) > kMaxGlyphOffset || out.size() >= kMaxGlyphs) return;
  out.push_back({static_cast<std::int32_t>(dx), static_cast<std::int32_t>(dy), command.ch, command.color});
}

}  // namespace

bool drawsTheSame(const Look& look, std::uint32_t tick, df::FixedVector position,
                  std::span<const df::DrawCommand> commands) {
  const Appearance* appearance = look.select(tick);
  if (appearance == nullptr) return commands.empty();
  return std::equal(appearance->begin(), appearance->end(), commands.begin(), commands.end(),
                    [position](const Glyph& glyph, const df::DrawCommand& command) {
                      return glyph.ch == command.ch && glyph.color == command.color &&
                             glyphCell(position, glyph) == cellOfCommand(command);
                    });
}

Appearance captureAppearance(df::FixedVector position, std::span<const df::DrawCommand> commands) {
  constexpr int kShift = df::kFixedBits - kGlyphUnitBits;
  // The subtraction is unsigned, because two legal positions may be farther apart than the signed type can
  // hold. The wrapped offset is then far beyond kMaxGlyphOffset, like the true one.
  const auto offset = [](df::Fixed to, df::Fixed from) {
    constexpr std::uint64_t kHalf = std::uint64_t{1} << (kShift - 1);
    return static_cast<std::int64_t>(static_cast<std::uint64_t>(to) - static_cast<std::uint64_t>(from) +
                                     kHalf) >>
           kShift;
  };
  Appearance appearance;
  for (const df::DrawCommand& command : commands) {
    append(appearance, offset(command.position.x, position.x), offset(command.position.y, position.y),
           command);
  }
  return appearance;
}

Appearance captureCells(df::FixedVector position, std::span<const df::DrawCommand> commands) {
  const CellPosition base{df::cellOf(position.x), df::cellOf(position.y)};
  Appearance appearance;
  for (const df::DrawCommand& command : commands) {
    const CellPosition cell = cellOfCommand(command);
    append(appearance, (std::int64_t{cell.x} - base.x) << kGlyphUnitBits,
           (std::int64_t{cell.y} - base.y) << kGlyphUnitBits, command);
  }
  return appearance;
}

Sequence fitToRecord(Appearance appearance) {
  constexpr std::size_t kMaxBits = 128;  // upper bound of the bits of a glyph
  Sequence fitted{appearance};
  while (appearance.size() * kMaxBits > 8 * kMaxLookBytes && encodedBits(fitted) > 8 * kMaxLookBytes) {
    appearance.resize(appearance.size() - (appearance.size() / 8 + 1));
    fitted = Sequence{appearance};
  }
  return fitted;
}

}  // namespace naiad

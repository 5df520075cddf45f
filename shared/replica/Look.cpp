#include "Look.h"

namespace naiad {

CellPosition glyphCell(df::FixedVector position, const Glyph& glyph) {
  constexpr int kShift = df::kFixedBits - kGlyphUnitBits;
  const auto cell = [](df::Fixed base, std::int32_t units) {
    const auto sum =
        static_cast<std::uint64_t>(base) + (static_cast<std::uint64_t>(std::int64_t{units}) << kShift);
    return df::cellOf(static_cast<df::Fixed>(sum));
  };
  return {cell(position.x, glyph.dx), cell(position.y, glyph.dy)};
}

const Appearance* Look::select(std::uint32_t /*tick*/) const {
  return sequence.empty() ? nullptr : &sequence.front();
}

}  // namespace naiad

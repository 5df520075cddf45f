#include "shared/replica/Look.h"

#include <algorithm>
#include <cstdlib>

#include "shared/replica/Mixer.h"

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

Sequence::Sequence(std::vector<Appearance> frames) {
  if (frames.empty()) return;
  constexpr std::int32_t kPart = (1 << kGlyphUnitBits) - 1;
  constexpr std::int32_t kHalf = 1 << (kGlyphUnitBits - 1);
  Data data;
  bool first = true;
  Mixer mixer;
  mixer.add(frames.size());
  for (const Appearance& appearance : frames) {
    mixer.add(appearance.size());
    data.glyphs += appearance.size();
    for (const Glyph& glyph : appearance) {
      mixer.add((static_cast<std::uint64_t>(static_cast<std::uint32_t>(glyph.dx)) << 32) |
                static_cast<std::uint32_t>(glyph.dy));
      mixer.add((static_cast<std::uint64_t>(glyph.ch) << 8) | static_cast<std::uint64_t>(glyph.color));
      data.reach = std::max({data.reach, std::abs(glyph.dx), std::abs(glyph.dy)});
      const CellPosition fraction{glyph.dx & kPart, glyph.dy & kPart};
      if (std::exchange(first, false)) data.fraction = fraction;
      data.whole =
          data.whole && fraction == data.fraction && fraction.x % kHalf == 0 && fraction.y % kHalf == 0;
    }
  }
  data.sum = mixer.value();
  data.frames = std::move(frames);
  m_p_data = std::make_shared<const Data>(std::move(data));
}

const std::vector<Appearance>& Sequence::frames() const {
  static const std::vector<Appearance> kNone;
  return empty() ? kNone : m_p_data->frames;
}

Look rebase(const Look& look, std::uint32_t tick) {
  Look rebased = look;
  if (!look.sequence.empty()) rebased.selector = look.selector.rebased(tick, look.sequence.size());
  return rebased;
}

}  // namespace naiad

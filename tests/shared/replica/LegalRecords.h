// Checks that all numbers of records are in range, as a reader must ensure.
#pragma once

#include <algorithm>
#include <cstdlib>

#include "shared/replica/Limits.h"
#include "shared/replica/Records.h"

namespace naiad::test {

inline bool isWithinCells(df::FixedVector v, std::int64_t most_cells) {
  const df::Fixed most = most_cells << df::kFixedBits;
  return v.x >= -most && v.x <= most && v.y >= -most && v.y <= most;
}

inline bool isLegal(df::Color color) {
  return color >= 0 && color < df::kColorCount;
}

inline bool isLegal(const Motion& m, std::uint32_t tick) {
  return m.tick == tick && isWithinCells(m.position, 2'100'000'000) && isWithinCells(m.velocity, 1 << 25) &&
         isWithinCells(m.acceleration, 1 << 25);
}

inline bool isLegal(const Look& look, std::uint32_t tick) {
  const auto glyph = [](const Glyph& g) {
    return std::abs(g.dx) <= kMaxGlyphOffset && std::abs(g.dy) <= kMaxGlyphOffset && df::isDrawable(g.ch) &&
           isLegal(g.color);
  };
  return look.altitude >= 0 && look.altitude <= 255 && look.sequence.size() <= kMaxFrames &&
         look.sequence.glyphCount() <= kMaxGlyphs &&
         (look.sequence.empty() || look.selector.isCanonical(tick, look.sequence.size())) &&
         std::all_of(look.sequence.begin(), look.sequence.end(), [&](const Appearance& a) {
           return a.size() <= kMaxGlyphs && std::all_of(a.begin(), a.end(), glyph);
         });
}

inline bool isLegal(const Body& body) {
  return isWithinCells(body.box.corner, 1'000'001) && isWithinCells(body.box.size, 1'000'001) &&
         body.box.size.x >= 0 && body.box.size.y >= 0 && body.solidness >= df::HARD &&
         body.solidness <= df::SPECTRAL && (!body.on_view || body.solidness == df::SPECTRAL);
}

inline bool isLegal(const ObjectRecord& record, std::uint32_t tick) {
  const bool birth = (record.groups & kLife) != 0;
  const bool moves = (record.groups & kMotion) != 0;
  return record.id < kMaxSlots && record.generation < 4 && (!birth || record.groups == kAllGroups) &&
         record.groups <= kAllGroups && record.state.order >> 48 == 0 &&
         isLegal(record.state.motion, moves ? tick : 0) && isLegal(record.state.look, tick) &&
         isLegal(record.state.body);
}

inline bool isLegal(const WorldRecord& r) {
  return isWithinCells(r.boundary.corner, 2'100'000'000) && r.boundary.size.x >= 0 &&
         r.boundary.size.y >= 0 && r.view_width >= kMinViewWidth && r.view_width <= kMaxViewWidth &&
         r.view_height >= kMinViewHeight && r.view_height <= kMaxViewHeight && r.background >= df::BLACK &&
         r.background <= df::WHITE;
}

inline bool isLegal(const ViewRecord& r) {
  return isWithinCells(r.corner, 2'100'000'000) && r.id < kMaxSlots && r.generation < 4 &&
         (r.follows || (r.id == 0 && r.generation == 0));
}

inline bool isLegal(const OriginRecord& r) {
  return r.slot >= 1 && r.slot <= kOriginSlots && r.origin.x_bits >= 0 && r.origin.x_bits <= 15 &&
         r.origin.y_bits >= 0 && r.origin.y_bits <= 15 && r.origin.order >> 48 == 0;
}

inline bool isLegal(const TextRecord& text) {
  const std::u32string characters = df::decodeUtf8(text.text);
  return text.id < kMaxTexts && std::abs(text.x) <= kMaxViewWidth && std::abs(text.y) <= kMaxViewHeight &&
         characters.size() <= static_cast<std::size_t>(kMaxViewWidth) && isLegal(text.color) &&
         std::all_of(characters.begin(), characters.end(), df::isDrawable);
}

inline bool isLegal(const Records& records, std::uint32_t tick) {
  const auto all = [](const auto& some) {
    return std::all_of(some.begin(), some.end(), [](const auto& one) { return isLegal(one); });
  };
  const auto& objects = records.objects;
  return records.worlds.size() <= 1 && records.views.size() <= 1 && records.texts.size() <= kMaxTexts &&
         all(records.worlds) && all(records.views) && all(records.origins) && all(records.texts) &&
         std::all_of(objects.begin(), objects.end(),
                     [tick](const ObjectRecord& r) { return isLegal(r, tick); }) &&
         std::adjacent_find(objects.begin(), objects.end(),
                            [](const auto& a, const auto& b) { return a.id >= b.id; }) == objects.end();
}

}  // namespace naiad::test

// Random valid records, with small and with extreme numbers.
#pragma once

#include <map>

#include "shared/replica/Limits.h"
#include "shared/replica/SnapshotCodec.h"
#include "shared/values/SplitMix64.h"

namespace naiad::test {

class RandomRecords {
 public:
  explicit RandomRecords(std::uint64_t seed) : m_rng(seed) {}

  SplitMix64& rng() { return m_rng; }
  bool chance(double p) { return m_rng.unit() < p; }
  /// Returns a uniform number in -most … most.
  std::int64_t within(std::int64_t most) {
    const auto span = static_cast<std::uint64_t>(most);
    return static_cast<std::int64_t>(m_rng.below(2 * span + 1) - span);
  }
  /// Returns a number with any number of fractional bits.
  df::Fixed coordinate(std::int64_t most_cells) {
    if (chance(0.1)) return (chance(0.5) ? 1 : -1) * (most_cells << df::kFixedBits);
    const df::Fixed exact = within((chance(0.5) ? most_cells : 100) << df::kFixedBits);
    return chance(0.3) ? exact : exact & -(df::Fixed{1} << m_rng.below(df::kFixedBits + 1));
  }
  df::FixedVector vector(std::int64_t most_cells) {
    const df::Fixed x = coordinate(most_cells);
    return {x, coordinate(most_cells)};
  }
  df::FixedVector size(std::int64_t most_cells) {
    const df::FixedVector v = vector(most_cells);
    return {std::abs(v.x), std::abs(v.y)};
  }
  df::Color color() { return static_cast<df::Color>(m_rng.below(df::kColorCount)); }
  char32_t character() {
    static constexpr char32_t kSome[] = {U' ', U'~', U'é', U'Ω', U'─', U'█', U'⠿'};
    return chance(0.3) ? kSome[m_rng.below(std::size(kSome))] : U'a' + static_cast<char32_t>(m_rng.below(26));
  }

  Motion motion(std::uint32_t tick) {
    Motion m{tick, vector(2'000'000'000), {}, {}};
    if (chance(0.6)) m.velocity = vector(1 << 24);
    if (chance(0.3)) m.acceleration = vector(1 << 24);
    return m;
  }
  Look look() {
    Look look{{}, static_cast<std::int32_t>(m_rng.below(256))};
    if (chance(0.2)) return look;
    std::vector<Appearance> frames(chance(0.6) ? 1 : 1 + m_rng.below(chance(0.05) ? kMaxFrames : 8));
    const bool whole = chance(0.5);
    const auto half_x = static_cast<std::int32_t>(128 * m_rng.below(2));
    const auto half_y = static_cast<std::int32_t>(128 * m_rng.below(2));
    for (Appearance& glyphs : frames) {
      glyphs = appearance(whole, frames.size() < 9 ? 300 : 12);
      for (Glyph& glyph : glyphs) {
        if (whole && glyph.dx < kMaxGlyphOffset && glyph.dy < kMaxGlyphOffset)
          glyph = {glyph.dx + half_x, glyph.dy + half_y, glyph.ch, glyph.color};
      }
    }
    look.sequence = Sequence(std::move(frames));
    look.selector = selector(look.sequence.size());
    return look;
  }
  /// Returns a selector for this many frames, as sent in tick 0.
  Selector selector(std::size_t frames) {
    const std::size_t first = m_rng.below(frames);
    if (frames == 1 || chance(0.3)) return Selector::fixed(first);
    if (chance(0.5)) {
      const auto angle = static_cast<std::uint32_t>(m_rng.next() << m_rng.below(33));
      const auto spin = static_cast<std::int32_t>(within(INT32_MAX) >> m_rng.below(33));
      return Selector::turning(0, angle, chance(0.05) ? INT32_MIN : spin);
    }
    const auto ticks = static_cast<std::uint32_t>(1 + m_rng.below(chance(0.1) ? kMaxTicksPerFrame : 30));
    const bool loop = chance(0.5);
    Selector clock = Selector::clock(0, ticks, loop, first);
    clock.start -= static_cast<std::uint32_t>(m_rng.below(ticks));
    return clock.rebased(0, frames);
  }
  Appearance appearance(bool whole, std::uint64_t most) {
    Appearance glyphs;
    const auto count = m_rng.below(chance(0.1) ? most : 12);
    for (std::uint64_t i = 0; i < count; ++i) {
      const bool next = i > 0 && chance(0.7);
      const std::int64_t mask = whole ? ~std::int64_t{255} : ~std::int64_t{0};
      const auto dx =
          next ? glyphs.back().dx + 256 : within(chance(0.2) ? kMaxGlyphOffset - 256 * 300 : 2000) & mask;
      const auto dy = next ? glyphs.back().dy : within(chance(0.2) ? kMaxGlyphOffset : 2000) & mask;
      glyphs.push_back({static_cast<std::int32_t>(dx), static_cast<std::int32_t>(dy),
                        next && chance(0.3) ? glyphs.back().ch : character(),
                        next && chance(0.8) ? glyphs.back().color : color()});
    }
    return glyphs;
  }
  Body body() {
    const auto solidness = static_cast<df::Solidness>(m_rng.below(3));
    return {{vector(1'000'000), size(1'000'000)},
            solidness,
            chance(0.5),
            solidness == df::SPECTRAL && chance(0.5)};
  }
  ObjectState state(std::uint32_t tick) {
    return {chance(0.2) ? m_rng.next() >> 16 : m_rng.below(5000), motion(tick), rebase(look(), tick), body()};
  }
  /// Returns a record in which only the parts that `groups` lists have values.
  ObjectRecord object(std::uint32_t tick) {
    ObjectRecord record;
    record.id = static_cast<std::uint32_t>(m_rng.below(chance(0.2) ? kMaxSlots : 300));
    record.groups = chance(0.3) ? kAllGroups : static_cast<std::uint8_t>(m_rng.below(8) << 1);
    const ObjectState all = state(tick);
    if ((record.groups & kLife) != 0) {
      record.generation = static_cast<std::uint8_t>(m_rng.below(4));
      record.state.order = all.order;
    }
    if ((record.groups & kMotion) != 0) record.state.motion = all.motion;
    if ((record.groups & kLook) != 0) record.state.look = all.look;
    if ((record.groups & kBody) != 0) record.state.body = all.body;
    return record;
  }
  WorldRecord world() {
    return {{vector(1'000'000), size(1'000'000)},
            static_cast<std::int32_t>(20 + m_rng.below(381)),
            static_cast<std::int32_t>(10 + m_rng.below(141)),
            static_cast<df::Color>(m_rng.below(df::kColorCount))};
  }
  ViewRecord view() {
    ViewRecord record{vector(2'000'000'000), chance(0.7), 0, 0};
    if (!record.follows) return record;
    record.id = static_cast<std::uint32_t>(m_rng.below(chance(0.5) ? kMaxSlots : 100));
    record.generation = static_cast<std::uint8_t>(m_rng.below(4));
    return record;
  }
  Origin origin() {
    return {{static_cast<std::int32_t>(within(chance(0.2) ? 2'000'000'000 : 100)),
             static_cast<std::int32_t>(within(chance(0.2) ? 2'000'000'000 : 100))},
            static_cast<std::int32_t>(m_rng.below(16)),
            static_cast<std::int32_t>(m_rng.below(16)),
            chance(0.5) ? m_rng.next() >> 16 : m_rng.below(5000)};
  }
  OriginRecord originRecord() {
    return {1 + static_cast<std::uint32_t>(m_rng.below(kOriginSlots)), origin()};
  }
  TextRecord text() {
    TextRecord record{static_cast<std::uint32_t>(m_rng.below(kMaxTexts)),
                      static_cast<std::int32_t>(within(400)), static_cast<std::int32_t>(within(150)), color(),
                      ""};
    for (auto n = m_rng.below(30); n > 0; --n) df::appendUtf8(record.text, character());
    return record;
  }
  SnapshotHeader header() {
    SnapshotHeader header;
    header.number = static_cast<std::uint32_t>(m_rng.next()) | 1;
    header.tick = static_cast<std::uint32_t>(m_rng.next());
    header.epoch = static_cast<std::uint8_t>(m_rng.below(4));
    header.complete = chance(0.5);
    header.has_input = chance(0.5);
    if (!header.has_input) return header;
    header.input = static_cast<std::uint32_t>(m_rng.next());
    header.input_tick = header.tick - static_cast<std::uint32_t>(m_rng.below(64));
    return header;
  }
  /// Returns records with all objects in ascending order of ids, and no named appearances.
  Records records(std::uint32_t tick) {
    Records all;
    if (chance(0.3)) all.worlds.push_back(world());
    if (chance(0.3)) all.views.push_back(view());
    for (auto n = chance(0.2) ? m_rng.below(4) : 0; n > 0; --n) all.origins.push_back(originRecord());
    for (auto n = m_rng.below(3); n > 0; --n) all.texts.push_back(text());
    std::map<std::uint32_t, ObjectRecord> by_id;
    for (auto n = m_rng.below(6); n > 0; --n) {
      ObjectRecord record = object(tick);
      by_id[record.id] = std::move(record);
    }
    for (auto& [id, record] : by_id) all.objects.push_back(std::move(record));
    return all;
  }

 private:
  SplitMix64 m_rng;
};

}  // namespace naiad::test

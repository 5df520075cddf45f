#include "SnapshotChecks.h"

#include <algorithm>

#include "Require.h"
#include "Script.h"
#include "shared/replica/Limits.h"
#include "shared/replica/MotionCodec.h"
#include "shared/values/Canvas.h"
#include "tests/support/WriteSnapshot.h"

namespace naiad::fuzz {
namespace {

bool staysWithin(df::FixedVector v, df::Fixed most) {
  return std::max(v.x, v.y) <= most && std::min(v.x, v.y) >= -most;
}

void requireGood(const Motion& motion, std::uint32_t tick) {
  REQUIRE(motion.tick == tick);
  REQUIRE(staysWithin(motion.position, kMaxWirePosition));
  REQUIRE(staysWithin(motion.velocity, kMaxWireVelocity) &&
          staysWithin(motion.acceleration, kMaxWireVelocity));
}

void requireGood(const Appearance& appearance) {
  REQUIRE(appearance.size() <= kMaxGlyphs);
  for (const Glyph& glyph : appearance) {
    REQUIRE(glyph.dx >= -kMaxGlyphOffset && glyph.dx <= kMaxGlyphOffset);
    REQUIRE(glyph.dy >= -kMaxGlyphOffset && glyph.dy <= kMaxGlyphOffset);
    REQUIRE(df::isDrawable(glyph.ch) && static_cast<unsigned>(glyph.color) < 8);
  }
}

void requireGood(const Sequence& sequence) {
  REQUIRE(sequence.size() <= kMaxFrames && sequence.glyphCount() <= kMaxGlyphs);
  for (const Appearance& appearance : sequence) requireGood(appearance);
}

void requireGood(const ObjectRecord& record, std::uint32_t tick) {
  REQUIRE(record.id < kMaxSlots && record.generation < 4 && record.groups <= kAllGroups);
  REQUIRE((record.groups & kLife) == 0 || record.groups == kAllGroups);
  REQUIRE(record.state.order < std::uint64_t{1} << 48);
  if ((record.groups & kMotion) != 0) requireGood(record.state.motion, tick);
  const Look& look = record.state.look;
  REQUIRE(look.altitude >= 0 && look.altitude < 256 && look.sequence.size() <= kMaxFrames);
  requireGood(look.sequence);
  REQUIRE(look.selector.isCanonical(tick, look.sequence.size()));
  const Body& body = record.state.body;
  REQUIRE(body.box.size.x >= 0 && body.box.size.y >= 0);
  REQUIRE(static_cast<unsigned>(body.solidness) <= df::SPECTRAL);
  REQUIRE(!body.on_view || body.solidness == df::SPECTRAL);
}

void requireGood(const Snapshot& snapshot) {
  const Records& records = snapshot.records;
  REQUIRE(snapshot.header.number != 0 && snapshot.header.epoch < 4);
  REQUIRE(records.worlds.size() <= 1 && records.views.size() <= 1 && records.origins.size() <= kOriginSlots);
  for (const WorldRecord& world : records.worlds) {
    REQUIRE(world.view_width >= kMinViewWidth && world.view_width <= kMaxViewWidth);
    REQUIRE(world.view_height >= kMinViewHeight && world.view_height <= kMaxViewHeight);
    REQUIRE(world.background >= df::BLACK && world.background <= df::WHITE);
    REQUIRE(world.boundary.size.x >= 0 && world.boundary.size.y >= 0);
  }
  for (const ViewRecord& view : records.views) REQUIRE(view.id < kMaxSlots && view.generation < 4);
  for (const OriginRecord& origin : records.origins) REQUIRE(origin.slot >= 1 && origin.slot <= kOriginSlots);
  REQUIRE(records.texts.size() <= kMaxTexts);
  for (const TextRecord& text : records.texts) {
    REQUIRE(text.id < kMaxTexts);
    const std::u32string characters = df::decodeUtf8(text.text);
    REQUIRE(characters.size() <= static_cast<std::size_t>(kMaxViewWidth));
    REQUIRE(std::all_of(characters.begin(), characters.end(), df::isDrawable));
  }
  for (const SequenceRecord& record : records.sequences) {
    REQUIRE(record.id < kMaxAppearances);
    requireGood(record.sequence);
  }
  for (std::size_t i = 0; i < records.objects.size(); ++i) {
    requireGood(records.objects[i], snapshot.header.tick);
    REQUIRE(i == 0 || records.objects[i - 1].id < records.objects[i].id);
  }
}

bool same(const ObjectRecord& a, const ObjectRecord& b) {
  return a.id == b.id && a.generation == b.generation && a.groups == b.groups && a.state == b.state;
}

/// Requires that the snapshot, written without names and origins, decodes to equal records.
void requireSameWhenWrittenAgain(const Snapshot& snapshot) {
  const Records& records = snapshot.records;
  const Exactly bytes(test::writeSnapshot(snapshot.header, snapshot.records));
  const SnapshotHeader& header = snapshot.header;
  Snapshot again;
  REQUIRE(readSnapshot(bytes.view(), {header.number, header.tick, header.input}, {}, again) ==
          ReadResult::kOk);
  REQUIRE(again.header.number == header.number && again.header.tick == header.tick);
  REQUIRE(again.header.epoch == header.epoch && again.header.complete == header.complete);
  REQUIRE(again.header.has_input == header.has_input && again.header.input == header.input);
  REQUIRE(again.header.input_tick == header.input_tick);
  REQUIRE(again.records.worlds == records.worlds && again.records.views == records.views);
  REQUIRE(again.records.origins == records.origins && again.records.texts == records.texts);
  REQUIRE(std::equal(records.objects.begin(), records.objects.end(), again.records.objects.begin(),
                     again.records.objects.end(), same));
}

std::size_t glyphsIn(const Records& records) {
  std::size_t count = 0;
  for (const ObjectRecord& record : records.objects) count += record.state.look.sequence.glyphCount();
  return count;
}

}  // namespace

void receiveAndCheck(Replica& replica, std::string_view received, bool again) {
  constexpr std::size_t kSmall = 20'000;  // glyphs; a snapshot with more is not written again, to save time
  const Exactly bytes(received);
  Snapshot snapshot;
  peekEpoch(bytes.view());
  if (replica.read(bytes.view(), snapshot) != ReadResult::kOk) return;
  requireGood(snapshot);
  if (glyphsIn(snapshot.records) <= kSmall) requireSameWhenWrittenAgain(snapshot);
  replica.apply(snapshot);
  const std::uint64_t sum = replica.checksum();
  replica.apply(snapshot);
  REQUIRE(replica.checksum() == sum);
  std::size_t alive = 0;
  for (const auto& [id, entry] : replica.entries()) alive += entry.alive ? 1 : 0;
  REQUIRE(replica.aliveCount() == alive);
  if (again && replica.read(bytes.view(), snapshot) == ReadResult::kOk) replica.apply(snapshot);
}

void drawAndCheck(const Replica& replica, std::uint32_t tick) {
  const df::Canvas canvas = replica.render(tick);
  REQUIRE(canvas.width() == replica.viewWidth() && canvas.height() == replica.viewHeight());
  const CellPosition focus = replica.focus(tick);
  REQUIRE(focus.x >= 0 && focus.x < canvas.width() && focus.y >= 0 && focus.y < canvas.height());
}

}  // namespace naiad::fuzz

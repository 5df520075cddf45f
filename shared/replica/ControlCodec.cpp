#include "shared/replica/ControlCodec.h"

#include <cassert>

#include "shared/replica/Bits.h"
#include "shared/replica/Bytes.h"
#include "shared/replica/Limits.h"
#include "shared/replica/MotionCodec.h"
#include "shared/values/FixedRange.h"

namespace naiad {

namespace {

using df::ControlEffect;
using df::ControlRow;
using df::ControlTable;

enum TableFlag : std::uint8_t { kBounded = 1, kWholeCells = 2 };

constexpr int kGenerationOrder = 1;
constexpr int kIdOrder = 6;
constexpr int kPullOrder = 33;
constexpr int kSilenceOrder = 2;
constexpr int kWaitOrder = 3;

void writeVector(ByteWriter& out, df::FixedVector v) {
  out.zigzag(v.x);
  out.zigzag(v.y);
}

df::FixedVector readVector(ByteReader& in, df::Fixed most) {
  const df::Fixed x = in.within(most);
  return {x, in.within(most)};
}

void writeRow(ByteWriter& out, const ControlRow& row) {
  out.byte(static_cast<std::uint8_t>(row.key));
  out.byte(static_cast<std::uint8_t>(row.action | static_cast<int>(row.effect) << 2 | (row.x ? 16 : 0) |
                                     (row.y ? 32 : 0)));
  writeVector(out, row.value);
  out.varint(row.wait);
  out.byte(row.group);
}

ControlRow readRow(ByteReader& in) {
  ControlRow row;
  row.key = static_cast<df::Keyboard::Key>(in.upTo(df::Keyboard::kKeyCount - 1));
  const std::uint8_t what = in.byte();
  if (what > 63 || (what & 3) > df::KEY_DOWN || (what >> 2 & 3) > static_cast<int>(ControlEffect::kDrive)) {
    in.fail();
    return {};
  }
  row.action = static_cast<df::EventKeyboardAction>(what & 3);
  row.effect = static_cast<ControlEffect>(what >> 2 & 3);
  row.x = (what & 16) != 0;
  row.y = (what & 32) != 0;
  row.value = readVector(in, df::kMaxControlReach);
  row.wait = static_cast<std::uint16_t>(in.upTo(df::kMaxControlTicks));
  row.group = in.byte();
  return row;
}

// A target velocity that equals the object's velocity, which is usual, takes only a flag.
void writeLever(BitWriter& out, const df::ControlAxis& lever, df::Fixed velocity) {
  out.flag(lever.is_released);
  out.flag(lever.target_velocity != 0);
  if (lever.target_velocity == 0) return;
  out.flag(lever.target_velocity == velocity);
  if (lever.target_velocity != velocity) out.signedGolomb(lever.target_velocity, kPullOrder);
}

df::ControlAxis readLever(BitReader& in, df::Fixed velocity) {
  df::ControlAxis lever;
  lever.is_released = in.flag();
  if (!in.flag()) return lever;
  lever.target_velocity = in.flag() ? velocity : in.signedGolomb(kPullOrder, df::kMaxControlReach);
  if (lever.target_velocity > df::kMaxControlReach || lever.target_velocity < -df::kMaxControlReach)
    in.fail();
  return lever;
}

void writeState(BitWriter& out, const df::ControlState& state, df::FixedVector velocity) {
  out.flag(state.steering);
  writeLever(out, state.x, velocity.x);
  writeLever(out, state.y, velocity.y);
  out.golomb(state.silence, kSilenceOrder);
  std::uint64_t waiting = 0;
  for (std::size_t i = 0; i < df::kControlGroups; ++i) waiting |= (state.wait[i] > 0 ? 1u : 0u) << i;
  out.flag(waiting != 0);
  if (waiting == 0) return;
  out.bits(waiting, df::kControlGroups);
  for (const std::uint16_t wait : state.wait) {
    if (wait > 0) out.golomb(wait, kWaitOrder);
  }
}

df::ControlState readState(BitReader& in, df::FixedVector velocity) {
  df::ControlState state;
  state.steering = in.flag();
  state.x = readLever(in, velocity.x);
  state.y = readLever(in, velocity.y);
  state.silence = static_cast<std::uint16_t>(in.golomb(kSilenceOrder, df::kMaxControlTicks));
  if (!in.flag()) return state;
  const std::uint64_t waiting = in.bits(df::kControlGroups);
  for (std::size_t i = 0; i < df::kControlGroups; ++i) {
    if ((waiting >> i & 1) != 0) {
      state.wait[i] = static_cast<std::uint16_t>(in.golomb(kWaitOrder, df::kMaxControlTicks));
    }
  }
  return state;
}

}  // namespace

void writeControlTable(std::string& out, const ControlTable& table) {
  assert(isValid(table));
  ByteWriter to(out);
  to.byte(static_cast<std::uint8_t>(table.rows.size()));
  to.byte(static_cast<std::uint8_t>((table.bounded ? kBounded : 0) | (table.whole_cells ? kWholeCells : 0)));
  to.varint(table.patience);
  if (table.bounded) {
    writeVector(to, table.bounds.corner);
    to.varint(static_cast<std::uint64_t>(table.bounds.size.x));
    to.varint(static_cast<std::uint64_t>(table.bounds.size.y));
  }
  for (const ControlRow& row : table.rows) writeRow(to, row);
}

std::optional<ControlTable> readControlTable(std::string_view bytes) {
  if (bytes.size() > kMaxControlTableBytes) return std::nullopt;
  ByteReader in(bytes);
  ControlTable table;
  const std::size_t rows = in.byte();
  const std::uint8_t flags = in.byte();
  if (rows > df::kMaxControlRows || flags > (kBounded | kWholeCells)) return std::nullopt;
  table.bounded = (flags & kBounded) != 0;
  table.whole_cells = (flags & kWholeCells) != 0;
  table.patience = static_cast<std::uint16_t>(in.upTo(df::kMaxControlTicks));
  if (table.bounded) {
    table.bounds.corner = readVector(in, df::kMaxPosition);
    table.bounds.size.x = static_cast<df::Fixed>(in.upTo(static_cast<std::uint64_t>(df::kMaxPosition)));
    table.bounds.size.y = static_cast<df::Fixed>(in.upTo(static_cast<std::uint64_t>(df::kMaxPosition)));
  }
  for (std::size_t i = 0; i < rows && in.ok(); ++i) table.rows.push_back(readRow(in));
  if (!in.ok() || !in.atEnd() || !isValid(table)) return std::nullopt;
  return table;
}

void writeControlRecord(BitWriter& out, const ControlRecord& record, const Origin& origin) {
  out.golomb(record.generation, kGenerationOrder);
  out.golomb(record.slot, kIdOrder);
  writeMotion(out, {record.tick, record.position, record.velocity, record.acceleration}, origin);
  writeState(out, record.state, record.velocity);
}

ControlRecord readControlRecord(BitReader& in, std::uint32_t tick, const Origin& origin) {
  ControlRecord record;
  record.tick = tick;
  record.generation = static_cast<std::uint32_t>(in.golomb(kGenerationOrder, UINT32_MAX));
  record.slot = static_cast<std::uint32_t>(in.golomb(kIdOrder, kMaxSlots - 1));
  const Motion motion = readMotion(in, tick, origin);
  record.position = motion.position;
  record.velocity = motion.velocity;
  record.acceleration = motion.acceleration;
  if (!isWithin(record.position, df::kMaxPosition) || !isWithin(record.velocity, df::kMaxVelocity) ||
      !isWithin(record.acceleration, df::kMaxVelocity)) {
    in.fail();
  }
  record.state = readState(in, record.velocity);
  return record;
}

void writeControlRecord(std::string& out, const ControlRecord& record) {
  BitWriter bits;
  bits.bits(record.newest_input, 32);
  writeControlRecord(bits, record, Origin{});
  out += bits.bytes();
}

std::optional<ControlRecord> readControlRecord(std::string_view bytes, std::uint32_t tick) {
  if (bytes.size() > kMaxControlRecordBytes) return std::nullopt;
  BitReader in(bytes);
  const auto newest_input = static_cast<std::uint32_t>(in.bits(32));
  ControlRecord record = readControlRecord(in, tick, Origin{});
  record.newest_input = newest_input;
  if (!in.atEnd()) return std::nullopt;
  return record;
}

}  // namespace naiad

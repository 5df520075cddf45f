#include "ControlCodec.h"

#include <cassert>

#include "Bytes.h"
#include "Limits.h"

namespace naiad {

namespace {

using df::ControlEffect;
using df::ControlRow;
using df::ControlTable;

constexpr df::Fixed kMaxPosition = static_cast<df::Fixed>(df::kMaxCells) * df::kFixedOne;
constexpr df::Fixed kMaxVelocity = static_cast<df::Fixed>(df::kMaxVelocityCells) * df::kFixedOne;

enum TableFlag : std::uint8_t { kBounded = 1, kWholeCells = 2 };
enum StateFlag : std::uint8_t { kSteering = 1, kLetGoX = 2, kLetGoY = 4 };

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

df::ControlState readState(ByteReader& in, std::uint8_t flags) {
  df::ControlState state;
  state.steering = (flags & kSteering) != 0;
  const df::FixedVector pulls = readVector(in, df::kMaxControlReach);
  state.x = {pulls.x, (flags & kLetGoX) != 0};
  state.y = {pulls.y, (flags & kLetGoY) != 0};
  state.silence = static_cast<std::uint16_t>(in.upTo(df::kMaxControlTicks));
  const std::uint8_t waiting = in.byte();
  for (std::size_t i = 0; i < df::kControlGroups; ++i) {
    if ((waiting >> i & 1) != 0) state.wait[i] = static_cast<std::uint16_t>(in.upTo(df::kMaxControlTicks));
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
    table.bounds.corner = readVector(in, kMaxPosition);
    table.bounds.size.x = static_cast<df::Fixed>(in.upTo(static_cast<std::uint64_t>(kMaxPosition)));
    table.bounds.size.y = static_cast<df::Fixed>(in.upTo(static_cast<std::uint64_t>(kMaxPosition)));
  }
  for (std::size_t i = 0; i < rows && in.ok(); ++i) table.rows.push_back(readRow(in));
  if (!in.ok() || !in.atEnd() || !isValid(table)) return std::nullopt;
  return table;
}

void writeControlRecord(std::string& out, const ControlRecord& record) {
  const df::ControlState& state = record.state;
  ByteWriter to(out);
  to.byte(static_cast<std::uint8_t>((state.steering ? kSteering : 0) | (state.x.let_go ? kLetGoX : 0) |
                                    (state.y.let_go ? kLetGoY : 0)));
  to.varint(record.slot);
  to.varint(record.generation);
  to.varint(record.newest_input);
  writeVector(to, record.position);
  writeVector(to, record.velocity);
  writeVector(to, record.acceleration);
  writeVector(to, {state.x.pull, state.y.pull});
  to.varint(state.silence);
  std::uint8_t waiting = 0;
  for (std::size_t i = 0; i < df::kControlGroups; ++i) waiting |= state.wait[i] > 0 ? 1 << i : 0;
  to.byte(waiting);
  for (const std::uint16_t wait : state.wait) {
    if (wait > 0) to.varint(wait);
  }
}

std::optional<ControlRecord> readControlRecord(std::string_view bytes, std::uint32_t tick) {
  if (bytes.size() > kMaxControlRecordBytes) return std::nullopt;
  ByteReader in(bytes);
  ControlRecord record;
  record.tick = tick;
  const std::uint8_t flags = in.byte();
  if (flags > (kSteering | kLetGoX | kLetGoY)) return std::nullopt;
  record.slot = static_cast<std::uint32_t>(in.upTo(kMaxSlots - 1));
  record.generation = static_cast<std::uint32_t>(in.upTo(UINT32_MAX));
  record.newest_input = static_cast<std::uint32_t>(in.upTo(UINT32_MAX));
  record.position = readVector(in, kMaxPosition);
  record.velocity = readVector(in, kMaxVelocity);
  record.acceleration = readVector(in, kMaxVelocity);
  record.state = readState(in, flags);
  if (!in.ok() || !in.atEnd()) return std::nullopt;
  return record;
}

}  // namespace naiad

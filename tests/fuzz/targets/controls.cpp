// Declared controls, and the exact state of the object that a player steers.
//
//   input   0 table, 1 state (1) | tick (4) | the bytes
#include "Target.h"
#include "shared/replica/ControlCodec.h"
#include "shared/replica/Limits.h"

namespace naiad::fuzz {
namespace {

void tryTable(std::string_view bytes) {
  const auto table = readControlTable(bytes);
  if (!table) return;
  REQUIRE(isValid(*table));
  std::string written;
  writeControlTable(written, *table);
  REQUIRE(written.size() <= kMaxControlTableBytes);
  REQUIRE(readControlTable(written) == table);
}

void tryRecord(std::string_view bytes, std::uint32_t tick) {
  const auto record = readControlRecord(bytes, tick);
  if (!record) return;
  REQUIRE(record->tick == tick && record->slot < kMaxSlots);
  REQUIRE(record->state.silence <= df::kMaxControlTicks);
  for (const std::uint16_t wait : record->state.wait) REQUIRE(wait <= df::kMaxControlTicks);
  for (const df::Fixed target_velocity : {record->state.x.target_velocity, record->state.y.target_velocity})
    REQUIRE(target_velocity >= -df::kMaxControlReach && target_velocity <= df::kMaxControlReach);
  std::string written;
  writeControlRecord(written, *record);
  REQUIRE(written.size() <= kMaxControlRecordBytes);
  REQUIRE(readControlRecord(written, tick) == record);
}

}  // namespace

void tryInput(Script script) {
  const bool table = !script.flag();
  const auto tick = script.number<std::uint32_t>();
  const Exactly bytes(script.rest());
  if (table) {
    tryTable(bytes.view());
  } else {
    tryRecord(bytes.view(), tick);
  }
}

}  // namespace naiad::fuzz

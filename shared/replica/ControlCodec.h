// Controls <-> bytes: the table a game declares for a player, and the exact state of what he steers. The
// writing side asserts, the reading side checks everything.
//
// Numbers are varints, signed ones zig-zag, as everywhere in the records (Bytes.h):
//
//   table   rows (1, at most 32) | flags (1): 1 bounded, 2 whole cells | patience (v)
//           bounded? corner x y (zz zz), size (v v)
//           each row: key (1) | what (1): action + 4·effect + 16·x + 32·y | value x y (zz zz) | wait (v) |
//           group (1)
//   state   flags (1): 1 steering, 2 x let go, 4 y let go | slot, generation (v v) | newest input (v)
//           position, velocity, acceleration (zz zz each) | pull of x, of y (zz zz) | silence (v)
//           groups that wait (1, a bit each) | each: ticks (v)
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "ControlTable.h"

namespace naiad {

/// No table is longer, and no longer one is read.
inline constexpr std::size_t kMaxControlTableBytes = 800;
/// Likewise for a state.
inline constexpr std::size_t kMaxControlRecordBytes = 160;

/// What a player steers, exactly, at the end of a tick. (A published motion need only draw the right cells;
/// what is predicted must begin with the true numbers.)
struct ControlRecord {
  std::uint32_t tick = 0;
  std::uint32_t slot = 0;
  std::uint32_t generation = 0;    ///< 0: he steers nothing
  std::uint32_t newest_input = 0;  ///< the newest input of this player that has reached the game; 0: none
  df::FixedVector position;
  df::FixedVector velocity;  ///< what the next tick tries to add, blocked or not
  df::FixedVector acceleration;
  df::ControlState state;

  friend bool operator==(const ControlRecord&, const ControlRecord&) = default;
};

/// Append the table, which must be valid.
void writeControlTable(std::string& out, const df::ControlTable& table);
/// Nothing if anything is missing, out of range or left over.
std::optional<df::ControlTable> readControlTable(std::string_view bytes);

/// Append the state; its tick is the snapshot's and is not written.
void writeControlRecord(std::string& out, const ControlRecord& record);
std::optional<ControlRecord> readControlRecord(std::string_view bytes, std::uint32_t tick);

}  // namespace naiad

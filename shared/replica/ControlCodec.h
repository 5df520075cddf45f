// Controls <-> bytes and bits: the table a game declares for a player, and the exact state of what they
// steer. The writing side asserts, the reading side checks everything.
//
// A table is rare, so it is bytes; numbers are varints, signed ones zig-zag (Bytes.h):
//
//   table   rows (1, at most 32) | flags (1): 1 bounded, 2 whole cells | patience (v)
//           bounded? corner x y (zz zz), size (v v)
//           each row: key (1) | what (1): action + 4·effect + 16·x + 32·y | value x y (zz zz) | wait (v) |
//           group (1)
//
// A state may come with every snapshot, so it is bits (Bits.h):
//
//   state   generation: exp-Golomb(1) | slot: exp-Golomb(6) | position, velocity, acceleration: a motion
//           (MotionCodec.h) | steering 1 | lever x | lever y | silence: exp-Golomb(2) | groups that wait 1
//           (a bit each 8 | each that does: ticks: exp-Golomb(3))
//   lever   let go 1 | pulled 1 (as the velocity 1, else signed exp-Golomb(33))
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "shared/values/ControlTable.h"

namespace naiad {

class BitReader;
class BitWriter;
struct Origin;

/// No table is longer, and no longer one is read.
inline constexpr std::size_t kMaxControlTableBytes = 800;
/// Likewise for a state.
inline constexpr std::size_t kMaxControlRecordBytes = 160;

/// What a player steers, exactly, at the end of a tick. (A published motion need only draw the right cells;
/// what is predicted must begin with the true numbers.)
struct ControlRecord {
  std::uint32_t tick = 0;
  std::uint32_t slot = 0;          ///< of the world; on the wire and from there on the client's id
  std::uint32_t generation = 0;    ///< likewise; 0: the player steers nothing
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

/// Append the state. Its tick and newest input are the snapshot's and not written; its position is
/// counted from `origin`.
void writeControlRecord(BitWriter& out, const ControlRecord& record, const Origin& origin);
/// The reader fails where a number is out of range.
ControlRecord readControlRecord(BitReader& in, std::uint32_t tick, const Origin& origin);

/// The same by itself: its newest input, 32 bits, then the state, counted from nowhere.
void writeControlRecord(std::string& out, const ControlRecord& record);
/// Nothing if anything is missing, out of range or left over.
std::optional<ControlRecord> readControlRecord(std::string_view bytes, std::uint32_t tick);

}  // namespace naiad

// Encodes and decodes controls: the table that a game declares for a player, and the exact state of the
// object that the player steers. Writers assert, readers check everything.
//
// Tables are rare, so they are bytes; numbers are varints, signed ones zig-zag (Bytes.h):
//
//   table   rows (1, at most 32) | flags (1): 1 bounded, 2 whole cells | patience (v)
//           bounded? corner x y (zz zz), size (v v)
//           each row: key (1) | what (1): action + 4·effect + 16·x + 32·y | value x y (zz zz) | wait (v) |
//           group (1)
//
// Every snapshot may have a state, so states are bits (Bits.h):
//
//   state   generation: exp-Golomb(1) | slot: exp-Golomb(6) | position, velocity, acceleration: a motion
//           (MotionCodec.h) | steering 1 | lever x | lever y | silence: exp-Golomb(2) | a group waits 1
//           (8 bits, one for each group | ticks of each group that waits: exp-Golomb(3))
//   lever   released 1 | target velocity is not 0: 1 (equal to the velocity 1, else signed exp-Golomb(33))
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

/// Largest size of a table in bytes; longer ones are refused.
inline constexpr std::size_t kMaxControlTableBytes = 800;
/// Largest size of a state in bytes; longer ones are refused.
inline constexpr std::size_t kMaxControlRecordBytes = 160;

/// The exact state of the object that a player steers, at the end of a tick. (A published motion need only
/// draw the right cells, but a prediction must start from exact numbers.)
struct ControlRecord {
  std::uint32_t tick = 0;
  std::uint32_t slot = 0;          ///< slot in the world; on the wire and at the client, the client's id
  std::uint32_t generation = 0;    ///< generation of that slot or id; 0: the player steers nothing
  std::uint32_t newest_input = 0;  ///< newest input of this player that reached the game; 0: none
  df::FixedVector position;
  df::FixedVector velocity;  ///< added to the position in the next tick unless blocked
  df::FixedVector acceleration;
  df::ControlState state;

  friend bool operator==(const ControlRecord&, const ControlRecord&) = default;
};

/// Appends the table, which must be valid.
void writeControlTable(std::string& out, const df::ControlTable& table);
/// Decodes a table; nullopt if anything is missing, out of range or left over.
std::optional<df::ControlTable> readControlTable(std::string_view bytes);

/// Appends the state without its tick and newest input, which the snapshot has. The position is relative to
/// `origin`.
void writeControlRecord(BitWriter& out, const ControlRecord& record, const Origin& origin);
/// Reads a state. `in` fails if a number is out of range.
ControlRecord readControlRecord(BitReader& in, std::uint32_t tick, const Origin& origin);

/// Appends the state with its newest input (32 bits) in front, and an absolute position.
void writeControlRecord(std::string& out, const ControlRecord& record);
/// Decodes a state; nullopt if anything is missing, out of range or left over.
std::optional<ControlRecord> readControlRecord(std::string_view bytes, std::uint32_t tick);

}  // namespace naiad

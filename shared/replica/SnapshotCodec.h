// Encodes and decodes snapshots. Writers assert, readers check everything.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "shared/replica/LookCodec.h"
#include "shared/replica/MotionCodec.h"
#include "shared/replica/Records.h"
#include "shared/replica/SnapshotDictionary.h"

namespace naiad {

/// The header of a snapshot. The wire has only the low 16 bits of numbers, ticks and inputs. The reader
/// restores the other bits from the newest known ones, so it must not fall behind by 2^15.
struct SnapshotHeader {
  std::uint32_t number = 0;      ///< never 0
  std::uint32_t tick = 0;        ///< the records hold at the end of this tick
  std::uint8_t epoch = 0;        ///< 0 … 3; on a change, forget the world: all of it is sent again
  bool complete = true;          ///< true if no records are pending after this snapshot
  bool has_input = false;        ///< `input` and `input_tick` are set
  std::uint32_t input = 0;       ///< newest input that reached the game
  std::uint32_t input_tick = 0;  ///< tick that applied `input`, or `tick` − 63 if that is later
};

/// The newest known numbers, from which shortened ones are restored.
struct SnapshotContext {
  std::uint32_t number = 0;
  std::uint32_t tick = 0;
  std::uint32_t input = 0;
};

struct Snapshot {
  SnapshotHeader header;
  Records records;
};

enum class ReadResult {
  kOk,
  kStale,      ///< uses an origin or sequence that a newer snapshot has replaced: drop it unacknowledged
  kMalformed,  ///< bytes that no honest server sends; `out` is unspecified
};

/// Reads a snapshot. `dictionary` must be that of the snapshot's epoch; it is not changed.
ReadResult readSnapshot(std::string_view bytes, const SnapshotContext& context,
                        const SnapshotDictionary& dictionary, Snapshot& out);
/// Returns the epoch of an unread snapshot; nullopt if the bytes are too few.
std::optional<std::uint8_t> peekEpoch(std::string_view bytes);
/// Returns the header without the records; nullopt if the bytes are too few or malformed.
std::optional<SnapshotHeader> peekHeader(std::string_view bytes, const SnapshotContext& context);

/// Assembles a snapshot from records in any order.
class SnapshotWriter {
 public:
  /// Begins a snapshot whose positions and orders are relative to `origin`, which the client has in `slot`
  /// (0: Origin{}).
  void beginSnapshot(const SnapshotHeader& header, std::uint32_t slot, const Origin& origin);
  void write(const WorldRecord& record);
  void write(const ViewRecord& record);
  void write(const OriginRecord& record);
  void write(const TextRecord& record);
  /// Adds a control table, as encoded by writeControlTable().
  void writeTable(std::string_view bytes);
  /// Adds a record that holds at the header's tick; its newest input must be the header's if that has one.
  void write(const ControlRecord& record);

  /// Encodes an object's record without its id. `motion` must hold at the header's tick; that of `state` is
  /// ignored.
  void encode(BitWriter& out, std::uint8_t groups, std::uint8_t generation, const ObjectState& state,
              const Motion& motion, LookForm form = {}) const;
  /// Adds an encoded record. Call at most once for each id.
  void object(std::uint32_t id, const BitWriter& bits);

  /// Like encode() and object() without a copy. Returns the size in bits; then call commit() or drop().
  std::size_t stage(std::uint8_t groups, std::uint8_t generation, const ObjectState& state,
                    const SharedMotion& motion, LookForm form = {});
  void commit(std::uint32_t id);
  void drop() { m_encoded.truncate(m_kept); }

  /// True if one more object of `more` bits and any id up to `last_id` fits into `bytes`.
  bool hasSpace(std::size_t more, std::uint32_t last_id, std::size_t bytes) const;
  bool isEmpty() const { return m_objects.empty() && m_bits == kHeaderBits; }
  /// Overrides SnapshotHeader::complete of beginSnapshot().
  void setComplete(bool complete) { m_header.complete = complete; }
  std::string finish() {
    std::string bytes;
    finish(bytes);
    return bytes;
  }
  /// Like finish() above, into a string whose memory is reused.
  void finish(std::string& bytes);

 private:
  /// Upper bound of header, counts and padding, in bits.
  static constexpr std::size_t kHeaderBits = 112;
  struct Object {
    std::uint32_t id;
    std::size_t from;  ///< first bit in m_encoded
    std::size_t bits;
  };
  template <class AnyMotion>
  void encodeWith(BitWriter& out, std::uint8_t groups, std::uint8_t generation, const ObjectState& state,
                  const AnyMotion& motion, LookForm form) const;
  void finishExtras();

  SnapshotHeader m_header;
  std::uint32_t m_origin_slot = 0;
  Origin m_origin;
  BitWriter m_world;
  BitWriter m_view;
  BitWriter m_table;
  BitWriter m_origins;
  BitWriter m_texts;
  BitWriter m_control;
  BitWriter m_encoded;     ///< the objects, in the order in which they were added
  std::size_t m_kept = 0;  ///< bits of m_encoded without the staged record
  BitWriter m_out;         ///< the finished snapshot; a member, so that its memory is reused
  unsigned m_origin_count = 0;
  unsigned m_text_count = 0;
  std::vector<Object> m_objects;
  std::size_t m_bits = 0;  ///< size of the snapshot so far in bits, without ids
};

}  // namespace naiad

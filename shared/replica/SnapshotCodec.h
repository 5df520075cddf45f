// Snapshots <-> bytes. The writing side asserts, the reading side checks everything.
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

/// The header of a snapshot. On the wire numbers, ticks and inputs have their 16 low bits only; the
/// reader restores them near those it knows, so it must not fall behind by 2^15.
struct SnapshotHeader {
  std::uint32_t number = 0;  ///< never 0
  std::uint32_t tick = 0;    ///< the records hold at its end
  std::uint8_t epoch = 0;    ///< 0 … 3; another one than before: forget the world, all of it is sent again
  bool complete = true;      ///< nothing is pending that this snapshot does not carry
  bool has_input = false;    ///< the next two are set
  std::uint32_t input = 0;   ///< newest input that reached the game
  std::uint32_t input_tick = 0;  ///< the tick that it was applied in, at most 63 before `tick`, else that
};

/// What restores the numbers: the newest ones known.
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
  kStale,      ///< uses a name that a newer snapshot has replaced: drop it, do not acknowledge it
  kMalformed,  ///< bytes that no honest server sends; `out` is unspecified
};

/// Read a snapshot. `dictionary` must be that of the epoch of the snapshot; it is not changed.
ReadResult readSnapshot(std::string_view bytes, const SnapshotContext& context,
                        const SnapshotDictionary& dictionary, Snapshot& out);
/// The epoch of a snapshot, before it is read; nothing if the bytes are too few.
std::optional<std::uint8_t> peekEpoch(std::string_view bytes);
/// The header without the records; nothing if the bytes are too few or malformed.
std::optional<SnapshotHeader> peekHeader(std::string_view bytes, const SnapshotContext& context);

/// Puts a snapshot together, in any order.
class SnapshotWriter {
 public:
  /// Positions and orders are counted from `origin`, which the client knows under `slot` (0: Origin{}).
  void beginSnapshot(const SnapshotHeader& header, std::uint32_t slot, const Origin& origin);
  void write(const WorldRecord& record);
  void write(const ViewRecord& record);
  void write(const OriginRecord& record);
  void write(const TextRecord& record);
  /// A table of controls, as writeControlTable() wrote it.
  void writeTable(std::string_view bytes);
  /// It must hold at the header's tick, its newest input be the header's if that has one.
  void write(const ControlRecord& record);

  /// The bits of an object's record but for its id. `motion` must hold at the header's tick; that of `state`
  /// is ignored.
  void encode(BitWriter& out, std::uint8_t groups, std::uint8_t generation, const ObjectState& state,
              const Motion& motion, LookForm form = {}) const;
  /// Add an encoded record. Each id at most once.
  void object(std::uint32_t id, const BitWriter& bits);

  /// The same without a copy: encode a record to see how many bits it takes, then keep() or drop() it.
  std::size_t stage(std::uint8_t groups, std::uint8_t generation, const ObjectState& state,
                    const SharedMotion& motion, LookForm form = {});
  void keep(std::uint32_t id);
  void drop() { m_encoded.truncate(m_kept); }

  /// Would the snapshot stay within `bytes` with `more` bits for one more object, whatever its id up to
  /// `last_id`?
  bool hasRoom(std::size_t more, std::uint32_t last_id, std::size_t bytes) const;
  bool isEmpty() const { return m_objects.empty() && m_bits == kHeaderBits; }
  /// Overrides SnapshotHeader::complete of beginSnapshot().
  void setComplete(bool complete) { m_header.complete = complete; }
  std::string finish() {
    std::string bytes;
    finish(bytes);
    return bytes;
  }
  /// The same into a string whose memory is reused.
  void finish(std::string& bytes);

 private:
  /// Header, counts and the bits that fill the last byte, at most.
  static constexpr std::size_t kHeaderBits = 112;
  struct Object {
    std::uint32_t id;
    std::size_t from;  ///< in m_encoded
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
  BitWriter m_encoded;     ///< the objects, in the order they came
  std::size_t m_kept = 0;  ///< bits of m_encoded; more are staged
  BitWriter m_out;         ///< kept for its memory
  unsigned m_origin_count = 0;
  unsigned m_text_count = 0;
  std::vector<Object> m_objects;
  std::size_t m_bits = 0;  ///< without ids
};

}  // namespace naiad

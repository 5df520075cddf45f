// Encodes the parts of a `.dfr` file (Dfr.h) as bytes. Writes no files.
#pragma once

#include <string>
#include <string_view>

#include "host/journal/Dfr.h"
#include "host/journal/RecordCoder.h"

namespace naiad {

/// Returns the 64 bytes of the header.
std::string encodeDfrHeader(const DfrHeader& header);

/// Returns one chunk. `payload` has at most kMaxDfrPayload bytes.
std::string encodeDfrChunk(std::uint32_t type, std::string_view payload);

/// Returns a META chunk. Long names and values are truncated, facts beyond kMaxDfrFacts or kMaxDfrPayload
/// dropped.
std::string encodeDfrMeta(const DfrFacts& facts);

/// Returns a DONE chunk. `why` says how the round ended.
std::string encodeDfrDone(std::string_view why);

/// Returns TURN chunks with these records, not packed, whose first byte in the stream is at `position`.
std::string encodeDfrTurns(std::string_view records, std::uint64_t position);

/// Packs the records of turns (TurnRecord.h). Each chunk can be read without those after it.
class DfrTurnPacker {
 public:
  DfrTurnPacker() = default;
  /// Continues after chunks with `position` bytes of the stream, all of which `model` has seen.
  DfrTurnPacker(RecordModel model, std::uint64_t position)
      : m_packer(std::move(model)), m_position(position) {}

  /// Returns the next bytes of the record stream as one chunk, or several if they are many.
  std::string pack(std::string_view records);

 private:
  RecordPacker m_packer;
  std::uint64_t m_position = 0;  ///< position in the record stream
};

/// State for appending to a file that another server began.
struct JournalPosition {
  DfrTurnPacker packer;
  std::uint64_t position = 0;  ///< position in the record stream
};

}  // namespace naiad

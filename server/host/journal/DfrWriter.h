// Spells a `.dfr` file (Dfr.h): makes bytes, and writes none of them anywhere.
#pragma once

#include <string>
#include <string_view>

#include "host/journal/Dfr.h"
#include "host/journal/RecordCoder.h"

namespace naiad {

/// The 64 bytes of the header.
std::string spellDfrHeader(const DfrHeader& header);

/// One chunk. `payload`: kMaxDfrPayload bytes, at most.
std::string spellDfrChunk(std::uint32_t type, std::string_view payload);

/// A META chunk. Names and values are cut off at their limits, and left out beyond kMaxDfrFacts.
std::string spellDfrMeta(const DfrFacts& facts);

/// A DONE chunk. `why`: how the round ended.
std::string spellDfrDone(std::string_view why);

/// TURN chunks with these records as they are; `position`: of the first byte in the stream.
std::string spellDfrTurns(std::string_view records, std::uint64_t position);

/// Packs the records of turns (TurnRecord.h), so that each chunk is good without those that come later.
class DfrTurnPacker {
 public:
  DfrTurnPacker() = default;
  /// Goes on behind chunks of so many bytes of the stream, all of which the model has seen.
  DfrTurnPacker(RecordModel model, std::uint64_t position)
      : m_packer(std::move(model)), m_position(position) {}

  /// The chunk, or chunks if they are many, with the next bytes of the stream of records.
  std::string pack(std::string_view records);

 private:
  RecordPacker m_packer;
  std::uint64_t m_position = 0;  ///< in the stream
};

/// Where a file goes on that another server began.
struct JournalPlace {
  DfrTurnPacker packer;
  std::uint64_t position = 0;  ///< in the stream of records
};

}  // namespace naiad

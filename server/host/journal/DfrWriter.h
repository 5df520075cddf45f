// Spells a `.dfr` file (Dfr.h): makes bytes, and writes none of them anywhere.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "host/journal/Dfr.h"

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
  DfrTurnPacker();
  ~DfrTurnPacker();
  DfrTurnPacker(const DfrTurnPacker&) = delete;
  DfrTurnPacker& operator=(const DfrTurnPacker&) = delete;

  /// The chunk, or chunks if they are many, with the next bytes of the stream of records.
  std::string pack(std::string_view records);

 private:
  std::string packOne(std::string_view records);

  struct Freer {
    void operator()(void* p_context) const;
  };
  std::unique_ptr<void, Freer>
      m_p_context;             ///< a ZSTD_CCtx; null: there was no memory, and nothing is packed
  std::uint64_t m_offset = 0;  ///< of the stream
};

}  // namespace naiad

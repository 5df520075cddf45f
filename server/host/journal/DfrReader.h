// Reads a `.dfr` file (Dfr.h), chunk by chunk and record by record, as far as it is valid.
//
// A file may come from a stranger. Every number is checked, the cost is bounded by the file's size and a
// fixed amount of memory, and nothing in a file names another file to open.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "host/journal/Dfr.h"
#include "host/journal/DfrWriter.h"
#include "host/journal/RecordCoder.h"
#include "host/world/TurnRecord.h"

namespace naiad {

/// State of the end of a file.
enum class DfrEnd {
  kDone,     ///< the round is complete
  kTorn,     ///< the end is missing, or the round is still being played
  kDamaged,  ///< the header, a chunk or a record is damaged
};

class DfrReader {
 public:
  /// Reads the header and the facts before the first turn. `bytes` is the whole file and must outlive this.
  explicit DfrReader(std::string_view bytes);
  DfrReader(const DfrReader&) = delete;
  DfrReader& operator=(const DfrReader&) = delete;

  /// Returns why the file cannot be read, in words: not a `.dfr` file, truncated in its header, of another
  /// version, or damaged. Empty if it can.
  const std::string& problem() const { return m_problem; }
  const DfrHeader& header() const { return m_header; }
  /// Returns the facts of the META chunks read so far; those before the first turn are always included.
  const DfrFacts& facts() const { return m_facts; }

  /// Returns the next record; nullopt at the end, whose state end() then returns.
  std::optional<TurnRecord> next();
  DfrEnd end() const { return m_end; }
  /// Skips to the end without unpacking the remaining turns. wholeBytes(), streamBytes() and end() are then
  /// as if next() had read everything, provided that all records are valid. Nothing can be read afterwards.
  void skipToEnd();
  /// Returns the number of bytes of the file read so far, all of whole chunks.
  std::size_t wholeBytes() const { return m_at; }
  /// Returns the number of bytes of the record stream in the chunks read so far.
  std::uint64_t streamBytes() const { return m_offset; }
  /// Appends all records, unpacked, to `records`, which must outlive this. Call before next().
  void copyRecordsTo(std::string& records);
  /// Returns the number of bytes up to the end of the last chunk that ends with a whole record; later chunks
  /// end in the middle of a record. Call after next() has reached the end.
  std::size_t bytesOfWholeRecords() const { return m_whole_records; }
  /// Returns the state for writing further chunks after those that were read. Nothing can be read afterwards.
  JournalPosition releasePosition() { return {DfrTurnPacker(m_unpacker.releaseModel(), m_offset), m_offset}; }
  /// Returns how the round ended, if end() is DfrEnd::kDone.
  const std::string& endReason() const { return m_end_reason; }

 private:
  struct Chunk {
    std::uint32_t type = 0;
    std::string_view payload;
  };
  void readHeader();
  std::optional<Chunk> nextChunk();
  bool readChunk();
  bool handleChunk(const Chunk& chunk);
  bool readMeta(std::string_view payload);
  bool readTurns(std::string_view payload);

  std::string_view m_bytes;
  std::size_t m_at = 0;
  std::string m_problem;
  DfrHeader m_header;
  DfrFacts m_facts;
  TurnRecordReader m_records;
  std::uint64_t m_offset = 0;  ///< position in the record stream
  RecordUnpacker m_unpacker;
  std::string m_unpacked;
  std::string* m_p_copy = nullptr;
  bool m_skips = false;
  bool m_ended = false;
  DfrEnd m_end = DfrEnd::kTorn;
  std::string m_end_reason;
  std::size_t m_whole_records = 0;
};

}  // namespace naiad

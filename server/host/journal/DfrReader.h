// Reads a `.dfr` file (Dfr.h), chunk by chunk and record by record, as far as it is good.
//
// A file may come from a stranger: every number is checked, nothing costs more than the file's size and a
// fixed amount of memory, and nothing in it names a file that is opened.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "host/journal/Dfr.h"
#include "host/journal/DfrWriter.h"
#include "host/journal/RecordCoder.h"
#include "host/world/TurnRecord.h"

namespace naiad {

/// How far a file was read.
enum class DfrEnd {
  kDone,     ///< to the end of the round
  kTorn,     ///< to its last whole chunk: the rest is missing, or the round goes on
  kDamaged,  ///< to a chunk that is not what was written
};

class DfrReader {
 public:
  /// `bytes` of the whole file; they stay until this is gone.
  explicit DfrReader(std::string_view bytes);
  DfrReader(const DfrReader&) = delete;
  DfrReader& operator=(const DfrReader&) = delete;

  /// Why nothing can be read, as a sentence: not such a file, or of another version. Empty: it can.
  const std::string& problem() const { return m_problem; }
  const DfrHeader& header() const { return m_header; }
  /// Of the META chunks so far: those before the first turn have been read.
  const DfrFacts& facts() const { return m_facts; }

  /// The next record. Nothing: the end has come, and end() says which.
  std::optional<TurnRecord> next();
  DfrEnd end() const { return m_end; }
  /// Go to the end without unpacking what is left: wholeBytes(), streamBytes() and end() are as if next() had
  /// come there, if each record is good that the chunks say they have. Nothing can be read from then on.
  void skipToEnd();
  /// Bytes of the file that have been read: whole chunks.
  std::size_t wholeBytes() const { return m_at; }
  /// Bytes of the stream of records in them.
  std::uint64_t streamBytes() const { return m_offset; }
  /// Append the records, as they are unpacked, to `records`, which outlives this. Before next().
  void copyRecordsTo(std::string& records);
  /// Bytes of the file up to the last chunk that ends with a record: behind the others, one is cut off. After
  /// next() has come to the end.
  std::size_t bytesOfWholeRecords() const { return m_whole_records; }
  /// For the chunks that come behind those that were read; nothing can be read from then on.
  JournalPlace takePlace() { return {DfrTurnPacker(m_unpacker.takeModel(), m_offset), m_offset}; }
  /// How the round ended, of DfrEnd::kDone.
  const std::string& why() const { return m_why; }

 private:
  struct Chunk {
    std::uint32_t type = 0;
    std::string_view payload;
  };
  void readHeader();
  std::optional<Chunk> nextChunk();
  bool readChunk();
  bool takeChunk(const Chunk& chunk);
  bool readMeta(std::string_view payload);
  bool readTurns(std::string_view payload);

  std::string_view m_bytes;
  std::size_t m_at = 0;
  std::string m_problem;
  DfrHeader m_header;
  DfrFacts m_facts;
  TurnRecordReader m_records;
  std::uint64_t m_offset = 0;  ///< of the stream of records
  RecordUnpacker m_unpacker;
  std::string m_unpacked;
  std::string* m_p_copy = nullptr;
  bool m_skips = false;
  bool m_ended = false;
  DfrEnd m_end = DfrEnd::kTorn;
  std::string m_why;
  std::size_t m_whole_records = 0;
};

}  // namespace naiad

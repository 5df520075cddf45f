// Records <-> bytes. The writing side asserts, the reading side checks everything.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "Records.h"

namespace naiad {

/// Appends records to a buffer. Motions are written relative to the snapshot's tick, so they must hold at
/// exactly that tick.
class RecordWriter {
 public:
  void write(const WorldRecord& record);
  void write(const ViewRecord& record);
  void write(const TextRecord& record);
  void write(const ObjectRecord& record);

  /// Append what another writer wrote for the same tick.
  void append(const RecordWriter& other) { m_bytes += other.m_bytes; }

  const std::string& bytes() const { return m_bytes; }
  std::size_t size() const { return m_bytes.size(); }
  void clear() { m_bytes.clear(); }

 private:
  std::string m_bytes;
};

/// Bytes that `look` takes in a record.
std::size_t encodedSize(const Look& look);

/// Decode the records of the snapshot of `tick`. Nothing if any byte is malformed, any number out of its
/// range or any text not drawable: then no record of it may be applied.
std::optional<Records> readRecords(std::string_view bytes, std::uint32_t tick);

}  // namespace naiad

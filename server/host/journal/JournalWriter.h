// The thread that writes the journals of all worlds of a server to disk. No other thread waits for the disk.
#pragma once

#include <chrono>
#include <memory>

#include "host/journal/Journal.h"

namespace naiad {

class JournalWriter {
 public:
  /// Interval of writes and syncs: a power cut loses about this much of a round. For rounds without players
  /// it is longer (Journal::kIdleFlushInterval).
  static constexpr std::chrono::milliseconds kFlushInterval{1000};
  /// Time limit of the last write, if the disk stalls.
  static constexpr std::chrono::milliseconds kFinalFlushTimeout{2000};

  JournalWriter();
  /// Writes the remaining records, waiting at most kFinalFlushTimeout.
  ~JournalWriter();
  JournalWriter(const JournalWriter&) = delete;
  JournalWriter& operator=(const JournalWriter&) = delete;

  /// Adds a journal, which is written until it is finished or stops.
  void add(std::shared_ptr<Journal> journal);
  /// Makes the thread write now.
  void wake();
  /// Waits until everything added before is on the disk, at most `most`. Returns true if it is, or if it
  /// cannot be because a journal has stopped.
  bool drain(std::chrono::milliseconds most);

 private:
  struct Shared;
  std::shared_ptr<Shared> m_shared;  ///< shared with the thread, which outlives this if a write does not end
};

}  // namespace naiad

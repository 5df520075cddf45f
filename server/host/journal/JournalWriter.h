// The thread that puts journals on the disk, those of all worlds of a server. Whatever the disk does, no
// other thread waits for it.
#pragma once

#include <chrono>
#include <memory>

#include "host/journal/Journal.h"

namespace naiad {

class JournalWriter {
 public:
  /// Between two times that records are written and synced: what a power cut loses.
  static constexpr std::chrono::milliseconds kBetween{1000};
  /// For what is left at the end, if the disk stalls.
  static constexpr std::chrono::milliseconds kLastWait{2000};

  JournalWriter();
  /// Puts what is left on the disk, waiting up to kLastWait.
  ~JournalWriter();
  JournalWriter(const JournalWriter&) = delete;
  JournalWriter& operator=(const JournalWriter&) = delete;

  /// Write it until it is finished or stops.
  void add(std::shared_ptr<Journal> journal);
  /// Do not wait for the next turn.
  void wake();
  /// Wait until everything that was added before is on the disk, or for so long. Return whether it is.
  bool drain(std::chrono::milliseconds most);

 private:
  struct Shared;
  std::shared_ptr<Shared> m_shared;  ///< the thread's, too: it may outlive this in a write that does not end
};

}  // namespace naiad

// The journal of one round: the tick thread adds records and never waits, a JournalWriter puts them on the
// disk.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "host/journal/Dfr.h"
#include "host/journal/DfrWriter.h"
#include "host/journal/JournalSink.h"
#include "host/journal/TurnRing.h"

namespace naiad {

class Journal {
 public:
  /// `facts`: what is known before the world begins. `ring`: bytes of records that may wait for the disk.
  /// `goes_on`: the file has all that comes before. `folder`: of the file, for the ring (TurnRing.h). Throws
  /// std::system_error if there is no memory.
  Journal(std::unique_ptr<JournalSink> sink, const DfrHeader& header, DfrFacts facts, std::size_t ring,
          bool shared, std::optional<JournalPlace> goes_on = std::nullopt, std::uint64_t folder = 0);

  const DfrHeader& header() const { return m_header; }
  const TurnRing& ring() const { return m_ring; }

  // On the tick thread.

  /// Add a record. False: the journal has stopped, and takes no more.
  bool add(std::string_view record);
  /// More facts. In the file they come before all records that are added after them.
  void addFacts(DfrFacts facts);
  /// The round is over.
  void finish(const std::string& why);
  /// Another program goes on with the round: nothing more is added, and the file is not said to be at its
  /// end. What was added is written.
  void leaveOpen();
  /// The round is not over, and all of it is written down.
  bool isOpen() const { return !m_stopped && !m_finished && !m_overflowed && !m_left; }
  /// It stopped before the round was over.
  bool hasStopped() const { return (m_stopped && !m_finished) || m_overflowed; }
  /// Is the writer wanted before its time?
  bool isFilling() const { return m_ring.isFilling(); }
  /// Why the journal stopped, once; nothing while it goes on.
  std::optional<std::string> takeProblem();

  // On the writer's thread.

  /// Put what there is on the disk. False: there will be no more.
  bool flush();

 private:
  void write();
  void stop(const std::string& problem);

  const DfrHeader m_header;
  TurnRing m_ring;
  std::atomic<bool> m_stopped{false};
  std::atomic<bool> m_finished{false};
  std::atomic<bool> m_overflowed{false};

  std::mutex m_mutex;  ///< held while these are swapped, never while the disk is waited for
  DfrFacts m_facts;    ///< not yet written
  std::string m_why;
  std::string m_problem;

  // The writer's.
  std::unique_ptr<JournalSink> m_sink;
  DfrTurnPacker m_packer;
  bool m_begun = false;

  bool m_left = false;  ///< the tick thread's
};

}  // namespace naiad

// A round's journal. The tick thread adds records and never waits; a JournalWriter writes them to disk.
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
  /// Creates the journal of a round that begins, or of one that is resumed (`resumed`): then the file has all
  /// earlier records. `facts`: facts known before the world begins. `ring`: bytes of records that may wait
  /// for the disk, in memory that survives a crash if `shared`. `folder`: hash of the file's folder
  /// (TurnRing.h). `name`: the file's name, so that the next server can create the file if this one is killed
  /// before the first write; empty: not needed. Throws std::system_error if there is no memory.
  Journal(std::unique_ptr<JournalSink> sink, const DfrHeader& header, const DfrFacts& facts, std::size_t ring,
          bool shared, std::optional<JournalPosition> resumed = std::nullopt, std::uint64_t folder = 0,
          const std::string& name = {});

  const DfrHeader& header() const { return m_header; }
  const TurnRing& ring() const { return m_ring; }

  // The tick thread calls these.

  /// Adds a record. False if the journal was suspended or has stopped, or stops now because the ring is full.
  bool add(std::string_view record);
  /// Adds facts. In the file they precede all records that are added later.
  void addFacts(DfrFacts facts);
  /// Ends the journal: the round is over. `why` says how it ended.
  void finish(const std::string& why);
  /// Sets whether the world has no players; then flush() may write only every kIdleFlushInterval-th time.
  void setIdle(bool idle) { m_idle.store(idle, std::memory_order_relaxed); }
  /// Leaves the file to another program that resumes the round. Records added so far are still written, later
  /// ones are refused, and the file does not get an end.
  void suspend();
  /// True if the round is neither over nor suspended, and all of it so far was recorded.
  bool isOpen() const { return !m_stopped && !m_finished && !m_overflowed && !m_suspended; }
  /// True if the journal stopped before the round was over. Then the round continues, but can be neither
  /// resumed, handed over, nor taken over by another world.
  bool hasStopped() const { return (m_stopped && !m_finished) || m_overflowed; }
  /// True if more than half of the ring is full, so that the writer should be woken.
  bool isFilling() const { return m_ring.isFilling(); }
  /// Returns why the journal stopped; nullopt if it has not, or if this was returned before.
  std::optional<std::string> popProblem();

  // The writer's thread calls these.

  /// Number of calls of flush() per write if there are no players: half a minute, so that an idle server does
  /// not write all day.
  static constexpr int kIdleFlushInterval = 33;

  /// Writes all records to disk. `at_once`: even if there are no players. Returns false if the journal has
  /// stopped, or the round is over and all of it is written.
  bool flush(bool at_once = false);

 private:
  bool mayDefer();
  void write();
  void stop(const std::string& problem);

  const DfrHeader m_header;
  TurnRing m_ring;
  std::atomic<bool> m_stopped{false};
  std::atomic<bool> m_finished{false};
  std::atomic<bool> m_overflowed{false};
  std::atomic<bool> m_idle{false};

  std::mutex m_mutex;  ///< guards the next three; never held while waiting for the disk
  DfrFacts m_facts;    ///< facts not yet written
  std::string m_why;
  std::string m_problem;

  // Used by the writer's thread alone.
  std::unique_ptr<JournalSink> m_sink;
  DfrTurnPacker m_packer;
  bool m_begun = false;
  int m_skipped = 0;  ///< calls of flush() since the last one that wrote

  bool m_suspended = false;  ///< used by the tick thread alone
};

}  // namespace naiad

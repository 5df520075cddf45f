#include "host/journal/Journal.h"

#include <system_error>
#include <utility>

namespace naiad {

namespace {

/// Bytes of records that one turn of the writer takes: less than a chunk.
constexpr std::size_t kMaxTaken = kMaxDfrPayload / 2;

constexpr const char* kOverflow = "the disk is too slow";

}  // namespace

Journal::Journal(std::unique_ptr<JournalSink> sink, const DfrHeader& header, DfrFacts facts, std::size_t ring,
                 bool shared, std::optional<JournalPlace> goes_on, std::uint64_t folder)
    : m_header(header),
      m_ring(ring, header.uuid, shared, goes_on ? goes_on->position : 0, folder),
      m_facts(std::move(facts)),
      m_sink(std::move(sink)),
      m_packer(goes_on ? std::move(goes_on->packer) : DfrTurnPacker()),
      m_begun(goes_on.has_value()) {}

bool Journal::add(std::string_view record) {
  if (m_left) return false;
  if (m_stopped.load(std::memory_order_relaxed) || m_overflowed.load(std::memory_order_relaxed)) return false;
  if (m_ring.store(record)) return true;
  const std::lock_guard lock(m_mutex);
  m_overflowed = true;  // said now: the writer may wait for the disk for long
  m_problem = kOverflow;
  return false;
}

void Journal::addFacts(DfrFacts facts) {
  const std::lock_guard lock(m_mutex);
  m_facts.merge(facts);
}

void Journal::finish(const std::string& why) {
  if (m_left) return;
  {
    const std::lock_guard lock(m_mutex);
    m_why = why;
  }
  m_finished = true;
}

void Journal::leaveOpen() {
  m_left = true;
  m_ring.leave();
}

std::optional<std::string> Journal::takeProblem() {
  const std::lock_guard lock(m_mutex);
  if (m_problem.empty()) return std::nullopt;
  return std::exchange(m_problem, {});
}

bool Journal::flush() {
  if (m_stopped) return false;
  const bool last = m_finished;  // before what there is is taken
  try {
    write();
    if (m_overflowed) {
      stop(kOverflow);
    } else if (last) {
      std::string why;
      {
        const std::lock_guard lock(m_mutex);
        why = m_why;
      }
      m_sink->write(spellDfrDone(why));
      m_sink->sync();
      m_stopped = true;
    }
  } catch (const std::system_error& error) {
    stop(error.what());
  }
  return !m_stopped;
}

// Facts that were added before a record are written before it: so records are looked for first.
void Journal::write() {
  std::string records;
  while (true) {
    records.clear();
    const std::size_t count = m_ring.peek(records, kMaxTaken);
    DfrFacts facts;
    {
      const std::lock_guard lock(m_mutex);
      facts.swap(m_facts);
    }
    std::string bytes;
    if (!std::exchange(m_begun, true)) bytes = spellDfrHeader(m_header);
    if (!facts.empty()) bytes += spellDfrMeta(facts);
    bytes += m_packer.pack(records);
    if (bytes.empty()) return;
    m_sink->write(bytes);
    m_sink->sync();
    m_ring.release(count);
  }
}

// Nothing can go on from a round whose last turns are missing, and its header says so.
void Journal::stop(const std::string& problem) {
  m_stopped = true;
  try {
    m_sink->setFlags(m_header.flags | kDfrStopped);
    m_sink->sync();
  } catch (const std::system_error&) {
    // The disk takes nothing; who reads the file finds that turns are missing.
  }
  const std::lock_guard lock(m_mutex);
  if (!m_overflowed) m_problem = problem;
}

}  // namespace naiad

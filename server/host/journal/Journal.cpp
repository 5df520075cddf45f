#include "host/journal/Journal.h"

#include <system_error>
#include <utility>

namespace naiad {

namespace {

/// Maximum size of the records written at a time, in bytes: they fit into one chunk.
constexpr std::size_t kMaxTaken = kMaxDfrPayload / 2;

constexpr const char* kOverflow = "the disk is too slow";

}  // namespace

Journal::Journal(std::unique_ptr<JournalSink> sink, const DfrHeader& header, const DfrFacts& facts,
                 std::size_t ring, bool shared, std::optional<JournalPosition> resumed, std::uint64_t folder,
                 const std::string& name)
    : m_header(header),
      m_ring(
          ring, header.uuid, shared, resumed ? resumed->position : 0, folder,
          name.empty() ? FilePrologue() : FilePrologue{name, encodeDfrHeader(header) + encodeDfrMeta(facts)}),
      m_facts(facts),
      m_sink(std::move(sink)),
      m_packer(resumed ? std::move(resumed->packer) : DfrTurnPacker()),
      m_begun(resumed.has_value()) {}

bool Journal::add(std::string_view record) {
  if (m_suspended) return false;
  if (m_stopped.load(std::memory_order_relaxed) || m_overflowed.load(std::memory_order_relaxed)) return false;
  if (m_ring.store(record)) return true;
  const std::lock_guard lock(m_mutex);
  m_overflowed = true;  // reported now, because the writer may wait for the disk for a long time
  m_problem = kOverflow;
  return false;
}

void Journal::addFacts(DfrFacts facts) {
  const std::lock_guard lock(m_mutex);
  m_facts.merge(facts);
}

void Journal::finish(const std::string& why) {
  if (m_suspended) return;
  {
    const std::lock_guard lock(m_mutex);
    m_why = why;
  }
  m_finished = true;
}

void Journal::suspend() {
  m_suspended = true;
  m_ring.handOver();
}

std::optional<std::string> Journal::popProblem() {
  const std::lock_guard lock(m_mutex);
  if (m_problem.empty()) return std::nullopt;
  return std::exchange(m_problem, {});
}

bool Journal::flush(bool at_once) {
  if (m_stopped) return false;
  if (!at_once && mayDefer()) return true;
  const bool last = m_finished;  // read before the ring, which has all records once this is set
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
      m_sink->write(encodeDfrDone(why));
      m_sink->sync();
      m_stopped = true;
    }
  } catch (const std::system_error& error) {
    stop(error.what());
  }
  return !m_stopped;
}

bool Journal::mayDefer() {
  const bool waits = m_idle && m_begun && !m_finished && !m_overflowed && !m_ring.isFilling() &&
                     ++m_skipped < kIdleFlushInterval;
  const std::lock_guard lock(m_mutex);
  if (waits && m_facts.empty()) return true;
  m_skipped = 0;
  return false;
}

// The records are read first, so that facts added before a record are written before it.
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
    if (!std::exchange(m_begun, true)) bytes = encodeDfrHeader(m_header);
    if (!facts.empty()) bytes += encodeDfrMeta(facts);
    bytes += m_packer.pack(records);
    if (bytes.empty()) return;
    m_sink->write(bytes);
    m_sink->sync();
    m_ring.release(count);
  }
}

// A round without its last turns cannot be resumed, so its header is marked.
void Journal::stop(const std::string& problem) {
  m_stopped = true;
  try {
    m_sink->setFlags(m_header.flags | kDfrStopped);
    m_sink->sync();
  } catch (const std::system_error&) {
    // The mark cannot be written. Readers find that the end is missing.
  }
  const std::lock_guard lock(m_mutex);
  if (!m_overflowed) m_problem = problem;
}

}  // namespace naiad

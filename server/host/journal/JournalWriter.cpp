#include "host/journal/JournalWriter.h"

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

namespace naiad {

namespace {

/// Part of kFlushInterval that is left for the sync itself: records added after one sync has begun are safe
/// when the next has ended.
constexpr std::chrono::milliseconds kForSync{100};

}  // namespace

struct JournalWriter::Shared {
  std::mutex mutex;
  std::condition_variable wanted;
  std::condition_variable done;
  std::vector<std::shared_ptr<Journal>> journals;
  std::uint64_t asked = 0;   ///< writes that were requested
  std::uint64_t served = 0;  ///< number of the newest request that was served
  bool ends = false;

  void run();
};

void JournalWriter::Shared::run() {
  std::unique_lock lock(mutex);
  auto began = std::chrono::steady_clock::now();
  while (true) {
    wanted.wait_until(lock, began + kFlushInterval - kForSync, [this] { return ends || asked > served; });
    began = std::chrono::steady_clock::now();
    const bool last = ends;
    const std::uint64_t serving = asked;
    const bool at_once = last || asked > served;
    const std::vector<std::shared_ptr<Journal>> now = journals;
    lock.unlock();
    std::vector<std::shared_ptr<Journal>> over;
    for (const auto& journal : now) {
      if (!journal->flush(at_once)) over.push_back(journal);
    }
    lock.lock();
    std::erase_if(journals, [&over](const auto& journal) {
      return std::find(over.begin(), over.end(), journal) != over.end();
    });
    served = serving;
    done.notify_all();
    if (last) return;
  }
}

JournalWriter::JournalWriter() : m_shared(std::make_shared<Shared>()) {
  std::thread([shared = m_shared] { shared->run(); }).detach();
}

JournalWriter::~JournalWriter() {
  drain(kFinalFlushTimeout);
  const std::lock_guard lock(m_shared->mutex);
  m_shared->ends = true;
  m_shared->wanted.notify_all();
}

void JournalWriter::add(std::shared_ptr<Journal> journal) {
  const std::lock_guard lock(m_shared->mutex);
  m_shared->journals.push_back(std::move(journal));
}

void JournalWriter::wake() {
  const std::lock_guard lock(m_shared->mutex);
  ++m_shared->asked;
  m_shared->wanted.notify_all();
}

bool JournalWriter::drain(std::chrono::milliseconds most) {
  std::unique_lock lock(m_shared->mutex);
  const std::uint64_t asked = ++m_shared->asked;
  m_shared->wanted.notify_all();
  return m_shared->done.wait_for(lock, most, [&] { return m_shared->served >= asked; });
}

}  // namespace naiad

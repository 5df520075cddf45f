#include "shared/program/JobThread.h"

#include <utility>

#include "shared/program/ProcessSetup.h"

namespace naiad {

JobThread::~JobThread() {
  finish();
}

void JobThread::finish() {
  {
    const std::lock_guard lock(m_mutex);
    m_stopping = true;
  }
  m_wake.notify_one();
  if (m_thread.joinable()) m_thread.join();
}

bool JobThread::enqueue(std::function<void()> job) {
  {
    const std::lock_guard lock(m_mutex);
    if (m_stopping || m_jobs.size() >= kMaxWaiting) return false;
    m_jobs.push_back(std::move(job));
    if (!m_thread.joinable()) m_thread = startWithoutSignals([this] { run(); });
  }
  m_wake.notify_one();
  return true;
}

void JobThread::run() {
  std::unique_lock lock(m_mutex);
  for (;;) {
    m_wake.wait(lock, [this] { return m_stopping || !m_jobs.empty(); });
    if (m_jobs.empty()) return;
    {
      const std::function<void()> job = std::move(m_jobs.front());
      m_jobs.pop_front();
      lock.unlock();
      job();
    }
    lock.lock();
  }
}

}  // namespace naiad

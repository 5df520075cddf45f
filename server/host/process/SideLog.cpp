#include "host/process/SideLog.h"

#include <pthread.h>
#include <signal.h>

#include <utility>

namespace naiad {

SideLog::SideLog(LogLine log) : m_log(std::move(log)) {
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);  // signals are for the threads that were there before
  m_thread = std::thread([this] { run(); });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

SideLog::~SideLog() {
  {
    const std::lock_guard lock(m_mutex);
    m_stopping = true;
  }
  m_changed.notify_all();
  m_thread.join();
}

void SideLog::operator()(const std::string& line) {
  {
    const std::lock_guard lock(m_mutex);
    m_lines.push_back(line);
  }
  m_changed.notify_all();
}

void SideLog::waitUntilLogged(std::chrono::milliseconds most) {
  std::unique_lock lock(m_mutex);
  m_changed.wait_for(lock, most, [this] { return m_lines.empty(); });
}

void SideLog::run() {
  std::unique_lock lock(m_mutex);
  for (;;) {
    m_changed.wait(lock, [this] { return m_stopping || !m_lines.empty(); });
    if (m_lines.empty()) return;
    const std::string line = m_lines.front();
    lock.unlock();
    m_log(line);
    lock.lock();
    m_lines.pop_front();
    m_changed.notify_all();
  }
}

}  // namespace naiad

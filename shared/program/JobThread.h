// A thread for slow jobs, like hashing a password or writing to disk.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

namespace naiad {

/// Runs jobs one after the other, in the order in which they were given.
class JobThread {
 public:
  static constexpr std::size_t kMaxWaiting = 1024;

  /// Calls finish().
  ~JobThread();

  /// Queues a job, which must not throw. If too many jobs wait, or after finish(), drops it and returns
  /// false. Any thread; does not block.
  bool enqueue(std::function<void()> job);
  /// Waits until all queued jobs have run, so that accepted changes are written. Do not call it from a job.
  void finish();

 private:
  void run();

  std::mutex m_mutex;
  std::condition_variable m_wake;
  std::deque<std::function<void()>> m_jobs;
  bool m_stopping = false;
  std::thread m_thread;  ///< started by the first job; blocks all signals
};

}  // namespace naiad

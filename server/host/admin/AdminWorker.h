// A thread for what takes long in looking after a server: hashing a password, writing a ban to disk.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

namespace naiad {

/// Jobs run one after the other, in the order in which they were given.
class AdminWorker {
 public:
  static constexpr std::size_t kMaxWaiting = 1024;

  /// As finish().
  ~AdminWorker();

  /// False, and the job is dropped: too many wait. Any thread; never waits for a job. `job` must not throw.
  bool give(std::function<void()> job);
  /// Wait for the jobs that are left: a ban that was promised is written. None is taken after this. Not from
  /// a job.
  void finish();

 private:
  void run();

  std::mutex m_mutex;
  std::condition_variable m_wake;
  std::deque<std::function<void()>> m_jobs;
  bool m_stopping = false;
  std::thread m_thread;  ///< begins with the first job
};

}  // namespace naiad

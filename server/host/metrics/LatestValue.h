// Hands the newest value from one thread to another, without a lock: neither ever waits.
#pragma once

#include <atomic>
#include <memory>

namespace naiad {

/// One thread calls publish(), one other takeLatest().
template <class T>
class LatestValue {
 public:
  LatestValue() = default;
  ~LatestValue() { delete m_newest.load(); }
  LatestValue(const LatestValue&) = delete;
  LatestValue& operator=(const LatestValue&) = delete;

  /// A value that was not taken yet is dropped.
  void publish(std::unique_ptr<const T> value) {
    delete m_newest.exchange(value.release(), std::memory_order_acq_rel);
  }
  /// The newest value; null before the first. Valid until the next call.
  const T* takeLatest() {
    if (const T* p_newest = m_newest.exchange(nullptr, std::memory_order_acq_rel)) m_taken.reset(p_newest);
    return m_taken.get();
  }

 private:
  std::atomic<const T*> m_newest = nullptr;
  std::unique_ptr<const T> m_taken;  ///< the reader's
};

}  // namespace naiad

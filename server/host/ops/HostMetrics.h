// What a host measures of itself, and gives out on --metrics: /metrics, /healthz, /readyz.
//
// Once a second, between two ticks, the thread that ticks copies all values into a MetricsSnapshot and hands
// it to the thread of the MetricsServer, which makes a page of it when asked. Nothing that changes is read
// from another thread, and where nothing was asked for nothing is measured.
#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <string_view>

#include "host/loop/HostPart.h"
#include "host/metrics/HostPulse.h"
#include "host/metrics/MetricsPage.h"
#include "host/metrics/MetricsServer.h"

namespace naiad {

/// Hands the newest value from one thread to another, without a lock: neither ever waits.
/// One thread calls publish(), one other takeLatest().
template <class T>
class LatestValue {
 public:
  ~LatestValue() { delete m_newest.load(); }

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

/// All calls are for the thread that ticks.
class HostMetrics : public HostPart {
 public:
  /// Listens on HostOptions::metrics, and logs the port. Throws ListenError for one that is taken.
  explicit HostMetrics(const HostAccess& access);
  ~HostMetrics() override;

  void begin() override;
  /// Measures, if it is time.
  void tick(Clock::time_point now) override;
  void drain() override { m_pulse.beginDrain(false); }

 private:
  MetricsServer::Answer answer(std::string_view path);
  void measure(Clock::time_point now);
  void measureRooms();
  void measureSessions();
  void measureCpu();

  HostAccess m_access;
  HostPulse m_pulse;
  LatestValue<MetricsSnapshot> m_newest;
  MetricsSnapshot m_next;  ///< histograms and times that go on
  Clock::time_point m_measure_at{};
  std::unique_ptr<MetricsServer> m_server;  ///< last: its thread uses the others
};

}  // namespace naiad

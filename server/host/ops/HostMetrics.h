// Measures a host and serves the values on --metrics: /metrics, /healthz, /readyz.
//
// Once a second, between two ticks, the tick thread copies all values into a MetricsSnapshot and hands it to
// the thread of the MetricsServer, which renders it on request. So no thread reads values that another one
// changes. Without --metrics, nothing is measured.
#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <string_view>

#include "host/loop/HostPart.h"
#include "host/metrics/HostHealth.h"
#include "host/metrics/MetricsPage.h"
#include "host/metrics/MetricsServer.h"

namespace naiad {

/// Passes the newest value from one thread to another. Lock-free: neither thread ever waits.
/// One thread calls publish(), another one readLatest().
template <class T>
class LatestValue {
 public:
  ~LatestValue() { delete m_newest.load(); }

  /// Replaces the value. Drops an older one that was not read.
  void publish(std::unique_ptr<const T> value) {
    delete m_newest.exchange(value.release(), std::memory_order_acq_rel);
  }
  /// Returns the newest value; null before the first. Valid until the next call.
  const T* readLatest() {
    if (const T* p_newest = m_newest.exchange(nullptr, std::memory_order_acq_rel)) m_taken.reset(p_newest);
    return m_taken.get();
  }

 private:
  std::atomic<const T*> m_newest = nullptr;
  std::unique_ptr<const T> m_taken;  ///< owned by the reader
};

/// Thread: the host's (the tick thread).
class HostMetrics : public HostPart {
 public:
  /// Listens on HostOptions::metrics and logs the port. Throws ListenError if it cannot listen.
  explicit HostMetrics(const HostAccess& access);
  ~HostMetrics() override;

  void begin() override;
  /// Measures once a second.
  void tick(Clock::time_point now) override;
  void drain() override { m_health.beginDrain(false); }

 private:
  MetricsServer::Response answer(std::string_view path);
  void measure(Clock::time_point now);
  void measureRooms();
  void measureSessions();
  void measureCpu();

  HostAccess m_access;
  HostHealth m_health;
  LatestValue<MetricsSnapshot> m_newest;
  MetricsSnapshot m_next;  ///< updated by each measurement; histograms accumulate
  Clock::time_point m_measure_at{};
  std::unique_ptr<MetricsServer> m_server;  ///< last member, because its thread uses the others
};

}  // namespace naiad

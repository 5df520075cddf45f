// What a host measures of itself, and gives out on --metrics: /metrics, /healthz, /readyz.
//
// Once a second, between two ticks, the thread that ticks copies all values into a MetricsSnapshot and hands
// it to the thread of the MetricsServer, which makes a page of it when asked. Nothing that changes is read
// from another thread, and where nothing was asked for nothing is measured.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>

#include "host/admission/Admission.h"
#include "host/metrics/HostPulse.h"
#include "host/metrics/LatestValue.h"
#include "host/metrics/MetricsServer.h"
#include "host/metrics/MetricsSnapshot.h"
#include "host/metrics/StageClock.h"
#include "host/net/NetworkThread.h"
#include "host/rooms/Rooms.h"
#include "host/rooms/SessionTable.h"
#include "host/settings/HostOptions.h"

namespace naiad {

/// All calls are for the thread that ticks.
class HostMetrics {
 public:
  using Clock = std::chrono::steady_clock;

  /// What it measures; all of it outlives this.
  struct Sources {
    const HostOptions& options;
    const Counters& counters;
    NetworkThread& network;
    const SessionTable& sessions;
    const Rooms& rooms;
    const Admission& admission;
    StageClock& stages;
  };

  /// Listens on HostOptions::metrics. Throws MetricsError.
  explicit HostMetrics(const Sources& sources);
  ~HostMetrics();
  HostMetrics(const HostMetrics&) = delete;
  HostMetrics& operator=(const HostMetrics&) = delete;

  std::uint16_t port() const { return m_server->port(); }

  /// Ticks of this length begin.
  void begin(std::chrono::nanoseconds tick_length);
  /// A tick begins that was due at `deadline`.
  void beginTick(std::uint64_t number, Clock::time_point deadline, Clock::time_point now);
  /// All that the tick has sent is with the network thread; further calls for one tick are ignored.
  void endTick(Clock::time_point now);
  /// Between two ticks: measure, if it is time.
  void update(Clock::time_point now);
  /// The host lets no new players in; `ticks`: but it ticks on.
  void beginDrain(bool ticks) { m_pulse.beginDrain(ticks); }
  /// It does not end after all.
  void cancelDrain() { m_pulse.cancelDrain(); }

 private:
  MetricsServer::Answer answer(std::string_view path);
  void measure(Clock::time_point now);
  void measureRooms();
  void measureSessions();
  void measureCpu();

  Sources m_sources;
  HostPulse m_pulse;
  LatestValue<MetricsSnapshot> m_newest;
  MetricsSnapshot m_next;  ///< histograms and times that go on
  Clock::time_point m_tick_began{};
  Clock::time_point m_measure_at{};
  bool m_in_tick = false;
  std::unique_ptr<MetricsServer> m_server;  ///< last: its thread uses the others
};

}  // namespace naiad

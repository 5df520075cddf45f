// A real server on a real loopback port, in a thread of this process, with a world made for the test.
#pragma once

#include <atomic>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "engine/world/World.h"
#include "host/loop/Host.h"
#include "host/loop/HostClients.h"
#include "host/loop/HostControls.h"
#include "host/loop/HostEndpoint.h"
#include "host/settings/HostOptions.h"
#include "shared/values/Canvas.h"

namespace naiad::test {

/// Returns options for tests: any free port, plain TCP, no grace time, ticks of 3 ms.
HostOptions fastOptions();

class TestServer {
 public:
  /// `populate` runs in the server's thread, in the new world, before the first tick.
  explicit TestServer(std::function<void(df::World&)> populate, HostOptions options = fastOptions());
  ~TestServer();

  std::uint16_t port() const { return m_host->endpoint().port(); }
  /// Returns the port of the metrics page, as logged by the server; 0 without metrics.
  std::uint16_t metricsPort() const { return m_metrics_port; }
  std::optional<Fingerprint> fingerprint() const { return m_host->endpoint().fingerprint(); }
  /// Runs `job` on the server's thread between two ticks and returns its result.
  template <class Job>
  auto inWorld(Job job) {
    std::promise<decltype(job(std::declval<df::World&>()))> result;
    m_host->post([&](df::World& world) { result.set_value(job(world)); });
    return result.get_future().get();
  }
  Counters counters() {
    return inWorld([this](df::World&) { return m_host->context().counters; });
  }
  /// Returns the counters of received datagrams: delivered ones, and dropped ones by reason.
  DatagramDemuxCounters datagrams() {
    return inWorld([this](df::World&) { return m_host->endpoint().network().gateCounters(); });
  }
  /// Returns the number of ticks after which the server knew that this player was not up to date.
  std::uint64_t skippedTicks(std::uint32_t player) {
    return inWorld([this, player](df::World&) { return m_host->clients().sessions().skippedTicks(player); });
  }
  /// Returns the picture of `player` after `tick`, drawn by the engine's own draw(); nullopt if they were not
  /// in the game.
  std::optional<df::Canvas> truth(std::uint32_t tick, std::uint32_t player) const;
  /// Sets whether pictures for truth() are recorded. With many players this takes more time than the rest of
  /// the server.
  void keepTruth(bool keep) { m_draws = keep; }
  /// Schedules a shutdown by this plan and returns at once. The server runs until the planned time.
  void end(const ShutdownScheduler::Plan& plan) {
    inWorld([&](df::World&) {
      m_host->controls().end(plan);
      return true;
    });
  }
  /// Ends the server with this message to the players, and waits for its end.
  void stop(const std::string& sentence);

 private:
  void record(df::World& world);

  void readLog(const LogEvent& event);

  std::uint16_t m_metrics_port = 0;
  std::unique_ptr<Host> m_host;
  std::atomic<bool> m_draws = true;
  mutable std::mutex m_mutex;
  std::map<std::pair<std::uint32_t, std::uint32_t>, df::Canvas> m_truth;  ///< pictures by tick and player
  std::thread m_thread;
};

}  // namespace naiad::test

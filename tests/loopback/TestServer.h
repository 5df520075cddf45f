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

/// Options for tests: any free port, plain TCP, no grace, short ticks so that a thousand of them take
/// seconds.
HostOptions fastOptions();

class TestServer {
 public:
  /// `populate` runs in the server's thread, in the new world, before the first tick.
  explicit TestServer(std::function<void(df::World&)> populate, HostOptions options = fastOptions());
  ~TestServer();

  std::uint16_t port() const { return m_host->endpoint().port(); }
  /// As the log says it; 0: it does not.
  std::uint16_t metricsPort() const { return m_metrics_port; }
  std::optional<Fingerprint> fingerprint() const { return m_host->endpoint().fingerprint(); }
  /// Run `job` on the server's thread between two ticks and return what it returns.
  template <class Job>
  auto inWorld(Job job) {
    std::promise<decltype(job(std::declval<df::World&>()))> result;
    m_host->post([&](df::World& world) { result.set_value(job(world)); });
    return result.get_future().get();
  }
  Counters counters() {
    return inWorld([this](df::World&) { return m_host->context().counters; });
  }
  /// What became of the datagrams that have arrived.
  DatagramGateCounters datagrams() {
    return inWorld([this](df::World&) { return m_host->endpoint().network().gateCounters(); });
  }
  /// Ticks at whose end the server knew that this player was not up to date.
  std::uint64_t skippedTicks(std::uint32_t player) {
    return inWorld([this, player](df::World&) { return m_host->clients().sessions().skippedTicks(player); });
  }
  /// What the book's draw path shows `player` at the end of `tick`, if they were in that tick.
  std::optional<df::Canvas> truth(std::uint32_t tick, std::uint32_t player) const;
  /// From now on, is the truth kept? With many players it takes longer than all the rest.
  void keepTruth(bool keep) { m_draws = keep; }
  /// End the server so; it goes on until then.
  void end(const Ending::Plan& plan) {
    inWorld([&](df::World&) {
      m_host->controls().end(plan);
      return true;
    });
  }
  /// End the server with this sentence to the players, and wait for it.
  void stop(const std::string& sentence);

 private:
  void record(df::World& world);

  void readLog(const LogEvent& event);

  std::uint16_t m_metrics_port = 0;
  std::unique_ptr<Host> m_host;
  std::atomic<bool> m_draws = true;
  mutable std::mutex m_mutex;
  std::map<std::pair<std::uint32_t, std::uint32_t>, df::Canvas> m_truth;  ///< by tick and player
  std::thread m_thread;
};

}  // namespace naiad::test

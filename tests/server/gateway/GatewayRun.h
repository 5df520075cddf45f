// Runs a gateway with a small page on a free loopback port, in a thread of this process.
#pragma once

#include <filesystem>
#include <future>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "server/gateway/Gateway.h"
#include "tests/support/TempFolder.h"
#include "tests/support/WaitUntil.h"

namespace naiad::test {

/// A temporary folder with a page, in which tests also put sockets and keys.
class GatewayHome {
 public:
  GatewayHome();

  std::filesystem::path path(const std::string& name) const { return m_folder / name; }
  /// Returns settings of a gateway that listens on a free port and connects to a server with this key.
  GatewaySettings settings(const ShortKey& key) const;

 private:
  TempFolder m_folder;
};

/// Return the contents of the page's files.
std::string indexText();
std::string wasmBytes();

class GatewayRun {
  template <class Job>
  auto onThread(Job job) {
    std::packaged_task<decltype(job())()> task(std::move(job));
    m_gateway.post([&] { task(); });
    return task.get_future().get();
  }

 public:
  explicit GatewayRun(const GatewaySettings& settings);
  ~GatewayRun();
  GatewayRun(const GatewayRun&) = delete;
  GatewayRun& operator=(const GatewayRun&) = delete;

  std::uint16_t port() const { return m_port; }
  GatewayCounters counters() {
    return onThread([this] { return m_gateway.counters(); });
  }
  std::size_t connections() {
    return onThread([this] { return m_gateway.connections(); });
  }
  void stop() {
    onThread([this] { m_gateway.stop(); });
  }
  void reloadCertificate() {
    onThread([this] { m_gateway.reloadCertificate(); });
  }
  /// Waits until the gateway has ended, without stopping it.
  void join() { m_thread.join(); }
  std::vector<std::string> lines();

 private:
  std::mutex m_mutex;
  std::vector<std::string> m_lines;
  Gateway m_gateway;
  std::uint16_t m_port;
  std::thread m_thread;
};

}  // namespace naiad::test

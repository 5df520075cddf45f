// Runs a gateway with a small page on a free loopback port, in a thread of this process.
#pragma once

#include <filesystem>
#include <fstream>
#include <future>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "server/gateway/Gateway.h"
#include "tests/support/TempFolder.h"
#include "tests/support/WaitUntil.h"

namespace naiad::test {

/// Return the contents of the page's files.
inline std::string indexText() {
  std::string text = "<!doctype html><title>Naiad</title>";
  for (int i = 0; i < 100; ++i) text += "<p>a line of the page</p>";
  return text;
}
inline std::string wasmBytes() {
  std::string bytes("\0asm\1\0\0\0", 8);
  for (unsigned i = 0; i < 300'000; ++i) bytes.push_back(static_cast<char>(i * i >> 3));
  return bytes;
}

/// A temporary folder with a page, in which tests also put sockets and keys.
class GatewayHome {
 public:
  GatewayHome() {
    std::filesystem::create_directories(path("page/folder"));
    write(path("page/index.html"), indexText());
    write(path("page/client.wasm"), wasmBytes());
    write(path("page/font.woff2"), "a font");
    write(path("page/.hidden"), "secret");
    write(path("page/folder/other.js"), "secret");
    write(path("secret.txt"), "secret");
  }

  std::filesystem::path path(const std::string& name) const { return m_folder / name; }
  /// Returns settings of a gateway that listens on a free port and connects to a server with this key.
  GatewaySettings settings(const ShortKey& key) const {
    GatewaySettings settings;
    settings.link = JoinLink{LinkHost{"game.test", kDefaultPort}, "", key};
    settings.visitors = path("visitors").string();
    settings.port = 0;
    settings.page = path("page");
    settings.name = "A \"game\"";
    return settings;
  }

 private:
  static void write(const std::filesystem::path& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
  }

  TempFolder m_folder;
};

class GatewayRun {
  template <class Job>
  auto onThread(Job job) {
    std::packaged_task<decltype(job())()> task(std::move(job));
    m_gateway.post([&] { task(); });
    return task.get_future().get();
  }

 public:
  explicit GatewayRun(const GatewaySettings& settings)
      : m_gateway(settings,
                  [this](const std::string& line) {
                    const std::lock_guard lock(m_mutex);
                    m_lines.push_back(line);
                  }),
        m_port(m_gateway.port()),
        m_thread([this] { m_gateway.run(); }) {}
  ~GatewayRun() {
    if (!m_thread.joinable()) return;
    stop();
    m_thread.join();
  }
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
  std::vector<std::string> lines() {
    const std::lock_guard lock(m_mutex);
    return m_lines;
  }

 private:
  std::mutex m_mutex;
  std::vector<std::string> m_lines;
  Gateway m_gateway;
  std::uint16_t m_port;
  std::thread m_thread;
};

}  // namespace naiad::test

// Runs the real nats-server as a process of the test, on its own port.
#pragma once

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

#include "tests/support/TempFolder.h"
#include "tests/support/Text.h"

namespace naiad::test {

class NatsServer {
 public:
  static constexpr const char* kProgram = "/usr/sbin/nats-server";
  static bool isInstalled() { return ::access(kProgram, X_OK) == 0; }

  /// `config`: additional lines of the configuration.
  explicit NatsServer(const std::string& config = "") {
    std::ofstream(m_folder / "config") << config << "\n";
  }
  ~NatsServer() { kill(); }
  NatsServer(const NatsServer&) = delete;
  NatsServer& operator=(const NatsServer&) = delete;

  /// Starts the server on any free port, or again on its earlier port. False on failure.
  bool start() {
    const std::string port = m_port.empty() ? "-1" : m_port;
    std::error_code error;
    std::filesystem::remove(portsFile(), error);
    m_process = ::fork();
    if (m_process == 0) {
      const std::string log = m_folder / "log";
      ::execl(kProgram, kProgram, "-a", "127.0.0.1", "-p", port.c_str(), "-js", "-sd",
              (m_folder / "store").c_str(), "-c", (m_folder / "config").c_str(), "-l", log.c_str(),
              "--ports_file_dir", m_folder.path().c_str(), nullptr);
      _exit(127);
    }
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (std::chrono::steady_clock::now() < end && ::waitpid(m_process, nullptr, WNOHANG) == 0) {
      if (readPort()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return false;
  }
  void kill() {
    if (m_process <= 0) return;
    ::kill(m_process, SIGKILL);
    ::waitpid(m_process, nullptr, 0);
    m_process = -1;
  }
  /// Stops answering until resume(), like a bus behind a broken network.
  void pause() const { ::kill(m_process, SIGSTOP); }
  void resume() const { ::kill(m_process, SIGCONT); }
  std::string url(const std::string& user = "") const {
    return "nats://" + (user.empty() ? "" : user + "@") + "127.0.0.1:" + m_port;
  }
  std::string log() const { return contentOf(m_folder / "log"); }

 private:
  std::filesystem::path portsFile() const {
    return m_folder / ("nats-server_" + std::to_string(m_process) + ".ports");
  }
  /// Reads {"nats":["nats://127.0.0.1:40123"]}, which the server writes once it listens.
  bool readPort() {
    const std::string text = contentOf(portsFile());
    const std::size_t begin = text.find("127.0.0.1:");
    if (begin == std::string::npos || text.find('"', begin) == std::string::npos) return false;
    m_port = text.substr(begin + 10, text.find('"', begin) - begin - 10);
    return true;
  }

  TempFolder m_folder;
  std::string m_port;
  pid_t m_process = -1;
};

}  // namespace naiad::test

// A folder for the keys, pins and options of an encrypted test.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>

#include "TestClient.h"
#include "host/settings/HostOptions.h"
#include "tests/support/TempFolder.h"

namespace naiad::test {

class Home {
 public:
  /// Returns options for TLS and datagrams with a key in this home; a tick takes 5 ms.
  HostOptions server(const std::string& identity = "identity") const {
    HostOptions options;
    options.port = 0;
    options.address = "127.0.0.1";
    options.identity = this->identity(identity);
    options.frame_micros = 5000;
    return options;
  }
  /// Returns a player's setup that pins server keys in this home and reconnects after a broken connection.
  ClientSetup player(const std::string& name) const {
    ClientSetup setup;
    setup.options.name = name;
    setup.options.program = "test";
    setup.trust.known_servers = knownServers();
    setup.trust.max_redirect_wait = std::chrono::milliseconds(10);
    setup.rejoin = true;
    return setup;
  }
  std::filesystem::path identity(const std::string& name) const { return m_directory / name; }
  std::filesystem::path knownServers() const { return m_directory / "known_servers"; }
  std::filesystem::path sessions() const { return m_directory / "sessions"; }

 private:
  TempFolder m_directory;
};

}  // namespace naiad::test

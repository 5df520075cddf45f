// The gateway for browsers: serves the page, and leads WebSockets to one dfserver.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "server/gateway/GatewaySettings.h"
#include "shared/program/LineLog.h"

namespace naiad {

/// It cannot listen there, or with this certificate; what() is a sentence.
class GatewayError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// All of it happens in run(), on the thread that calls it. Other calls are for that thread or for a time
/// when none is in run(), but for post().
class Gateway {
 public:
  /// Listens from now on; what comes waits for run(). Plain HTTP is for loopback addresses alone. Throws
  /// GatewayError, and PageError (PageFiles.h).
  Gateway(GatewaySettings settings, LogLine log);
  /// Hangs up on everybody.
  ~Gateway();
  Gateway(const Gateway&) = delete;
  Gateway& operator=(const Gateway&) = delete;

  /// "127.0.0.1:8080" or "[::]:443" into the settings. False if it is none: a numeric address is wanted.
  static bool parseListen(std::string_view text, GatewaySettings& settings);

  std::uint16_t port() const;
  /// What players type: "http://127.0.0.1:8080/#KEY", the given origins first.
  std::vector<std::string> addresses() const;
  const GatewayCounters& counters() const;
  /// Connections and WebSockets that there are.
  std::size_t guests() const;

  /// SIGINT and SIGTERM stop it; SIGHUP opens the log again and reads the certificate. A second one of the
  /// first two has its usual effect.
  void heedSignals();
  /// Serve until stop() was called and everybody has gone.
  void run();
  /// Call this in run(). Any thread.
  void post(std::function<void()> job);
  /// Read certificate and key again, for connections from now on. Where they cannot be used, the old ones
  /// stay, and a line of the log says why.
  void reloadCertificate();
  /// Listen no more, close WebSockets with 1001, and log the counters.
  void stop();

 private:
  struct Loop;
  std::unique_ptr<Loop> m_loop;
};

}  // namespace naiad

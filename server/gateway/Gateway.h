// The gateway for browsers: serves the page and connects WebSockets to one dfserver.
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

/// Thrown if the gateway cannot listen or cannot use its certificate. what() is a one-sentence message.
class GatewayError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Handles connections only in run(), on the thread that calls it. Call the other functions, except post(),
/// on that thread or while no thread is in run().
class Gateway {
 public:
  /// Begins to listen; connections wait for run(). Plain HTTP is allowed on loopback addresses only. Throws
  /// GatewayError and PageError (PageFiles.h).
  Gateway(GatewaySettings settings, LogLine log);
  /// Closes all connections at once.
  ~Gateway();
  Gateway(const Gateway&) = delete;
  Gateway& operator=(const Gateway&) = delete;

  /// Parses a numeric address like "127.0.0.1:8080" or "[::]:443" into the settings. False if it is invalid.
  static bool parseListen(std::string_view text, GatewaySettings& settings);

  std::uint16_t port() const;
  /// Returns the URLs for players, like "http://127.0.0.1:8080/#KEY": first those of the settings' origins,
  /// then that of the listening address, unless that is 0.0.0.0 or [::].
  std::vector<std::string> addresses() const;
  const GatewayCounters& counters() const;
  /// Number of current connections and WebSockets.
  std::size_t connections() const;

  /// Installs signal handlers: SIGINT and SIGTERM call stop(), and a second one of them has its default
  /// effect. SIGHUP reopens the log and reloads the certificate.
  void installSignalHandlers();
  /// Serves until stop() was called and all connections have ended.
  void run();
  /// Makes run() call `job`. Call from any thread.
  void post(std::function<void()> job);
  /// Reloads certificate and key for new connections. If they cannot be used, keeps the old ones and logs the
  /// reason.
  void reloadCertificate();
  /// Stops listening, closes WebSockets with code 1001 and other connections at once, and logs the counters.
  void stop();

 private:
  struct Loop;
  std::unique_ptr<Loop> m_loop;
};

}  // namespace naiad

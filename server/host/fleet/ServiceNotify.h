// What a service manager is told of a server (systemd's protocol of sd_notify(3), Type=notify): that it
// listens, how it is, and that it still ticks. One datagram each, without libsystemd.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>

namespace naiad {

/// Not thread-safe. Sending never waits: what a manager that does not read has no room for is lost, but for
/// status and keep-alive, which the next tick sends again.
class ServiceNotify {
 public:
  using Clock = std::chrono::steady_clock;
  /// The value of a variable of the environment, or null.
  using Variable = std::function<const char*(const char* name)>;

  /// Where NOTIFY_SOCKET says; without it nothing is ever sent. WATCHDOG_USEC says how often keep-alives are
  /// expected, if WATCHDOG_PID is absent or this process.
  explicit ServiceNotify(const Variable& variable);
  ServiceNotify();
  ~ServiceNotify();
  ServiceNotify(const ServiceNotify&) = delete;
  ServiceNotify& operator=(const ServiceNotify&) = delete;

  bool isActive() const { return m_socket >= 0; }
  /// The server listens, or goes on after notifyReloading().
  void notifyReady() { send("READY=1"); }
  /// One line for people (`systemctl status`); sent if it is not what was sent last.
  void notifyStatus(const std::string& line);
  /// The settings are read again; notifyReady() ends it.
  void notifyReloading(Clock::time_point now);
  /// The server is about to end.
  void notifyStopping() { send("STOPPING=1"); }
  /// A start, reload or end that goes on takes up to so much longer.
  void extendTimeout(std::chrono::microseconds more);
  /// The server ticks: sends a keep-alive if half of the time between two has passed since the last one. Once
  /// a tick.
  void keepAlive(Clock::time_point now);
  /// Between two keep-alives; nothing if none are expected.
  std::optional<std::chrono::microseconds> keepAliveTime() const { return m_keep_alive; }

 private:
  bool send(const std::string& text) const;

  int m_socket = -1;  ///< connected
  std::optional<std::chrono::microseconds> m_keep_alive;
  std::optional<Clock::time_point> m_kept_alive;
  std::string m_status;
};

}  // namespace naiad

// Notifies a service manager that the server is ready, of its status, and that it still ticks. Implements
// systemd's sd_notify(3) protocol (Type=notify), one datagram per message, without libsystemd.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>

namespace naiad {

/// Not thread-safe. Sending never blocks: if the manager's socket is full, the message is lost. A lost status
/// or keep-alive is sent by the next call of notifyStatus() or keepAlive().
class ServiceNotify {
 public:
  using Clock = std::chrono::steady_clock;
  /// Returns the value of an environment variable, or null.
  using Variable = std::function<const char*(const char* name)>;

  /// Connects to NOTIFY_SOCKET; if it is not set or connecting fails, nothing is ever sent. The manager's
  /// keep-alive timeout is WATCHDOG_USEC, if WATCHDOG_PID is absent or this process.
  explicit ServiceNotify(const Variable& variable);
  ServiceNotify();
  ~ServiceNotify();
  ServiceNotify(const ServiceNotify&) = delete;
  ServiceNotify& operator=(const ServiceNotify&) = delete;

  bool isActive() const { return m_socket >= 0; }
  /// Reports that the server listens, or that a reload is done.
  void notifyReady() { send("READY=1"); }
  /// Sends one line for `systemctl status` if it has changed.
  void notifyStatus(const std::string& line);
  /// Reports that the settings are being reloaded, until notifyReady().
  void notifyReloading(Clock::time_point now);
  /// Reports that the server is about to end.
  void notifyStopping() { send("STOPPING=1"); }
  /// Extends the manager's timeout for the current start, reload or stop.
  void extendTimeout(std::chrono::microseconds more);
  /// Sends a keep-alive if keepAliveTime() has passed since the last one. Call it once a tick.
  void keepAlive(Clock::time_point now);
  /// Interval of keep-alives, half of the manager's timeout; nullopt if none are expected.
  std::optional<std::chrono::microseconds> keepAliveTime() const { return m_keep_alive; }

 private:
  bool send(const std::string& text) const;

  int m_socket = -1;  ///< connected; -1: none
  std::optional<std::chrono::microseconds> m_keep_alive;
  std::optional<Clock::time_point> m_kept_alive;
  std::string m_status;
};

}  // namespace naiad

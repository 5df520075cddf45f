// The service manager as a platform: notifies it that the server is ready, of its status, and that it still
// ticks. Implements systemd's sd_notify(3) protocol (Type=notify), one datagram per message, without
// libsystemd.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>

#include "host/fleet/HostPlatform.h"

namespace naiad {

/// Not thread-safe. Sending never blocks: if the manager's socket is full, the message is lost. A lost status
/// or keep-alive is sent by the next call of notifyPlayers() or notifyTick().
class ServiceNotify : public HostPlatform {
 public:
  /// Returns the value of an environment variable, or null.
  using Variable = std::function<const char*(const char* name)>;

  /// Connects to NOTIFY_SOCKET; if it is not set or connecting fails, nothing is ever sent. The manager's
  /// keep-alive timeout is WATCHDOG_USEC, if WATCHDOG_PID is absent or this process.
  explicit ServiceNotify(const Variable& variable);
  ServiceNotify();
  ~ServiceNotify() override;
  ServiceNotify(const ServiceNotify&) = delete;
  ServiceNotify& operator=(const ServiceNotify&) = delete;

  bool isActive() const { return m_socket >= 0; }
  void notifyReady() override { send("READY=1"); }
  void notifyReloading(Clock::time_point now) override;
  /// Sends a keep-alive if half of the manager's timeout has passed since the last one.
  void notifyTick(Clock::time_point now) override;
  /// Sends one line for `systemctl status` if it has changed.
  void notifyPlayers(const PlatformPlayers& players) override;
  void notifyStopping() override { send("STOPPING=1"); }

 private:
  bool send(const std::string& text) const;

  int m_socket = -1;                                      ///< connected; -1: none
  std::optional<std::chrono::microseconds> m_keep_alive;  ///< interval; nullopt: none are expected
  std::optional<Clock::time_point> m_kept_alive;
  std::string m_status;
};

}  // namespace naiad

// A network namespace for a process and its children, which contains one end of the link.
#pragma once

#include <sys/types.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace bench::path {

/// Thrown if the machine does not allow a link. what() is a reason without blanks, for `skipped=`.
class NotAllowed : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Moves this process into a new user namespace (unless it is root), in which it keeps its user id and may
/// create networks. Its next child begins a new process namespace, whose processes all die with that child.
/// Throws NotAllowed.
void unshareProcesses();

/// A network with a loopback device and a tun device, MTU 1500.
class NetworkNamespace {
 public:
  /// Creates the network and moves the calling process into it. The addresses may be loopback addresses
  /// (127/8 except 127.0.0.1), which are then reached over the link, for servers that listen only on
  /// loopback. TCP's congestion control is the machine's, because a namespace cannot choose it. Throws
  /// NotAllowed.
  NetworkNamespace(const std::string& address, const std::string& peer);
  ~NetworkNamespace();
  NetworkNamespace(const NetworkNamespace&) = delete;
  NetworkNamespace& operator=(const NetworkNamespace&) = delete;

  /// Runs `command` in the network, in its own session. With a `log`, that file is its stdout and stderr, and
  /// it has no stdin. Throws std::runtime_error if fork() fails. Exits with 127 if the program cannot be run.
  pid_t start(const std::vector<std::string>& command, const std::string& log) const;
  /// Returns the non-blocking descriptor for IP packets.
  int tun() const { return m_tun; }

 private:
  void configure(const std::string& address, const std::string& peer) const;
  /// Moves the calling process into the network and executes the command.
  [[noreturn]] void become(const std::vector<std::string>& command, const std::string& log) const;

  int m_tun = -1;
  int m_namespace = -1;
};

}  // namespace bench::path

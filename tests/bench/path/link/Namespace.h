// A network of its own for a process and its children, with one end of the link in it.
#pragma once

#include <sys/types.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace bench::path {

/// The machine does not allow what a link needs. what() is a reason without blanks, for `skipped=`.
class NotAllowed : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Put this process into a new user namespace, unless it is root's, in which it is who it was and may make
/// networks; its next child begins a new process namespace, in which all die when that child does. Throws
/// NotAllowed.
void unshareProcesses();

/// A network with a loopback device and a tun device, MTU 1500.
class NetworkNamespace {
 public:
  /// Makes it, and moves the calling process into it. The addresses may be loopback ones (127/8, but
  /// 127.0.0.1): then those lie on the link, for servers that serve no others. TCP's congestion control is
  /// the machine's: a namespace may not choose. Throws NotAllowed.
  NetworkNamespace(const std::string& address, const std::string& peer);
  ~NetworkNamespace();
  NetworkNamespace(const NetworkNamespace&) = delete;
  NetworkNamespace& operator=(const NetworkNamespace&) = delete;

  /// Runs `command` in it, in a session of its own. With a `log`, that file is its stdout and stderr, and it
  /// has no stdin. Throws std::runtime_error if it cannot be forked; a program that cannot be run ends with
  /// 127.
  pid_t start(const std::vector<std::string>& command, const std::string& log) const;
  /// Reads and writes IP packets, without blocking.
  int tun() const { return m_tun; }

 private:
  void configure(const std::string& address, const std::string& peer) const;
  /// Moves the calling process into it, and becomes the command.
  [[noreturn]] void become(const std::vector<std::string>& command, const std::string& log) const;

  int m_tun = -1;
  int m_namespace = -1;
};

}  // namespace bench::path

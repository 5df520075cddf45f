// Sockets that are open when this program starts: opened by the service manager (systemd's socket activation,
// sd_listen_fds(3)), or by the server that this process ran before. Connections that come while the server is
// not there wait for it.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace naiad {

/// What a server listens with: a socket for streams and one for datagrams, on the same address and port.
/// Plain descriptors: what is opened with them (ServerPort.h) owns and closes them.
struct InheritedSockets {
  int streams = -1;
  int datagrams = -1;
  std::string address;     ///< numeric, as of `--address`
  std::uint16_t port = 0;  ///< of both
  /// The service manager's, which opens them once: every program that this process runs later gets them.
  bool is_service = false;

  /// Others for the same two, which stay open when these are closed: for a process that runs a program again.
  /// Throws std::system_error.
  InheritedSockets duplicate() const;
  /// Leaves these open for the program that this process runs next, and their numbers in its environment.
  /// They keep their numbers: other threads may open and close descriptors until the last moment. Call just
  /// before exec, with sockets that nothing else closes (duplicate()). Throws std::system_error.
  void exportToExec() const;

  /// The value of a variable of the environment, or null.
  using Variable = std::function<const char*(const char* name)>;

  /// What LISTEN_PID and LISTEN_FDS say. Nothing if they are not there, or are for another process. Programs
  /// that this process starts do not get the descriptors. Once in a process. Throws ListenError
  /// (TcpListener.h) if they are not one listening TCP socket and one UDP socket, in any order, on the same
  /// address and port. `first`: the lowest of the descriptors.
  static std::optional<InheritedSockets> take(pid_t process, const Variable& variable, int first = 3);
  /// Returns the sockets that exportToExec() left open for this program, and removes their numbers from the
  /// environment. Without such sockets: as above, for this process and its environment.
  static std::optional<InheritedSockets> take();
};

}  // namespace naiad

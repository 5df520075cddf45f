// Sockets that are already open when this program starts: opened by the service manager (systemd socket
// activation, sd_listen_fds(3)), or by the server program that this process ran before. Connections made
// while no server runs wait in them.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace naiad {

/// The sockets that a server listens on: one for streams and one for datagrams, on one address and port.
/// Plain descriptors: the objects made from them (ServerPort.h) own and close them.
struct InheritedSockets {
  int streams = -1;
  int datagrams = -1;
  std::string address;     ///< numeric, as in `--address`
  std::uint16_t port = 0;  ///< port of both sockets
  /// True if the service manager opened them. It does so once; later programs of this process inherit them.
  bool is_service = false;

  /// Returns duplicates, which stay open when these sockets are closed, for a process that executes a program
  /// again. Throws std::system_error.
  InheritedSockets duplicate() const;
  /// Keeps these sockets open for the next program that this process executes, and puts their numbers into
  /// the environment. They do not change, because other threads may open and close descriptors until exec.
  /// Call just before exec, with sockets that nothing else closes (duplicate()). Throws std::system_error.
  void exportToExec() const;

  /// Returns the value of an environment variable, or null.
  using Variable = std::function<const char*(const char* name)>;

  /// Returns the sockets described by LISTEN_PID and LISTEN_FDS; nullopt if these are missing, name another
  /// process, or state no sockets. Child processes do not inherit the descriptors. Call once per process.
  /// `first`: the lowest descriptor. Throws ListenError (TcpListener.h) unless they are one listening TCP
  /// socket and one UDP socket, in any order, on one address and port.
  static std::optional<InheritedSockets> importSockets(pid_t process, const Variable& variable,
                                                       int first = 3);
  /// Returns the sockets that exportToExec() left open for this program, and removes their numbers from the
  /// environment. Otherwise calls importSockets(process, variable) for this process and its environment.
  static std::optional<InheritedSockets> importSockets();
};

}  // namespace naiad

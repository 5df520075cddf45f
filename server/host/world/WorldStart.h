// Worlds in processes of their own: how one is started, and how a process knows that it is one.
//
// It is started with one end of a Unix socket, whose descriptor its environment names, without the files that
// were open here, with an empty standard input, and in a process group of its own: a Ctrl-C in the terminal
// is for the host.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

namespace naiad {

struct StartedWorld {
  pid_t process = -1;
  int socket = -1;  ///< our end; the caller's to close
};

/// Start a program, in the working directory of when this library was loaded. `arguments`: its name first.
/// Throws std::system_error.
StartedWorld startWorld(const std::string& program, const std::vector<std::string>& arguments);
/// The same of this program, with the arguments that it was started with.
StartedWorld startThisProgramAsWorld();

/// In a process that startWorld() began: its end of the socket. Nothing in others, and when it was asked for
/// before.
std::optional<int> takeWorldSocket();

}  // namespace naiad

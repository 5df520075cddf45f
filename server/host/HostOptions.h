// Everything a host can set, in one table that feeds the command line, the environment, the config file,
// --help and docs/dfserver.md.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <string>

#include "Limits.h"

namespace naiad {

struct HostOptions {
  std::string game = "saucershoot";   ///< name of a shipped game, or path of a module
  std::string address = "127.0.0.1";  ///< numeric address to listen on; loopback only
  int port = kDefaultPort;            ///< 0: any free port
  int max_players = 64;
  std::string name = "naiad";  ///< shown in the clients' status line
  std::int64_t seed = 0;       ///< of the world; 0: a new one each time, logged
  int frame_micros = 0;        ///< length of a tick in microseconds; 0: exactly 1/30 s
  int ticks = 0;               ///< stop after so many; 0: never
  double exit_when_empty = 0;  ///< seconds after the last player left; 0: never
  std::string truth_file;      ///< write what each player should see, tick by tick
  std::string port_file;       ///< write the port number here once listening
  std::string log_file;        ///< append log lines here instead of stderr
};

/// What the command line asked for.
enum class CommandLine { kRun, kListGames, kDone, kUsageError };

/// Fill `options` from the command line, the environment and --config FILE (in this order of precedence).
/// Help, version and usage errors are printed here.
CommandLine parseHostOptions(int argc, const char* const* argv, HostOptions& options);

/// The table of options as Markdown, for docs/dfserver.md.
std::string hostOptionsMarkdown();

}  // namespace naiad

// A host's options. One table feeds the command line, environment, config file, --help and docs/dfserver.md.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "host/net/InheritedSockets.h"
#include "shared/net/base/Limits.h"
#include "shared/options/Options.h"

namespace naiad {

/// Maximum number of players of one server.
inline constexpr int kMaxServerPlayers = 20'000;

struct HostOptions {
  std::string game = "saucershoot";  ///< name of a shipped game, or path of a module
  std::string rooms;           ///< NAME=GAME[,KEY=VALUE…], separated by blanks (RoomOptions.h); empty: none
  std::string address = "::";  ///< numeric address to listen on; "::": all addresses, including IPv4
  int port = kDefaultPort;     ///< 0: any free port
  int max_players = 64;
  int max_per_address = 64;          ///< players from one IPv4 address or IPv6 /64, including detached ones
  std::string name = "naiad";        ///< shown in the clients' status line
  std::int64_t seed = 0;             ///< random seed of the world; 0: a new one each time, logged
  int frame_micros = 0;              ///< length of a tick in microseconds; 0: the game's, else exactly 1/30 s
  int ticks = 0;                     ///< the server stops after this many ticks; 0: never
  double exit_when_empty = 0;        ///< seconds from the last player's leaving to the end; 0: never
  std::string players = "together";  ///< input mode: "together", "first" or "private" (a world per player)
  std::string on_game_over =
      "leave";  ///< effect if one of several players ends the game: "leave" (alone), "exit" or "restart"
  std::string sandbox = "on";     ///< sandbox of world processes: "on" or "off"
  int world_memory = 4096;        ///< address space of each world process in MiB; 0: no limit
  bool in_process = false;        ///< true: dfserver runs the game in its own process
  std::string journal;            ///< directory in which each round is recorded; empty: none
  bool default_journal = false;   ///< not an option; true: `journal` is dfserver's default
  std::string recover = "on";     ///< whether the round of a killed server is resumed: "on" or "off"
  double hang_time = 1;           ///< seconds after which a tick of a world process counts as hung
  std::string world_environment;  ///< names of more variables for world processes, separated by commas
  double room_sleep = 60;         ///< seconds without players after which a room sleeps: its world ends
  bool insecure = false;          ///< plain TCP, loopback only, no datagrams: for tests
  std::string certificate;        ///< PEM file; requires `key`. Empty: self-signed, made on the first start
  std::string key;                ///< PEM file
  std::string identity;           ///< directory of the self-made key; empty: the user's default
  std::string password;           ///< players' password or its Argon2id hash; empty: none
  double grace = 60;              ///< seconds in which a player may reconnect after losing the connection
  double drain_time = 0;          ///< seconds after SIGTERM in which players may finish
  std::string join_file;     ///< file for dfclient's arguments (address, fingerprint), written once listening
  std::string visitors;      ///< path of the doors' socket (ProxyListener.h); empty: none
  std::string link_host;     ///< public HOST[:PORT] in the printed link; empty: unknown
  std::string ssh_door;      ///< USER@HOST[:PORT] of a door to this server; empty: none
  std::string web_address;   ///< URL of a web page to play on; empty: none
  bool qr = false;           ///< also print `web_address` as a QR code
  std::string lan = "auto";  ///< whether it is visible in the local network: "auto", "on" or "off" (LanMode)
  std::string truth_file;    ///< file for the picture that each player should see in each tick
  std::string metrics;       ///< ADDR:PORT for metrics and health; empty: none
  std::string metrics_hosts;        ///< host names accepted in metrics requests, separated by commas
  bool metrics_public = false;      ///< allows a public address in `metrics`
  std::string audit = "on";         ///< audit of players' pictures if there are metrics: "on" or "off"
  std::string status_file;          ///< file for the server's status as JSON, updated every 5 seconds
  std::string port_file;            ///< file for the port number, written once listening
  std::string log_file;             ///< file for log lines; empty: stderr
  std::string log_format = "text";  ///< format of log lines: "text" or "json"
  std::string log_level = "info";   ///< least severe level to log: "error", "warning", "info" or "debug"
  bool log_chat = false;            ///< also log the chat
  std::string control;              ///< path of the socket for commands (ControlSocket.h); empty: none
  bool control_by_port = false;     ///< not an option; true: use controlPath() of the port listened on
  std::string platform = "auto";    ///< platform (HostPlatform.h): "auto", "none", "systemd" or "agones"
  std::string bus;                  ///< nats:// or tls:// address of the fleet's bus (Bus.h); empty: none
  std::string bus_id;               ///< name of this server on the bus; empty: made of machine and port
  int bus_interval_ms = 2000;       ///< heartbeat interval; must equal the directory's
  std::string bus_credentials;      ///< credentials file for the bus; empty: none
  std::string bus_ca;               ///< CA file (PEM) to verify the bus's certificate; empty: the system's
  std::string state;                ///< folder of the ban and score files; empty: none
  std::string admin_password;       ///< password of /admin in the chat or its Argon2id hash; empty: none
  bool vote_kick = false;           ///< players may vote to kick others
  int inactive_kick = 0;            ///< seconds without key, click or chat until a player is kicked; 0: never
  std::vector<std::string> warnings;  ///< warnings about these options, for the log
  /// Not an option: sockets that were open when the program started. `address` and `port` are then theirs.
  std::optional<InheritedSockets> sockets;
  // Only for games that are programs themselves:
  bool headless = false;     ///< no network and no players
  bool local_client = true;  ///< attach a client if started in a terminal
  bool is_public = false;  ///< listen on every address, not only on loopback; not used if `address` is given
};

/// True if each round is recorded.
inline bool usesJournal(const HostOptions& options) {
  return !options.journal.empty() && options.journal != "off";
}

/// True if a game that is a program needs world processes: for further rounds, private worlds or a journal.
inline bool usesWorldProcesses(const HostOptions& options) {
  return options.on_game_over == "restart" || options.players == "private" || usesJournal(options);
}

/// The action that the command line requests.
enum class CommandLine { kRun, kListGames, kDone, kUsageError };

/// Fills `options` from the command line, the environment and --config FILE (in this order of precedence).
/// Prints help, version and usage errors itself.
CommandLine parseHostOptions(int argc, const char* const* argv, HostOptions& options);

/// Reads the options again while the program runs. Prints nothing. Throws OptionError.
HostOptions readHostOptions(int argc, const char* const* argv);

/// Result of a reload: names of options, without dashes.
struct OptionChanges {
  std::vector<std::string> changed;
  std::vector<std::string> need_restart;  ///< options whose new value is not used before a restart
  /// Returns text like "max-players and password have changed; address needs a restart".
  std::string text() const;
};

/// Copies the values that may change while a server runs from `next` to `now`. The caller must still apply a
/// new password, key or certificate.
OptionChanges applyReloadable(const HostOptions& next, HostOptions& now);

/// Returns the value of a key in df-config.txt; empty if the key is missing.
using ConfigValue = std::function<std::string(const std::string& key)>;

/// Returns the location of a key, like "df-config.txt:3: port".
using ConfigLocation = std::function<std::string(const std::string& key)>;

/// Fills `options` for a game that is a program itself, from the environment, else from df-config.txt.
/// Returns the names of the options that were given, without dashes. Such a game listens on loopback by
/// default. Throws OptionError, whose text begins with the variable or location of an invalid value, or is
/// that of validateHostOptions().
std::set<std::string> readProgramOptions(const ConfigValue& value_of, HostOptions& options,
                                         const ConfigLocation& location_of = {});

/// Makes the server use these sockets instead of its own. Adds a warning if an option gave another port.
void useSockets(const InheritedSockets& sockets, HostOptions& options);

/// Adds a warning to `options` if the password, read from `file`, is not a hash and every user can read it.
void warnIfReadable(const std::string& file, HostOptions& options);

/// Sets one option, named without dashes. Throws OptionError.
void setHostOption(HostOptions& options, const std::string& name, const std::string& value);
/// Returns the value of one option as text; empty if there is no such option.
std::string hostOptionValue(const HostOptions& options, const std::string& name);

/// Returns the table of options as Markdown, for docs/dfserver.md.
std::string hostOptionsMarkdown();

}  // namespace naiad

// Everything a host can set, in one table that feeds the command line, the environment, the config file,
// --help and docs/dfserver.md.
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

/// Players that one server takes, at most.
inline constexpr int kMaxServerPlayers = 20'000;

struct HostOptions {
  std::string game = "saucershoot";  ///< name of a shipped game, or path of a module
  std::string rooms;           ///< NAME=GAME[,KEY=VALUE…] with blanks between (RoomList.h); empty: none
  std::string address = "::";  ///< numeric address to listen on; "::" is all of them, IPv4 too
  int port = kDefaultPort;     ///< 0: any free port
  int max_players = 64;
  int max_per_address = 64;          ///< players from one IPv4 address or IPv6 /64, detached ones too
  std::string name = "naiad";        ///< shown in the clients' status line
  std::int64_t seed = 0;             ///< of the world; 0: a new one each time, logged
  int frame_micros = 0;              ///< length of a tick in microseconds; 0: exactly 1/30 s
  int ticks = 0;                     ///< stop after so many; 0: never
  double exit_when_empty = 0;        ///< seconds after the last player left; 0: never
  std::string players = "together";  ///< whose input the game hears: "together", "first" or "private"
  std::string on_game_over =
      "leave";                 ///< by one player among several: "leave" (for them alone), "exit" or "restart"
  std::string sandbox = "on";  ///< of worlds in processes of their own: "on" or "off"
  int world_memory = 4096;     ///< MiB of addresses for each of them; 0: no limit
  bool in_process = false;     ///< dfserver's game plays in the server's own process
  std::string journal;         ///< directory where each round is written down; empty: none is
  bool default_journal = false;  ///< not an option: `journal` is where dfserver writes by itself
  std::string recover = "on";    ///< go on with the round of a server that was killed: "on" or "off"
  double hang_time = 1;  ///< seconds of one tick of a world in a process of its own; then the game hangs
  std::string world_environment;  ///< names of variables that they get, too, with commas between
  double room_sleep = 60;         ///< seconds without players after which a room sleeps
  bool insecure = false;          ///< plain TCP, loopback only, no datagrams: for tests
  std::string certificate;        ///< PEM file; with `key`. Empty: a key of its own, made on the first start
  std::string key;                ///< PEM file
  std::string identity;           ///< directory of the key of its own; empty: the user's
  std::string password;           ///< that players need: itself, or its Argon2id hash; empty: none
  double grace = 60;              ///< seconds that a player whose connection broke may take to come back
  double drain_time = 0;          ///< seconds that SIGTERM gives players to finish
  std::string join_file;          ///< write what to pass to dfclient here once listening
  std::string visitors;           ///< path of a socket for doors (VisitorsListener.h); empty: none
  std::string link_host;  ///< HOST[:PORT] for players elsewhere, in the link that is printed; empty: unknown
  std::string ssh_door;   ///< USER@HOST[:PORT] of a door to this server; empty: none
  std::string web_address;          ///< of a page to play on; empty: none
  bool qr = false;                  ///< print that as a QR code, too
  std::string lan = "auto";         ///< found in the local network: "auto", "on" or "off" (LanMode)
  std::string truth_file;           ///< write what each player should see, tick by tick
  std::string metrics;              ///< ADDR:PORT for metrics and health; empty: none
  std::string metrics_hosts;        ///< names by which they may be asked for, with commas between
  bool metrics_public = false;      ///< `metrics` may be an address of the internet
  std::string audit = "on";         ///< of pictures, where there are metrics: "on" or "off"
  std::string status_file;          ///< write what plays here, as JSON, every few seconds
  std::string port_file;            ///< write the port number here once listening
  std::string log_file;             ///< append log lines here instead of stderr
  std::string log_format = "text";  ///< or "json"
  std::string log_level = "info";   ///< the least: "error", "warning" or "info"
  bool log_chat = false;            ///< log what players say, too
  std::string control;              ///< path of the socket for commands (ControlSocket.h); empty: none
  bool control_by_port = false;     ///< it is controlPath(), by the port listened on
  std::string platform = "auto";    ///< what runs it: "auto", "none", "systemd" or "agones" (HostPlatform.h)
  std::string bus;                  ///< nats:// or tls:// address of the fleet's bus (Bus.h); empty: none
  std::string bus_id;               ///< how it is called there; empty: by machine and port
  int bus_interval_ms = 2000;       ///< between two times that it says it is there; as its directory's
  std::string bus_credentials;      ///< file with what proves that; empty: none
  std::string bus_ca;               ///< PEM file that the bus's certificate is judged by; empty: the system's
  std::string state;                ///< folder of the files of bans and scores; empty: none
  std::string
      admin_password;      ///< for /admin in the chat: itself, or its Argon2id hash; empty: no admins there
  bool vote_kick = false;  ///< players may vote others out
  int inactive_kick = 0;   ///< seconds without key, click or line before a player has to go; 0: for ever
  std::vector<std::string> warnings;  ///< about these options, for the log
  /// Not an option: what the service manager has opened. `address` and `port` are those of the sockets then.
  std::optional<InheritedSockets> sockets;
  // Of games that are programs themselves:
  bool headless = false;     ///< no network and no players
  bool local_client = true;  ///< in a terminal: attach a client there
  bool is_public = false;    ///< listen on every address unless `address` is given; else on loopback
};

/// Is each round to be written down?
inline bool wantsJournal(const HostOptions& options) {
  return !options.journal.empty() && options.journal != "off";
}

/// Has a game that is a program itself worlds in processes of their own? Another round, or another world
/// beside the first, is another process, and so is a world that is written down.
inline bool wantsWorlds(const HostOptions& options) {
  return options.on_game_over == "restart" || options.players == "private" || wantsJournal(options);
}

/// What the command line asked for.
enum class CommandLine { kRun, kListGames, kDone, kUsageError };

/// Fill `options` from the command line, the environment and --config FILE (in this order of precedence).
/// Help, version and usage errors are printed here.
CommandLine parseHostOptions(int argc, const char* const* argv, HostOptions& options);

/// The same options again, while the program runs: nothing is printed. Throws OptionError.
HostOptions readHostOptions(int argc, const char* const* argv);

/// What became of options that were read again: names without dashes.
struct OptionChanges {
  std::vector<std::string> changed;
  std::vector<std::string> need_restart;  ///< have another value now, which is not used
  /// "max-players and password have changed; address needs a restart".
  std::string text() const;
};

/// Take over those values of `next` that may change while a server runs. Only the password's hash, the key
/// and the certificate are not used by that alone.
OptionChanges takeOver(const HostOptions& next, HostOptions& now);

/// The value of a key in df-config.txt, empty if there is none.
using ConfigValue = std::function<std::string(const std::string& key)>;

/// Where a key stands, like "df-config.txt:3: port".
using ConfigPlace = std::function<std::string(const std::string& key)>;

/// Fill `options` for a game that is a program itself: from the environment and, where that does not say,
/// from df-config.txt. Return the names of the options that one of them gave, without dashes in front. Such a
/// game listens on loopback, unless told otherwise. Throws OptionError, which begins with the variable or
/// with place_of(key).
std::set<std::string> readProgramOptions(const ConfigValue& value_of, HostOptions& options,
                                         const ConfigPlace& place_of = {});

/// Listen with these instead of opening `address` and `port`; a warning if an option gave another port.
void useSockets(const InheritedSockets& sockets, HostOptions& options);

/// `file` gave the password: add a warning to `options` if every user can read it there, and it is no hash.
void warnOfReaders(const std::string& file, HostOptions& options);

/// Store the value of one option, named without dashes. Throws OptionError.
void setHostOption(HostOptions& options, const std::string& name, const std::string& value);
/// The value of one, as text; empty if there is no such option.
std::string hostOptionValue(const HostOptions& options, const std::string& name);

/// The table of options as Markdown, for docs/dfserver.md.
std::string hostOptionsMarkdown();

}  // namespace naiad

#include "host/settings/HostOptions.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <iostream>
#include <utility>
#include <variant>
#include <vector>

#include "host/settings/DefaultFolders.h"
#include "host/settings/HostOptionsCheck.h"
#include "host/settings/RoomOptions.h"
#include "shared/options/OptionPages.h"
#include "shared/options/Options.h"

namespace naiad {

namespace {

/// The programs that accept an option: dfserver, games that are programs themselves (df-config.txt instead of
/// a command line), or both.
enum class UsedBy { kBoth, kServer, kProgram };

struct Row {
  Option option;
  UsedBy used_by;
};

using OneOf = std::vector<std::string>;
using Values = std::variant<std::monostate, OptionRange, OneOf>;

/// Makes a row. The environment variable is named after the option: NAIAD_MAX_PLAYERS sets --max-players.
Row row(const std::string& name, OptionTarget target, const char* help, const Values& values = {},
        UsedBy used_by = UsedBy::kBoth) {
  Option option{name, std::move(target), help, variableNameOf(name)};
  if (const auto* p_range = std::get_if<OptionRange>(&values)) option.range = *p_range;
  if (const auto* p_words = std::get_if<OneOf>(&values)) option.one_of = *p_words;
  option.joins = name == "--room";
  return {std::move(option), used_by};
}

/// Returns the table of options, with its targets in `o`.
std::vector<Row> tableOf(HostOptions& o) {
  return {
      row("--game", &o.game, "Game to host: a name from --list-games or the path of a module (.so)", {},
          UsedBy::kServer),
      row("--room", &o.rooms,
          "NAME=GAME[,KEY=VALUE…]: add a room that plays this game; repeat it for each room (in the "
          "environment: separated by spaces). Players start in the first room, or join with HOST/NAME. KEY "
          "is max-players, world-memory, seed or input-mode, like the options",
          {}, UsedBy::kServer),
      row("--room-sleep", &o.room_sleep,
          "Seconds without players after which a room ends its round and its process; the next player starts "
          "a new one",
          OptionRange{0, 1e6, kSecond}, UsedBy::kServer),
      row("--address", &o.address,
          "Numeric address to listen on; :: means all addresses of this machine, IPv6 and IPv4"),
      row("--port", &o.port, "Port to listen on, TCP and UDP; 0: any free port", OptionRange{0, 65535}),
      row("--max-players", &o.max_players, "Maximum number of players", OptionRange{1, kMaxServerPlayers}),
      row("--max-per-address", &o.max_per_address,
          "Maximum number of players from one IPv4 address or IPv6 /64 network, including disconnected ones",
          OptionRange{1, static_cast<double>(kMaxServerPlayers)}),
      row("--server-name", &o.name, "Name shown to players"),
      row("--seed", &o.seed, "Seed of the world's random numbers; 0: use a new one and log it",
          OptionRange{0, 9e15}),
      row("--frame-time", &o.frame_micros,
          "Length of a tick in microseconds, at least 1000; 0: as the game's df-config.txt says, else 1/30 s",
          OptionRange{0, 1e6, kMicrosecond}),
      row("--ticks", &o.ticks, "Stop after this many ticks; 0: never", OptionRange{0, 2e9}),
      row("--exit-when-empty", &o.exit_when_empty,
          "Stop this many seconds after the last player has left (at least 60 if no player ever joins); 0: "
          "never",
          OptionRange{0, 1e6, kSecond}),
      row("--input-mode", &o.players,
          "Whose input the game gets: together = all players'; first = that of one player, while the others "
          "watch and wait for their turn; private = each player plays in a separate world and process",
          OneOf{"together", "first", "private"}),
      row("--on-game-over", &o.on_game_over,
          "What happens when the input of one of several players ends the game: leave = only this player "
          "leaves; exit = the game ends for all; restart = like leave, and after a game over or crash the "
          "next round starts in a new process, with the players still connected",
          OneOf{"leave", "exit", "restart"}),
      row("--sandbox", &o.sandbox,
          "on: game processes cannot open connections, reach this user's other processes, or open other "
          "files than the game's, as far as the kernel supports Landlock and seccomp; off: they can do "
          "everything that this user can",
          OneOf{"on", "off"}),
      row("--world-memory", &o.world_memory, "Limit of a game process's address space, in MiB; 0: no limit",
          OptionRange{0, 1 << 20}),
      row("--tick-timeout", &o.hang_time,
          "Seconds after which a tick of a game process counts as hung: the log says what the game is doing, "
          "and after 5 times as long the process is killed. Time lost to load on the machine or in a "
          "debugger does not count",
          OptionRange{0.1, 600, kSecond}),
      row("--world-environment", &o.world_environment,
          "Names of environment variables, separated by commas, that game processes get in addition to the "
          "usual ones"),
      row("--in-process", &o.in_process,
          "Run the game in the server's own process, for a debugger or for very large worlds: without "
          "sandbox and journal, and a crash of the game ends the server",
          {}, UsedBy::kServer),
      row("--journal", &o.journal,
          "Record each round to a file in this directory: dfreplay can replay it, and after a crash the next "
          "server resumes it. The game then gets repeatable clocks and random devices. off: do not record. "
          "Default: rounds in the --state folder; off with --input-mode private or --in-process, and for "
          "games that are programs themselves"),
      row("--recover", &o.recover,
          "After a crash of the server during a recorded round: on = replay the round, so that its players "
          "can continue; off = start a new round",
          OneOf{"on", "off"}),
      row("--insecure", &o.insecure,
          "Use no encryption and no datagrams, on loopback by default (for tests)"),
      row("--certificate", &o.certificate,
          "Certificate chain (PEM), with --key; default: self-signed, made on the first start"),
      row("--key", &o.key, "Private key (PEM) of --certificate, readable only by you"),
      row("--identity", &o.identity,
          "Directory of the key that the server creates; default: naiad in your configuration directory"),
      row("--password", &o.password,
          "Password that players need, or its $argon2id$ hash (other users can see the command line: prefer "
          "the environment or --config)"),
      row("--reconnect-time", &o.grace, "Seconds in which a disconnected player can reconnect; 0: not at all",
          OptionRange{0, 3600, kSecond}),
      row("--drain-timeout", &o.drain_time,
          "Seconds that players have to finish after SIGTERM: new ones are refused, and the server stops "
          "when all have left or the time is over; 0: stop at once",
          OptionRange{0, 86400, kSecond}),
      row("--join-file", &o.join_file,
          "Write the address and fingerprint to this file once listening, as arguments for dfclient"),
      row("--proxy-socket", &o.visitors,
          "Path of a socket for this machine's ssh and web doors (mode 0660); processes that can write to it "
          "are trusted to state the players' addresses"),
      row("--public-host", &o.link_host,
          "Host name or address of this machine for players elsewhere, printed in the link; HOST:PORT if a "
          "router forwards another port"),
      row("--ssh-door", &o.ssh_door,
          "Also print how to play with ssh: USER@HOST[:PORT] of a door to this server"),
      row("--web-address", &o.web_address, "Also print this address of the browser page (https://…)"),
      row("--qr", &o.qr, "Also print --web-address as a QR code"),
      row("--lan", &o.lan,
          "Let dfclient without arguments find this server in the local network: auto = on private "
          "addresses, on = on all addresses, off = never",
          OneOf{"auto", "on", "off"}),
      row("--truth-file", &o.truth_file,
          "Write to this file what each player should see in each tick (for tests; large)"),
      row("--metrics", &o.metrics,
          "Serve metrics for Prometheus (/metrics) and health checks (/healthz, /readyz) by HTTP on this "
          "numeric ADDR:PORT, like 127.0.0.1:9100; port 0: any free port"),
      row("--metrics-hosts", &o.metrics_hosts,
          "Host names, separated by commas, that requests to --metrics may use in addition to localhost and "
          "addresses"),
      row("--metrics-public", &o.metrics_public,
          "Allow a public address for --metrics; the metrics are then readable from the internet"),
      row("--replica-audit", &o.audit,
          "With --metrics: compare one player's picture with the world's, one second in ten, and count wrong "
          "cells",
          OneOf{"on", "off"}),
      row("--port-file", &o.port_file, "Write the port number to this file once listening"),
      row("--status-file", &o.status_file,
          "Write name, game, number of players and link (see --public-host) to this file as JSON, every 5 "
          "seconds, for server lists on the web. The file is removed when the server stops"),
      row("--log-file", &o.log_file, "Append log lines to this file instead of stderr"),
      row("--log-format", &o.log_format,
          "Format of log lines: text = sentences; json = one object per line, with named fields",
          OneOf{"text", "json"}, UsedBy::kServer),
      row("--log-level", &o.log_level, "Least severe level to log",
          OneOf{"error", "warning", "info", "debug"}, UsedBy::kServer),
      row("--log-chat", &o.log_chat, "Also log the players' chat"),
      row("--control", &o.control,
          "Path of the socket for dfctl (mode 0660); users that can write to it are admins; off: no socket. "
          "Default: naiad/control-PORT.sock in the user's runtime directory ($XDG_RUNTIME_DIR), else in "
          "~/.local/state; off for games that are programs themselves"),
      row("--state", &o.state,
          "Folder of data that outlives a restart: bans, scores, recorded rounds. Default: naiad in the "
          "user's state directory ($XDG_STATE_HOME, ~/.local/state); none for games that are programs "
          "themselves"),
      row("--admin-password", &o.admin_password,
          "Password that makes a player an admin in the chat (/admin PASSWORD), or its $argon2id$ hash; as "
          "for --password, prefer the environment or --config"),
      row("--vote-kick", &o.vote_kick,
          "Let players ban another one for five minutes by a vote (/vote kick NAME): more than half of the "
          "players' addresses must agree within 30 seconds"),
      row("--idle-kick", &o.inactive_kick,
          "Seconds without key, click or chat after which a player is disconnected, with a warning 10 "
          "seconds before; 0: never",
          OptionRange{0, 86400, kSecond}),
      row("--platform", &o.platform,
          "Platform to which the server reports that it is ready, healthy, in use or stopping: "
          "systemd; agones = the sidecar at 127.0.0.1, port $AGONES_SDK_HTTP_PORT (9358); none; auto = "
          "detect it by its environment variable",
          OneOf{"auto", "none", "systemd", "agones"}),
      row("--bus", &o.bus,
          "Publish this server's state and scores on this NATS server: nats://HOST:PORT or tls://HOST:PORT "
          "(other users can see the command line: prefer --bus-credentials to a password there)"),
      row("--bus-id", &o.bus_id,
          "Name of this server on the bus, of a-z, 0-9 and '-'; default: made from the machine's name and "
          "the port"),
      row("--bus-interval", &o.bus_interval_ms,
          "Heartbeat interval in milliseconds; must equal the directory's",
          OptionRange{50, 60'000, kMillisecond}),  // as in BusPayloads.h
      row("--bus-credentials", &o.bus_credentials, "Credentials file for the bus, as written by nsc"),
      row("--bus-ca", &o.bus_ca, "CA certificates (PEM) to verify a tls:// bus; default: the system's"),
      row("--headless", &o.headless, "Run without network and players, as fast as possible", {},
          UsedBy::kProgram),
      row("--local-client", &o.local_client, "If started in a terminal, also play in it", {},
          UsedBy::kProgram),
      row("--public", &o.is_public,
          "Accept players from other machines: listen on all addresses, not only on loopback", {},
          UsedBy::kProgram),
  };
}

/// Options whose new value a reload applies while the server runs.
constexpr std::string_view kLive[] = {"--max-players",     "--max-per-address", "--server-name",
                                      "--exit-when-empty", "--password",        "--reconnect-time",
                                      "--drain-timeout",   "--certificate",     "--key",
                                      "--log-format",      "--log-level",       "--log-chat",
                                      "--vote-kick",       "--idle-kick"};

/// Variables that are not in the table but are read by this or other programs of the project.
const char* const kOtherVariables[] = {
    "NAIAD_ASCII",      "NAIAD_CLIENT",        "NAIAD_FINGERPRINT", "NAIAD_GAMES",
    "NAIAD_IDLE_LIMIT", "NAIAD_KNOWN_SERVERS", "NAIAD_MENU_KEY",    "NAIAD_NAME",
    "NAIAD_NO_MOUSE",   "NAIAD_NO_REDIRECT",   "NAIAD_NO_RESUME",   "NAIAD_SERVER",
    "NAIAD_SOCKETS",    "NAIAD_SOUND",         "NAIAD_WORLD_SEED",  "NAIAD_WORLD_SOCKET"};

/// Returns the type of an option's value in --help and completions, if it is a file, directory or socket.
const char* typeOf(const std::string& name) {
  for (const char* p_file : {"--certificate", "--key", "--join-file", "--truth-file", "--port-file",
                             "--log-file", "--bus-credentials", "--bus-ca"})
    if (name == p_file) return "FILE";
  if (name == "--identity" || name == "--journal") return "DIR";
  return name == "--proxy-socket" ? "SOCKET" : "";
}

void warnOfUnknownVariables(const std::vector<Row>& rows, HostOptions& options) {
  std::vector<std::string> known(std::begin(kOtherVariables), std::end(kOtherVariables));
  for (const Row& row : rows) {
    known.push_back(row.option.environment);
    if (const std::string former = formerNameOf(row.option.name); !former.empty())
      known.push_back(variableNameOf(former));
  }
  for (const std::string& sentence : unknownVariableWarnings(environ, "NAIAD_", known))
    options.warnings.push_back(sentence);
}

constexpr const char* kLoopback = "127.0.0.1";

const char* const kExitCodes =
    "Exit codes:\n"
    "  0  regular end (game over, --ticks, --exit-when-empty, SIGINT, SIGTERM, or SIGHUP in a terminal;\n"
    "     a second signal ends the server at once, with a goodbye to its players, by that signal)\n"
    "  1  the game's main() returned an error or threw an exception, or the game hung when the server was\n"
    "     to stop\n"
    "  2  wrong usage\n"
    "  3  no such game, or its module cannot be loaded\n"
    "  4  cannot listen on that address and port\n"
    "  5  a file cannot be written, or a key, certificate or password cannot be used\n";

/// Returns the key of an option in df-config.txt: its name with _ for -; empty if it has no key.
std::string keyOf(const std::string& name) {
  if (name.empty() || name == "--frame-time") return {};  // the game's own key frame_time is in milliseconds
  std::string key = name.substr(2);
  std::replace(key.begin(), key.end(), '-', '_');
  return key;
}

bool isHash(const std::string& password) {
  return password.starts_with("$argon2");
}

void warnOfReadersOf(const std::string& file, const std::string& password, HostOptions& options) {
  struct stat facts {};
  if (password.empty() || isHash(password) || stat(file.c_str(), &facts) != 0 ||
      (facts.st_mode & S_IROTH) == 0)
    return;
  options.warnings.push_back(file + " has the password, but every user can read it. Run: chmod o-r " + file);
}

/// Returns FILE of "FILE:LINE".
std::string fileAt(const std::string& place) {
  return place.substr(0, place.rfind(':'));
}

Program dfserver() {
  return {"dfserver", "Hosts a Dragonfly game for terminals to join.",
          std::string("Every option can also be set in the environment. A DURATION may have a unit: us, ms, "
                      "s, m, h, d or\n"
                      "w; without one it is in the unit that the option names.\n\n") +
              kExitCodes,
          true};
}

std::string listOf(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += i + 1 == names.size() ? " and " : ", ";
    text += names[i];
  }
  return text;
}

/// Output that was requested instead of a run.
struct Printing {
  bool games = false;
  bool check = false;
  bool config = false;
  bool markdown = false;
};

/// The "FILE:LINE" of passwords in a --config file (Option::p_location); empty: given elsewhere.
struct Places {
  std::string password;
  std::string admin_password;
};

/// Returns the options of dfserver's command line.
std::vector<Option> commandLineOf(HostOptions& options, Printing& printing, Places& places) {
  std::vector<Row> rows = tableOf(options);
  warnOfUnknownVariables(rows, options);
  std::vector<Option> all;
  for (Row& row : rows) {
    if (row.used_by == UsedBy::kProgram) continue;
    Option& option = all.emplace_back(std::move(row.option));
    option.shows_default = true;
    if (option.type.empty()) option.type = typeOf(option.name);
    if (option.name == "--password") option.p_location = &places.password;
    if (option.name == "--admin-password") option.p_location = &places.admin_password;
    option.is_secret = option.p_location != nullptr;
  }
  all.push_back({"--list-games", &printing.games, "Print the names of the available games, and exit"});
  all.push_back(
      {"--check-config", &printing.check,
       "Check options, environment and --config file, and that what they name exists and can be used; print "
       "problems, and exit (0 or 2)"});
  all.push_back(
      {"--print-config", &printing.config, "Print the resulting settings as a --config file, and exit"});
  all.push_back({"--markdown", &printing.markdown, "Print the options as a Markdown table, and exit"});
  all.back().hidden = true;
  return all;
}

CommandLine printConfig(const Printing& printing, const std::vector<Option>& all,
                        const HostOptions& options) {
  for (const std::string& warning : options.warnings) std::cerr << "dfserver: warning: " << warning << "\n";
  for (const Option& option : all) {
    if (printing.config && isSetting(option)) std::cout << configLine(option) << "\n";
  }
  return printing.check && reportDeploymentProblems(options) ? CommandLine::kUsageError : CommandLine::kDone;
}

}  // namespace

void useSockets(const InheritedSockets& sockets, HostOptions& options) {
  const bool is_told = options.port != kDefaultPort && options.port != sockets.port;
  if (is_told) {
    options.warnings.push_back("using port " + std::to_string(sockets.port) +
                               " of the sockets from the service manager instead of " +
                               std::to_string(options.port));
  }
  options.sockets = sockets;
  options.address = sockets.address;
  options.port = sockets.port;
}

void warnIfReadable(const std::string& file, HostOptions& options) {
  warnOfReadersOf(file, options.password, options);
}

HostOptions readHostOptions(int argc, const char* const* argv) {
  HostOptions options;
  std::vector<Option> all;
  for (Row& row : tableOf(options)) {
    if (row.used_by != UsedBy::kProgram) all.push_back(std::move(row.option));
  }
  readOptions(dfserver(), all, argc, argv);
  if (const std::string wrong = validateHostOptions(options); !wrong.empty()) throw OptionError(wrong);
  defaultToLoopback(options);
  useRooms(options);
  useDefaultFolders(options);
  return options;
}

CommandLine parseHostOptions(int argc, const char* const* argv, HostOptions& options) {
  Printing printing;
  Places places;
  const std::vector<Option> all = commandLineOf(options, printing, places);
  switch (parseOptions(dfserver(), all, argc, argv)) {
    case ParseResult::kRun:
      break;
    case ParseResult::kDone:
      return CommandLine::kDone;
    case ParseResult::kUsageError:
      return CommandLine::kUsageError;
  }
  if (const std::string wrong = validateHostOptions(options); !wrong.empty()) {
    std::cerr << "dfserver: " << wrong << "\nRun dfserver --help for more information.\n";
    return CommandLine::kUsageError;
  }
  defaultToLoopback(options);
  useRooms(options);
  useDefaultFolders(options);
  if (!places.password.empty()) warnIfReadable(fileAt(places.password), options);
  if (!places.admin_password.empty())
    warnOfReadersOf(fileAt(places.admin_password), options.admin_password, options);
  if (printing.config || printing.check) return printConfig(printing, all, options);
  if (printing.markdown) {
    std::cout << hostOptionsMarkdown();
    return CommandLine::kDone;
  }
  return printing.games ? CommandLine::kListGames : CommandLine::kRun;
}

OptionChanges applyReloadable(const HostOptions& next, HostOptions& now) {
  OptionChanges changes;
  HostOptions values = next;  // the table needs targets that are not const
  std::vector<Row> rows = tableOf(now);
  const std::vector<Row> wanted = tableOf(values);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::string& name = rows[i].option.name;
    const std::string value = currentValue(wanted[i].option);
    if (rows[i].used_by == UsedBy::kProgram || value == currentValue(rows[i].option)) continue;
    const bool live = std::find(std::begin(kLive), std::end(kLive), name) != std::end(kLive);
    if (live) copyValue(wanted[i].option, rows[i].option);
    (live ? changes.changed : changes.need_restart).push_back(name.substr(2));
  }
  return changes;
}

std::string OptionChanges::text() const {
  std::string text = changed.empty()
                         ? "no changes"
                         : listOf(changed) + (changed.size() == 1 ? " has" : " have") + " changed";
  if (!need_restart.empty())
    text += "; " + listOf(need_restart) + (need_restart.size() == 1 ? " needs" : " need") + " a restart";
  return text;
}

std::set<std::string> readProgramOptions(const ConfigValue& value_of, HostOptions& options,
                                         const ConfigLocation& location_of) {
  std::set<std::string> given;
  const std::vector<Row> rows = tableOf(options);
  warnOfUnknownVariables(rows, options);
  for (const Row& row : rows) {
    if (row.used_by == UsedBy::kServer) continue;
    std::string value = environmentValue(row.option);
    std::string place = row.option.environment;
    for (const std::string& key : {keyOf(row.option.name), keyOf(formerNameOf(row.option.name))}) {
      if (!value.empty() || key.empty()) continue;
      value = value_of(key);
      place = value.empty() || !location_of ? key : location_of(key);
    }
    if (value.empty()) continue;
    given.insert(row.option.name.substr(2));
    storeValue(row.option, value, place);
  }
  if (given.count("address") == 0 && !options.is_public) options.address = kLoopback;
  if (const std::string wrong = validateHostOptions(options); !wrong.empty()) throw OptionError(wrong);
  defaultToLoopback(options);
  if (options.control == kOffWord) options.control.clear();
  if (options.journal == kOffWord) options.journal.clear();
  return given;
}

void setHostOption(HostOptions& options, const std::string& name, const std::string& value) {
  for (const Row& row : tableOf(options)) {
    if (row.option.name == "--" + name) return storeValue(row.option, value, name);
  }
  throw OptionError("There is no option " + name + ".");
}

std::string hostOptionValue(const HostOptions& options, const std::string& name) {
  HostOptions copy = options;
  for (const Row& row : tableOf(copy)) {
    if (row.option.name == "--" + name) return currentValue(row.option);
  }
  return {};
}

std::string hostOptionsMarkdown() {
  HostOptions defaults;
  const std::vector<Row> rows = tableOf(defaults);
  std::string text =
      "# Options of dfserver\n\nGenerated by `dfserver --markdown`; a test checks that it is up to date. "
      "Numbers of seconds, "
      "milliseconds and\nmicroseconds may have a unit instead: `90s`, `5m`, `1.5h`, `33ms` (us, ms, s, m, h, "
      "d, w).\n\n"
      "| option | environment | default | meaning |\n|---|---|---|---|\n";
  for (const Row& row : rows) {
    if (row.used_by == UsedBy::kProgram) continue;
    text += std::string("| `") + row.option.name + "` | `" + row.option.environment + "` | " +
            currentValue(row.option) + " | " + row.option.help + " |\n";
  }
  text += std::string("\n") + kExitCodes +
          "\n## Games that are programs themselves\n\n"
          "A game with a `main()` of its own ([bring-your-game.md](bring-your-game.md)) has no Naiad command "
          "line. It takes these\noptions from the environment, or else from its `df-config.txt`, as lines "
          "`key:value,`:\n\n"
          "| df-config.txt | environment | default | meaning |\n|---|---|---|---|\n";
  defaults.address = kLoopback;
  for (const Row& row : rows) {
    if (row.used_by == UsedBy::kServer) continue;
    const std::string key = keyOf(row.option.name);
    text +=
        "| " + (key.empty() ? "" : "`" + key + "`") + " | `" + row.option.environment + "` | " +
        currentValue(row.option) + " | " +
        (row.used_by == UsedBy::kProgram ? row.option.help : std::string("as `") + row.option.name + "`") +
        " |\n";
  }
  return text +
         "\nUnless `address` or `public` says otherwise, it listens on loopback only.\n"
         "It exits as its `main()` does, or with 2 for an invalid option, and 4 and 5 like dfserver.\n";
}

}  // namespace naiad

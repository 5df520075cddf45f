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
#include "host/settings/RoomList.h"
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
  std::string variable = "NAIAD_" + name.substr(2);
  for (char& c : variable) c = c == '-' ? '_' : static_cast<char>(std::toupper(c));
  Option option{name, std::move(target), help, variable};
  if (const auto* p_range = std::get_if<OptionRange>(&values)) option.range = *p_range;
  if (const auto* p_words = std::get_if<OneOf>(&values)) option.one_of = *p_words;
  option.joins = name == "--room";
  return {std::move(option), used_by};
}

/// Returns the table of options, with its targets in `o`.
std::vector<Row> tableOf(HostOptions& o) {
  return {
      row("--game", &o.game,
          "Game to host: the name of a shipped one (see --list-games) or the path of a module (.so)", {},
          UsedBy::kServer),
      row("--room", &o.rooms,
          "NAME=GAME[,KEY=VALUE…]: a room in which this game is played, beside others; give it once for each "
          "room (in the environment: with blanks between). Players begin in the first one, or join by "
          "HOST/NAME. The keys are max-players, world-memory, seed and players, as the options",
          {}, UsedBy::kServer),
      row("--room-sleep", &o.room_sleep,
          "Seconds without players after which a room ends its round and its process; the next player wakes "
          "it",
          OptionRange{0, 1e6}, UsedBy::kServer),
      row("--address", &o.address,
          "Numeric address to listen on; :: is every address of this machine, IPv4 too"),
      row("--port", &o.port, "Port to listen on, TCP and UDP; 0 takes any free one", OptionRange{0, 65535}),
      row("--max-players", &o.max_players, "Players at a time", OptionRange{1, kMaxServerPlayers}),
      row("--max-per-address", &o.max_per_address,
          "Players at a time from one IPv4 address or IPv6 network (/64), with those whose connection broke",
          OptionRange{1, static_cast<double>(kMaxServerPlayers)}),
      row("--server-name", &o.name, "Name shown to players"),
      row("--seed", &o.seed, "Seed of the world's random numbers; 0 takes a new one and logs it",
          OptionRange{0, 9e15}),
      row("--frame-time", &o.frame_micros,
          "Length of a tick in microseconds, 1000 or more; 0 is what the game's df-config.txt says, else "
          "exactly 1/30 s",
          OptionRange{0, 1e6}),
      row("--ticks", &o.ticks, "Stop after this many ticks; 0 never", OptionRange{0, 2e9}),
      row("--exit-when-empty", &o.exit_when_empty,
          "Stop this many seconds after the last player left (a minute if no player ever joins); 0 never",
          OptionRange{0, 1e6}),
      row("--players", &o.players,
          "Whose keys and mouse the game hears: together = all players'; first = the first one's, while the "
          "others watch and wait for their turn; private = a world for each player, in a process of its own",
          OneOf{"together", "first", "private"}),
      row("--on-game-over", &o.on_game_over,
          "When the game is over because of a key or click of one player among several: leave = it is for "
          "them alone; exit = for all. restart = as leave, and when the game itself is over or crashes, the "
          "next round begins, in a process of its own; players stay connected",
          OneOf{"leave", "exit", "restart"}),
      row("--sandbox", &o.sandbox,
          "Games in processes of their own cannot connect, reach this user's other processes, or open files "
          "that are not the game's, as far as the kernel has Landlock and seccomp; off: they can do what "
          "this user can",
          OneOf{"on", "off"}),
      row("--world-memory", &o.world_memory,
          "MiB of addresses that a game in a process of its own may have; 0: no limit",
          OptionRange{0, 1 << 20}),
      row("--hang-time", &o.hang_time,
          "Seconds of one tick after which a game in a process of its own hangs: the log says what it does, "
          "and after five times that it is ended. Neither a machine under load nor a debugger makes it hang",
          OptionRange{0.1, 600}),
      row("--world-environment", &o.world_environment,
          "Names of variables, with commas between, that games in processes of their own find in their "
          "environment, beside the usual ones"),
      row("--in-process", &o.in_process,
          "The game runs in the server's own process, for a debugger, or where its pictures are too large "
          "for another one: without sandbox and journal, and a crash ends the server",
          {}, UsedBy::kServer),
      row("--journal", &o.journal,
          "Write each round down in a file of this directory, as it is played: dfreplay executes it again, "
          "and a server that was killed goes on with it. The game has clocks and random devices then that "
          "can be repeated. off: none. Default: rounds in the folder of --state; none with --players "
          "private, --in-process, and for games that are programs themselves"),
      row("--recover", &o.recover,
          "When this server was killed in a round that --journal has: on = the round is executed again, and "
          "its players go on with it; off = another one begins",
          OneOf{"on", "off"}),
      row("--insecure", &o.insecure, "Without encryption or datagrams, on loopback only (for tests)"),
      row("--certificate", &o.certificate,
          "Certificate chain (PEM), with --key; default: self-signed, made on the first start"),
      row("--key", &o.key, "Private key (PEM) of --certificate, readable by you alone"),
      row("--identity", &o.identity,
          "Directory of the self-made key; default: naiad in your configuration directory"),
      row("--password", &o.password,
          "Password that players need, or its $argon2id$ hash (other users see the command line: rather set "
          "it in the environment or in --config)"),
      row("--grace", &o.grace, "Seconds that a player whose connection broke may take to come back; 0: none",
          OptionRange{0, 3600}),
      row("--drain-time", &o.drain_time,
          "Seconds that SIGTERM gives players to finish: no new ones are let in, and the server ends when "
          "all have left, or then; 0: it ends at once",
          OptionRange{0, 86400}),
      row("--join-file", &o.join_file,
          "Write address and fingerprint, as dfclient takes them, to this file once listening"),
      row("--visitors", &o.visitors,
          "Path of a socket at which doors of this machine (ssh, browsers) bring visitors with their "
          "addresses; who may write to the file, mode 0660, is believed"),
      row("--link-host", &o.link_host,
          "Name or address by which players elsewhere reach this machine, for the link that is printed; "
          "HOST:PORT where a router forwards another port"),
      row("--ssh-door", &o.ssh_door,
          "Also print how to play by ssh: USER@HOST[:PORT] of a door to this server"),
      row("--web-address", &o.web_address, "Also print this address of a page to play on (https://…)"),
      row("--qr", &o.qr, "Print --web-address as a QR code, too"),
      row("--lan", &o.lan,
          "Let dfclient without arguments find this server in the local network: auto = where the address is "
          "private, on = wherever it listens, off = not",
          OneOf{"auto", "on", "off"}),
      row("--truth", &o.truth_file,
          "Write what each player ought to see, tick by tick, to this file (for tests; large)"),
      row("--metrics", &o.metrics,
          "Give out metrics for Prometheus (/metrics) and health (/healthz, /readyz) by HTTP on this numeric "
          "ADDR:PORT, like 127.0.0.1:9100; port 0 takes any free one"),
      row("--metrics-hosts", &o.metrics_hosts,
          "Names of this machine, with commas between, by which --metrics may be asked, beside localhost and "
          "addresses"),
      row("--metrics-public", &o.metrics_public,
          "--metrics may be an address that the internet can reach; everybody can read them then"),
      row("--audit", &o.audit,
          "With --metrics: hold what one player was sent against what the world shows them, one second in "
          "ten, and count wrong cells",
          OneOf{"on", "off"}),
      row("--port-file", &o.port_file, "Write the port number to this file once listening"),
      row("--status-file", &o.status_file,
          "Write name, game, number of players and link (see --link-host) to this file as JSON, every 5 "
          "seconds; for lists of servers on the web. It is removed when the server stops"),
      row("--log", &o.log_file, "Append log lines to this file instead of stderr"),
      row("--log-format", &o.log_format,
          "How log lines look: text = sentences; json = an object a line, with the facts in it by name",
          OneOf{"text", "json"}, UsedBy::kServer),
      row("--log-level", &o.log_level, "Log what is as bad as this, or worse",
          OneOf{"error", "warning", "info"}, UsedBy::kServer),
      row("--log-chat", &o.log_chat, "Log what players say, too"),
      row("--control", &o.control,
          "Path of the socket for dfctl's commands, mode 0660: who may write to it is an admin; off: none. "
          "Default: control-PORT.sock in naiad in the user's runtime directory ($XDG_RUNTIME_DIR), else in "
          "~/.local/state/naiad; none for games that are programs themselves"),
      row("--state", &o.state,
          "Folder of what lasts beyond a restart: bans, scores, rounds that are written down. Default: naiad "
          "in the user's directory for state ($XDG_STATE_HOME, ~/.local/state); none for games that are "
          "programs themselves"),
      row("--admin-password", &o.admin_password,
          "Password that makes a player an admin in the chat (/admin PASSWORD), or its $argon2id$ hash; as "
          "with --password, rather in the environment or in --config"),
      row("--vote-kick", &o.vote_kick,
          "Players may vote others out for five minutes (/vote kick NAME): more than half of the addresses "
          "that play have to agree within 30 seconds"),
      row("--inactive-kick", &o.inactive_kick,
          "Seconds without key, click or line of chat after which a player has to go, warned 10 seconds "
          "before; 0 never",
          OptionRange{0, 86400}),
      row("--platform", &o.platform,
          "What runs the server, and is sent that it is ready, healthy, played on and at its end: systemd; "
          "agones = the sidecar at 127.0.0.1, port $AGONES_SDK_HTTP_PORT (9358); none; auto = the one that "
          "has set its variable",
          OneOf{"auto", "none", "systemd", "agones"}),
      row("--bus", &o.bus,
          "Say on this NATS server what plays here, and the scores: nats://HOST:PORT or tls://HOST:PORT "
          "(other users see the command line: a password rather in --bus-credentials)"),
      row("--bus-id", &o.bus_id,
          "Name of this server on the bus, of a-z, 0-9 and '-'; default: of the machine and the port"),
      row("--bus-interval", &o.bus_interval_ms,
          "Milliseconds after which the server says again that it is there, as its directory's",
          OptionRange{50, 60'000}),  // BusPayloads.h
      row("--bus-credentials", &o.bus_credentials, "File of credentials for the bus, as nsc writes it"),
      row("--bus-ca", &o.bus_ca,
          "Certificates (PEM) by which that of a tls:// bus is judged; default: the system's"),
      row("--headless", &o.headless, "Without network and players, as fast as possible", {},
          UsedBy::kProgram),
      row("--local-client", &o.local_client, "Started in a terminal: play there, too", {}, UsedBy::kProgram),
      row("--public", &o.is_public,
          "Let players of other machines in: listen on every address, not on loopback alone", {},
          UsedBy::kProgram),
  };
}

/// Options that a reload changes while the server runs.
constexpr std::string_view kLive[] = {
    "--max-players", "--max-per-address", "--server-name", "--exit-when-empty", "--password",  "--grace",
    "--drain-time",  "--certificate",     "--key",         "--log-format",      "--log-level", "--log-chat",
    "--vote-kick",   "--inactive-kick"};

/// Variables that are not in the table but are read by this or other programs of the project.
const char* const kOtherVariables[] = {
    "NAIAD_ASCII",         "NAIAD_CLIENT",  "NAIAD_FINGERPRINT", "NAIAD_GAMES",       "NAIAD_IDLE_LIMIT",
    "NAIAD_KNOWN_SERVERS", "NAIAD_NAME",    "NAIAD_NO_MOUSE",    "NAIAD_NO_REDIRECT", "NAIAD_NO_RESUME",
    "NAIAD_SERVER",        "NAIAD_SOCKETS", "NAIAD_SOUND",       "NAIAD_WORLD_SEED",  "NAIAD_WORLD_SOCKET"};

/// Returns the type of an option's value in --help and completions, if it is a file, directory or socket.
const char* typeOf(const std::string& name) {
  for (const char* p_file : {"--certificate", "--key", "--join-file", "--truth", "--port-file", "--log",
                             "--bus-credentials", "--bus-ca"})
    if (name == p_file) return "FILE";
  if (name == "--identity" || name == "--journal") return "DIR";
  return name == "--visitors" ? "SOCKET" : "";
}

void warnOfUnknownVariables(const std::vector<Row>& rows, HostOptions& options) {
  std::vector<std::string> known(std::begin(kOtherVariables), std::end(kOtherVariables));
  for (const Row& row : rows) known.push_back(row.option.environment);
  for (const std::string& sentence : complainOfUnknownVariables(environ, "NAIAD_", known))
    options.warnings.push_back(sentence);
}

constexpr const char* kLoopback = "127.0.0.1";

const char* const kExitCodes =
    "Exit codes:\n"
    "  0  ended in order (game over, --ticks, --exit-when-empty, SIGINT or SIGTERM, SIGHUP in a terminal;\n"
    "     a second one ends it at once, with a goodbye, by that signal)\n"
    "  1  the game's main() returned an error or threw an exception, or the game hung when the server was\n"
    "     to end\n"
    "  2  wrong usage\n"
    "  3  no such game, or its module cannot be loaded\n"
    "  4  cannot listen on that address and port\n"
    "  5  a file cannot be written, or a key, certificate or password not be used\n";

/// Returns the option's key in df-config.txt: its name with _ for -; empty if it has no key.
std::string keyOf(const Row& row) {
  if (row.option.name == "--frame-time") return {};  // the game's own key frame_time is in milliseconds
  std::string key = row.option.name.substr(2);
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
  options.warnings.push_back(file + " has the password, and every user can read it. Run: chmod o-r " + file);
}

/// Returns FILE of "FILE:LINE".
std::string fileAt(const std::string& place) {
  return place.substr(0, place.rfind(':'));
}

Program dfserver() {
  return {"dfserver", "Hosts a Dragonfly game for terminals to join.",
          std::string("Every option can also be set in the environment.\n\n") + kExitCodes, true};
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

/// The "FILE:LINE" of passwords from a --config file (Option::p_place); empty: given elsewhere.
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
    if (option.name == "--password") option.p_place = &places.password;
    if (option.name == "--admin-password") option.p_place = &places.admin_password;
    option.is_secret = option.p_place != nullptr;
  }
  all.push_back({"--list-games", &printing.games, "Print the games that can be named, and exit"});
  all.push_back({"--check-config", &printing.check,
                 "Say what is wrong with options, environment and the file of --config, and exit (0 or 2)"});
  all.push_back({"--print-config", &printing.config, "Print what they amount to, as such a file, and exit"});
  all.push_back({"--markdown", &printing.markdown, "Print the options as a Markdown table, and exit"});
  all.back().hidden = true;
  return all;
}

CommandLine printConfig(const Printing& printing, const std::vector<Option>& all,
                        const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) std::cerr << "dfserver: warning: " << warning << "\n";
  for (const Option& option : all) {
    if (printing.config && isSetting(option)) std::cout << configLine(option) << "\n";
  }
  return CommandLine::kDone;
}

}  // namespace

void useSockets(const InheritedSockets& sockets, HostOptions& options) {
  const bool is_told = options.port != kDefaultPort && options.port != sockets.port;
  if (is_told) {
    options.warnings.push_back("the port is " + std::to_string(sockets.port) +
                               ", of the sockets from the service manager, and not " +
                               std::to_string(options.port));
  }
  options.sockets = sockets;
  options.address = sockets.address;
  options.port = sockets.port;
}

void warnOfReaders(const std::string& file, HostOptions& options) {
  warnOfReadersOf(file, options.password, options);
}

HostOptions readHostOptions(int argc, const char* const* argv) {
  HostOptions options;
  std::vector<Option> all;
  for (Row& row : tableOf(options)) {
    if (row.used_by != UsedBy::kProgram) all.push_back(std::move(row.option));
  }
  readOptions(dfserver(), all, argc, argv);
  if (const std::string wrong = optionsComplaint(options); !wrong.empty()) throw OptionError(wrong);
  keepHome(options);
  useRooms(options);
  useDefaultFolders(options);
  return options;
}

CommandLine parseHostOptions(int argc, const char* const* argv, HostOptions& options) {
  Printing printing;
  Places places;
  const std::vector<Option> all = commandLineOf(options, printing, places);
  switch (parseOptions(dfserver(), all, argc, argv)) {
    case Parsed::kRun:
      break;
    case Parsed::kDone:
      return CommandLine::kDone;
    case Parsed::kUsageError:
      return CommandLine::kUsageError;
  }
  if (const std::string wrong = optionsComplaint(options); !wrong.empty()) {
    std::cerr << "dfserver: " << wrong << "\nRun dfserver --help for more information.\n";
    return CommandLine::kUsageError;
  }
  keepHome(options);
  useRooms(options);
  useDefaultFolders(options);
  if (!places.password.empty()) warnOfReaders(fileAt(places.password), options);
  if (!places.admin_password.empty())
    warnOfReadersOf(fileAt(places.admin_password), options.admin_password, options);
  if (printing.config || printing.check) return printConfig(printing, all, options.warnings);
  if (printing.markdown) {
    std::cout << hostOptionsMarkdown();
    return CommandLine::kDone;
  }
  return printing.games ? CommandLine::kListGames : CommandLine::kRun;
}

OptionChanges takeOver(const HostOptions& next, HostOptions& now) {
  OptionChanges changes;
  HostOptions values = next;  // the table needs mutable targets
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
                         ? "none has changed"
                         : listOf(changed) + (changed.size() == 1 ? " has" : " have") + " changed";
  if (!need_restart.empty())
    text += "; " + listOf(need_restart) + (need_restart.size() == 1 ? " needs" : " need") + " a restart";
  return text;
}

std::set<std::string> readProgramOptions(const ConfigValue& value_of, HostOptions& options,
                                         const ConfigPlace& place_of) {
  std::set<std::string> given;
  const std::vector<Row> rows = tableOf(options);
  warnOfUnknownVariables(rows, options);
  for (const Row& row : rows) {
    if (row.used_by == UsedBy::kServer) continue;
    const std::string key = keyOf(row);
    const char* p_environment = std::getenv(row.option.environment.c_str());
    std::string value = p_environment != nullptr ? p_environment : "";
    std::string place = row.option.environment;
    if (value.empty() && !key.empty()) {
      value = value_of(key);
      place = value.empty() || !place_of ? key : place_of(key);
    }
    if (value.empty()) continue;
    given.insert(row.option.name.substr(2));
    storeValue(row.option, value, place);
  }
  if (given.count("address") == 0 && !options.is_public) options.address = kLoopback;
  if (const std::string wrong = optionsComplaint(options); !wrong.empty()) throw OptionError(wrong);
  keepHome(options);
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
      "# Options of dfserver\n\nMade by `dfserver --markdown`; a test keeps it true.\n\n"
      "| option | environment | default | meaning |\n|---|---|---|---|\n";
  for (const Row& row : rows) {
    if (row.used_by == UsedBy::kProgram) continue;
    text += std::string("| `") + row.option.name + "` | `" + row.option.environment + "` | " +
            currentValue(row.option) + " | " + row.option.help + " |\n";
  }
  text +=
      std::string("\n") + kExitCodes +
      "\n## Games that are programs themselves\n\n"
      "A game with a `main()` of its own ([bring-your-game.md](bring-your-game.md)) has no command line of "
      "Naiad's. It takes the same\noptions from the environment, and where that does not say from its "
      "`df-config.txt`, as lines `key:value,`:\n\n"
      "| df-config.txt | environment | default | meaning |\n|---|---|---|---|\n";
  defaults.address = kLoopback;
  for (const Row& row : rows) {
    if (row.used_by == UsedBy::kServer) continue;
    const std::string key = keyOf(row);
    text +=
        "| " + (key.empty() ? "" : "`" + key + "`") + " | `" + row.option.environment + "` | " +
        currentValue(row.option) + " | " +
        (row.used_by == UsedBy::kProgram ? row.option.help : std::string("as `") + row.option.name + "`") +
        " |\n";
  }
  return text +
         "\nUnless `address` or `public` says otherwise, it listens on loopback alone.\n"
         "It exits as its `main()` does, or with 2 for an option that makes no sense, 4 and 5 as above.\n";
}

}  // namespace naiad

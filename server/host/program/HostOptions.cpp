#include "host/program/HostOptions.h"

#include <sys/stat.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <vector>

#include "host/program/Announcement.h"
#include "shared/net/base/UserDirectory.h"
#include "shared/net/stream/JoinLink.h"
#include "shared/options/Options.h"

namespace naiad {

namespace {

/// The programs that have an option: dfserver, games that are programs themselves (no command line, but
/// df-config.txt), or both.
enum class UsedBy { kBoth, kServer, kProgram };

struct Row {
  Option option;
  UsedBy used_by = UsedBy::kBoth;
  const char* key = nullptr;  ///< in df-config.txt; null: the name with _ for -; empty: not there
};

/// The table, with its targets in `o`.
std::vector<Row> tableOf(HostOptions& o) {
  return {
      {{"--game", &o.game,
        "Game to host: the name of a shipped one (see --list-games) or the path of a module (.so)",
        "NAIAD_GAME"},
       UsedBy::kServer},
      {{"--address", &o.address,
        "Numeric address to listen on; :: is every address of this machine, IPv4 too", "NAIAD_ADDRESS"}},
      {{"--port", &o.port, "Port to listen on, TCP and UDP; 0 takes any free one", "NAIAD_PORT",
        OptionRange{0, 65535}}},
      {{"--max-players", &o.max_players, "Players at a time", "NAIAD_MAX_PLAYERS",
        OptionRange{1, kMaxServerPlayers}}},
      {{"--max-per-address", &o.max_per_address,
        "Players at a time from one IPv4 address or IPv6 network (/64), with those whose connection broke",
        "NAIAD_MAX_PER_ADDRESS", OptionRange{1, static_cast<double>(kMaxServerPlayers)}}},
      {{"--server-name", &o.name, "Name shown to players", "NAIAD_SERVER_NAME"}},
      {{"--seed", &o.seed, "Seed of the world's random numbers; 0 takes a new one and logs it", "NAIAD_SEED",
        OptionRange{0, 9e15}}},
      {{"--frame-time", &o.frame_micros,
        "Length of a tick in microseconds, 1000 or more; 0 is what the game's df-config.txt says, else "
        "exactly 1/30 s",
        "NAIAD_FRAME_TIME", OptionRange{0, 1e6}},
       UsedBy::kBoth,
       ""},  // there the game's frame_time is in milliseconds
      {{"--ticks", &o.ticks, "Stop after this many ticks; 0 never", "NAIAD_TICKS", OptionRange{0, 2e9}}},
      {{"--exit-when-empty", &o.exit_when_empty,
        "Stop this many seconds after the last player left (a minute if no player ever joins); 0 never",
        "NAIAD_EXIT_WHEN_EMPTY", OptionRange{0, 1e6}}},
      {{"--players",
        &o.players,
        "Whose keys and mouse the game hears: together = all players'; first = the first one's, while the "
        "others watch and wait for their turn; private = a world for each player, in a process of its own",
        "NAIAD_PLAYERS",
        {},
        {"together", "first", "private"}}},
      {{"--on-game-over",
        &o.on_game_over,
        "When the game is over because of a key or click of one player among several: leave = it is for them "
        "alone; exit = for all. restart = as leave, and when the game itself is over or crashes, the "
        "next round begins, in a process of its own; players stay connected",
        "NAIAD_ON_GAME_OVER",
        {},
        {"leave", "exit", "restart"}}},
      {{"--sandbox",
        &o.sandbox,
        "Games in processes of their own cannot connect, reach this user's other processes, or open files "
        "that are not the game's, as far as the kernel has Landlock and seccomp; off: they can do what this "
        "user can",
        "NAIAD_SANDBOX",
        {},
        {"on", "off"}}},
      {{"--world-memory", &o.world_memory,
        "MiB of addresses that a game in a process of its own may have; 0: no limit", "NAIAD_WORLD_MEMORY",
        OptionRange{0, 1 << 20}}},
      {{"--world-environment", &o.world_environment,
        "Names of variables, with commas between, that games in processes of their own find in their "
        "environment, beside the usual ones",
        "NAIAD_WORLD_ENVIRONMENT"}},
      {{"--insecure", &o.insecure, "Without encryption or datagrams, on loopback only (for tests)",
        "NAIAD_INSECURE"}},
      {{"--certificate", &o.certificate,
        "Certificate chain (PEM), with --key; default: self-signed, made on the first start",
        "NAIAD_CERTIFICATE"}},
      {{"--key", &o.key, "Private key (PEM) of --certificate, readable by you alone", "NAIAD_KEY"}},
      {{"--identity", &o.identity,
        "Directory of the self-made key; default: naiad in your configuration directory", "NAIAD_IDENTITY"}},
      {{"--password", &o.password,
        "Password that players need, or its $argon2id$ hash (other users see the command line: rather set it "
        "in the environment or in --config)",
        "NAIAD_PASSWORD"}},
      {{"--grace", &o.grace, "Seconds that a player whose connection broke may take to come back; 0: none",
        "NAIAD_GRACE", OptionRange{0, 3600}}},
      {{"--join-file", &o.join_file,
        "Write address and fingerprint, as dfclient takes them, to this file once listening",
        "NAIAD_JOIN_FILE"}},
      {{"--visitors", &o.visitors,
        "Path of a socket at which doors of this machine (ssh, browsers) bring visitors with their "
        "addresses; who may "
        "write to the file, mode 0660, is believed",
        "NAIAD_VISITORS"}},
      {{"--link-host", &o.link_host,
        "Name or address by which players elsewhere reach this machine, for the link that is printed; "
        "HOST:PORT "
        "where a router forwards another port",
        "NAIAD_LINK_HOST"}},
      {{"--ssh-door", &o.ssh_door, "Also print how to play by ssh: USER@HOST[:PORT] of a door to this server",
        "NAIAD_SSH_DOOR"}},
      {{"--web-address", &o.web_address, "Also print this address of a page to play on (https://…)",
        "NAIAD_WEB_ADDRESS"}},
      {{"--qr", &o.qr, "Print --web-address as a QR code, too", "NAIAD_QR"}},
      {{"--truth", &o.truth_file,
        "Write what each player ought to see, tick by tick, to this file (for tests; large)", "NAIAD_TRUTH"}},
      {{"--port-file", &o.port_file, "Write the port number to this file once listening", "NAIAD_PORT_FILE"}},
      {{"--log", &o.log_file, "Append log lines to this file instead of stderr", "NAIAD_LOG"}},
      {{"--control", &o.control,
        "Path of the socket for dfctl's commands, mode 0660: who may write to it is an admin; off: none. "
        "Default: control-PORT.sock in naiad in the user's runtime directory ($XDG_RUNTIME_DIR), else in "
        "~/.local/state/naiad; none for games that are programs themselves",
        "NAIAD_CONTROL"}},
      {{"--state", &o.state,
        "Folder of what lasts beyond a restart: the bans. Default: naiad in the user's directory for state "
        "($XDG_STATE_HOME, ~/.local/state); none for games that are programs themselves",
        "NAIAD_STATE"}},
      {{"--admin-password", &o.admin_password,
        "Password that makes a player an admin in the chat (/admin PASSWORD), or its $argon2id$ hash; as "
        "with "
        "--password, rather in the environment or in --config",
        "NAIAD_ADMIN_PASSWORD"}},
      {{"--vote-kick", &o.vote_kick,
        "Players may vote others out for five minutes (/vote kick NAME): more than half of the addresses "
        "that "
        "play have to agree within 30 seconds",
        "NAIAD_VOTE_KICK"}},
      {{"--inactive-kick", &o.inactive_kick,
        "Seconds without key, click or line of chat after which a player has to go, warned 10 seconds "
        "before; "
        "0 never",
        "NAIAD_INACTIVE_KICK", OptionRange{0, 86400}}},
      {{"--headless", &o.headless, "Without network and players, as fast as possible", "NAIAD_HEADLESS"},
       UsedBy::kProgram},
      {{"--local-client", &o.local_client, "Started in a terminal: play there, too", "NAIAD_LOCAL_CLIENT"},
       UsedBy::kProgram},
      {{"--public", &o.is_public,
        "Let players of other machines in: listen on every address, not on loopback alone", "NAIAD_PUBLIC"},
       UsedBy::kProgram},
  };
}

constexpr const char* kLoopback = "127.0.0.1";
constexpr std::size_t kMaxWebAddress = 300;  // a QR code of more does not fit a terminal
constexpr int kMinFrameMicros = 1000;        // clients believe no shorter one

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

std::string keyOf(const Row& row) {
  if (row.key != nullptr) return row.key;
  std::string key = row.option.name.substr(2);
  std::replace(key.begin(), key.end(), '-', '_');
  return key;
}

bool isWebAddress(const std::string& text) {
  const bool begins = text.starts_with("https://") || text.starts_with("http://");
  return begins && text.size() <= kMaxWebAddress &&
         std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c < 0x7f; });
}

/// The same for what is printed for players.
std::string printedComplaint(const HostOptions& options) {
  if (!options.link_host.empty() && !LinkHost::parse(options.link_host))
    return "--link-host: HOST or HOST:PORT is wanted, IPv6 in brackets";
  if (!options.ssh_door.empty() && !SshDoor::parse(options.ssh_door))
    return "--ssh-door: USER@HOST or USER@HOST:PORT is wanted";
  if (!options.web_address.empty() && !isWebAddress(options.web_address))
    return "--web-address: an address that begins with https:// or http:// is wanted, of 300 characters at "
           "most";
  if (options.qr && options.web_address.empty()) return "--qr shows --web-address, which is not given";
  return {};
}

/// What is wrong with options together; empty if nothing is.
std::string complaint(const HostOptions& options) {
  if (options.frame_micros != 0 && options.frame_micros < kMinFrameMicros) {
    return "--frame-time: " + std::to_string(options.frame_micros) + " is neither 0 nor " +
           std::to_string(kMinFrameMicros) + " or more";
  }
  if (options.certificate.empty() != options.key.empty()) return "--certificate and --key come together";
  if (options.insecure && !options.visitors.empty()) return "--visitors needs encryption, so not --insecure";
  return printedComplaint(options);
}

bool isHash(const std::string& password) {
  return password.starts_with("$argon2");
}

void warnOfReadersOf(const std::string& file, const std::string& password, HostOptions& options) {
  struct stat facts {};
  if (isHash(password) || stat(file.c_str(), &facts) != 0 || (facts.st_mode & S_IROTH) == 0) return;
  options.warnings.push_back(file + " has the password, and every user can read it. Run: chmod o-r " + file);
}

/// Of "FILE:LINE".
std::string fileAt(const std::string& place) {
  return place.substr(0, place.rfind(':'));
}

/// What dfserver does where these options do not say; "off" is none everywhere.
void useDefaultFolders(HostOptions& options) {
  options.control_by_port = options.control.empty();
  if (!options.state.empty()) return;
  if (const auto folder = userDirectory("XDG_STATE_HOME", ".local/state")) options.state = folder->string();
}

void keepHome(HostOptions& options) {
  if (options.insecure && options.address == HostOptions().address) options.address = kLoopback;
}

}  // namespace

void warnOfReaders(const std::string& file, HostOptions& options) {
  warnOfReadersOf(file, options.password, options);
}

CommandLine parseHostOptions(int argc, const char* const* argv, HostOptions& options) {
  bool list_games = false;
  bool markdown = false;
  std::string password_place;
  std::string admin_place;
  std::vector<Option> all;
  for (Row& row : tableOf(options)) {
    row.option.shows_default = true;
    if (row.option.name == "--password") row.option.p_place = &password_place;
    if (row.option.name == "--admin-password") row.option.p_place = &admin_place;
    if (row.used_by != UsedBy::kProgram) all.push_back(std::move(row.option));
  }
  all.push_back({"--list-games", &list_games, "Print the games that can be named, and exit"});
  all.push_back({"--markdown", &markdown, "Print the options as a Markdown table, and exit"});
  all.back().hidden = true;
  const Program program{"dfserver", "Hosts a Dragonfly game for terminals to join.",
                        std::string("Every option can also be set in the environment.\n\n") + kExitCodes,
                        true};
  switch (parseOptions(program, all, argc, argv)) {
    case Parsed::kRun:
      break;
    case Parsed::kDone:
      return CommandLine::kDone;
    case Parsed::kUsageError:
      return CommandLine::kUsageError;
  }
  if (const std::string wrong = complaint(options); !wrong.empty()) {
    std::cerr << "dfserver: " << wrong << "\nRun dfserver --help for more information.\n";
    return CommandLine::kUsageError;
  }
  keepHome(options);
  useDefaultFolders(options);
  if (options.control == "off") options.control.clear();
  if (!password_place.empty()) warnOfReaders(fileAt(password_place), options);
  if (!admin_place.empty()) warnOfReadersOf(fileAt(admin_place), options.admin_password, options);
  if (markdown) {
    std::cout << hostOptionsMarkdown();
    return CommandLine::kDone;
  }
  return list_games ? CommandLine::kListGames : CommandLine::kRun;
}

std::set<std::string> readProgramOptions(const ConfigValue& value_of, HostOptions& options,
                                         const ConfigPlace& place_of) {
  std::set<std::string> given;
  for (const Row& row : tableOf(options)) {
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
  if (const std::string wrong = complaint(options); !wrong.empty()) throw OptionError(wrong);
  keepHome(options);
  if (options.control == "off") options.control.clear();
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

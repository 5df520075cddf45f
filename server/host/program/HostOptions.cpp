#include "host/program/HostOptions.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <variant>
#include <vector>

#include "shared/values/Version.h"

namespace naiad {

namespace {

using Member = std::variant<bool HostOptions::*, std::string HostOptions::*, int HostOptions::*,
                            std::int64_t HostOptions::*, double HostOptions::*>;

/// Who has an option: dfserver, games that are programs themselves (no command line, but df-config.txt),
/// both.
enum class Whose { kBoth, kServer, kProgram };

struct Row {
  const char* flag;
  const char* environment;
  Member member;
  double least;  ///< range of a number
  double most;
  const char* help;
  Whose whose = Whose::kBoth;
  const char* key = nullptr;          ///< in df-config.txt; null: the flag with _ for -; empty: not there
  std::vector<std::string> one_of{};  ///< what a text may be; empty: anything
};

const std::vector<Row>& table() {
  static const std::vector<Row> rows = {
      {"--game", "NAIAD_GAME", &HostOptions::game, 0, 0,
       "Game to host: the name of a shipped one (see --list-games) or the path of a module (.so)",
       Whose::kServer},
      {"--address", "NAIAD_ADDRESS", &HostOptions::address, 0, 0,
       "Numeric address to listen on; :: is every address of this machine, IPv4 too"},
      {"--port", "NAIAD_PORT", &HostOptions::port, 0, 65535,
       "Port to listen on, TCP and UDP; 0 takes any free one"},
      {"--max-players", "NAIAD_MAX_PLAYERS", &HostOptions::max_players, 1, kMaxServerPlayers,
       "Players at a time"},
      {"--max-per-address", "NAIAD_MAX_PER_ADDRESS", &HostOptions::max_per_address, 1,
       static_cast<double>(kMaxServerPlayers),
       "Players at a time from one IPv4 address or IPv6 network (/64)"},
      {"--server-name", "NAIAD_SERVER_NAME", &HostOptions::name, 0, 0, "Name shown to players"},
      {"--seed", "NAIAD_SEED", &HostOptions::seed, 0, 9e15,
       "Seed of the world's random numbers; 0 takes a new one and logs it"},
      {"--frame-time", "NAIAD_FRAME_TIME", &HostOptions::frame_micros, 0, 1e6,
       "Length of a tick in microseconds, 1000 or more; 0 is what the game's df-config.txt says, else "
       "exactly 1/30 s",
       Whose::kBoth, ""},  // there the game's frame_time is in milliseconds
      {"--ticks", "NAIAD_TICKS", &HostOptions::ticks, 0, 2e9, "Stop after this many ticks; 0 never"},
      {"--exit-when-empty", "NAIAD_EXIT_WHEN_EMPTY", &HostOptions::exit_when_empty, 0, 1e6,
       "Stop this many seconds after the last player left (a minute if nobody ever comes); 0 never"},
      {"--players",
       "NAIAD_PLAYERS",
       &HostOptions::players,
       0,
       0,
       "Whose keys and mouse the game hears: together = everybody's; first = the first one's, while the "
       "others "
       "watch and wait for their turn; private = a world for each player, in a process of its own",
       Whose::kBoth,
       nullptr,
       {"together", "first", "private"}},
      {"--on-game-over",
       "NAIAD_ON_GAME_OVER",
       &HostOptions::on_game_over,
       0,
       0,
       "When the game is over because of a key or click of one player among several: leave = it is for him "
       "alone; exit = for everybody. restart = as leave, and when the game itself is over or crashes, the "
       "next round "
       "begins, in a process of its own; players stay connected",
       Whose::kBoth,
       nullptr,
       {"leave", "exit", "restart"}},
      {"--insecure", "NAIAD_INSECURE", &HostOptions::insecure, 0, 0,
       "Without encryption or datagrams, on loopback only (for tests)"},
      {"--certificate", "NAIAD_CERTIFICATE", &HostOptions::certificate, 0, 0,
       "Certificate chain (PEM), with --key; default: self-signed, made on the first start"},
      {"--key", "NAIAD_KEY", &HostOptions::key, 0, 0,
       "Private key (PEM) of --certificate, readable by you alone"},
      {"--identity", "NAIAD_IDENTITY", &HostOptions::identity, 0, 0,
       "Directory of the self-made key; default: naiad in your configuration directory"},
      {"--password", "NAIAD_PASSWORD", &HostOptions::password, 0, 0,
       "Password that players need, or its $argon2id$ hash (other users see the command line: rather set it "
       "in the "
       "environment or in --config)"},
      {"--grace", "NAIAD_GRACE", &HostOptions::grace, 0, 3600,
       "Seconds that a player whose connection broke may take to come back; 0: none"},
      {"--join-file", "NAIAD_JOIN_FILE", &HostOptions::join_file, 0, 0,
       "Write address and fingerprint, as dfclient takes them, to this file once listening"},
      {"--truth", "NAIAD_TRUTH", &HostOptions::truth_file, 0, 0,
       "Write what each player ought to see, tick by tick, to this file (for tests; large)"},
      {"--port-file", "NAIAD_PORT_FILE", &HostOptions::port_file, 0, 0,
       "Write the port number to this file once listening"},
      {"--log", "NAIAD_LOG", &HostOptions::log_file, 0, 0, "Append log lines to this file instead of stderr"},
      {"--headless", "NAIAD_HEADLESS", &HostOptions::headless, 0, 0,
       "Without network and players, as fast as possible", Whose::kProgram},
      {"--local-client", "NAIAD_LOCAL_CLIENT", &HostOptions::local_client, 0, 0,
       "Started in a terminal: play there, too", Whose::kProgram},
  };
  return rows;
}

constexpr int kMinFrameMicros = 1000;  // clients believe no shorter one

const char* const kExitCodes =
    "Exit codes:\n"
    "  0  ended in order (game over, --ticks, --exit-when-empty, SIGINT or SIGTERM;\n"
    "     a second signal of the kind ends it at once)\n"
    "  1  the game's main() returned an error or threw an exception\n"
    "  2  wrong usage\n"
    "  3  no such game, or its module cannot be loaded\n"
    "  4  cannot listen on that address and port\n"
    "  5  a file cannot be written, or a key, certificate or password not be used\n";

std::string defaultText(const Row& row) {
  const HostOptions defaults;
  return std::visit(
      [&](auto member) {
        std::ostringstream text;
        text << std::boolalpha << defaults.*member;
        return text.str();
      },
      row.member);
}

std::string keyOf(const Row& row) {
  if (row.key != nullptr) return row.key;
  std::string key = row.flag + 2;
  std::replace(key.begin(), key.end(), '-', '_');
  return key;
}

/// One row as an option of the parser's, which checks what is given.
CLI::Option* addRow(CLI::App& app, const Row& row, HostOptions& options) {
  return std::visit(
      [&](auto member) {
        CLI::Option* option = nullptr;
        if constexpr (std::is_same_v<decltype(member), bool HostOptions::*>) {
          option = app.add_flag(row.flag, options.*member, row.help);
        } else {
          option = app.add_option(row.flag, options.*member, row.help)->capture_default_str();
        }
        if (row.most > row.least) option->check(CLI::Range(row.least, row.most));
        if (!row.one_of.empty()) option->check(CLI::IsMember(row.one_of));
        return option;
      },
      row.member);
}

/// What rows cannot check one by one; empty if all is well.
std::string complaint(const HostOptions& options) {
  if (options.frame_micros != 0 && options.frame_micros < kMinFrameMicros) {
    return "--frame-time: " + std::to_string(options.frame_micros) + " is neither 0 nor " +
           std::to_string(kMinFrameMicros) + " or more";
  }
  if (options.certificate.empty() != options.key.empty()) return "--certificate and --key come together";
  return {};
}

void keepHome(HostOptions& options) {
  if (options.insecure && options.address == HostOptions().address) options.address = "127.0.0.1";
}

}  // namespace

CommandLine parseHostOptions(int argc, const char* const* argv, HostOptions& options) {
  CLI::App app("Hosts a Dragonfly game for terminals to join.", "dfserver");
  app.set_version_flag("--version", std::string("dfserver ") + kVersion);
  app.set_config("--config", "", "Read options from this file (lines like: port = 9876)");
  app.allow_config_extras(CLI::config_extras_mode::error);  // a misspelt option must not be passed over
  app.footer(std::string("Every option can also be set in the environment.\n\n") + kExitCodes);
  bool list_games = false;
  bool markdown = false;
  for (const Row& row : table()) {
    if (row.whose != Whose::kProgram) addRow(app, row, options)->envname(row.environment);
  }
  app.add_flag("--list-games", list_games, "Print the games that can be named, and exit");
  app.add_flag("--markdown", markdown, "Print the options as a Markdown table, and exit")->group("");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? CommandLine::kDone : CommandLine::kUsageError;
  }
  if (const std::string wrong = complaint(options); !wrong.empty()) {
    std::cerr << wrong << "\nRun with --help for more information.\n";
    return CommandLine::kUsageError;
  }
  keepHome(options);
  if (markdown) {
    std::cout << hostOptionsMarkdown();
    return CommandLine::kDone;
  }
  return list_games ? CommandLine::kListGames : CommandLine::kRun;
}

std::set<std::string> readProgramOptions(const ConfigValue& value_of, HostOptions& options) {
  std::set<std::string> given;
  std::vector<std::string> arguments;
  for (const Row& row : table()) {
    if (row.whose == Whose::kServer) continue;
    const std::string key = keyOf(row);
    const char* p_environment = std::getenv(row.environment);
    std::string value = p_environment != nullptr ? p_environment : "";
    if (value.empty() && !key.empty()) value = value_of(key);
    if (value.empty()) continue;
    given.insert(row.flag + 2);
    arguments.push_back(std::string(row.flag) + "=" + value);
  }
  CLI::App app;
  for (const Row& row : table()) {
    if (row.whose != Whose::kServer) addRow(app, row, options);
  }
  try {
    std::reverse(arguments.begin(), arguments.end());  // as the parser wants them
    app.parse(arguments);
  } catch (const CLI::ParseError& error) {
    throw OptionError(error.what());
  }
  if (const std::string wrong = complaint(options); !wrong.empty()) throw OptionError(wrong);
  keepHome(options);
  return given;
}

std::string hostOptionsMarkdown() {
  std::string text =
      "# Options of dfserver\n\nMade by `dfserver --markdown`; a test keeps it true.\n\n"
      "| option | environment | default | meaning |\n|---|---|---|---|\n";
  for (const Row& row : table()) {
    if (row.whose == Whose::kProgram) continue;
    text += std::string("| `") + row.flag + "` | `" + row.environment + "` | " + defaultText(row) + " | " +
            row.help + " |\n";
  }
  text +=
      std::string("\n") + kExitCodes +
      "\n## Games that are programs themselves\n\n"
      "A game with a `main()` of its own ([bring-your-game.md](bring-your-game.md)) has no command line of "
      "Naiad's. It takes the same\noptions from the environment, and where that does not say from its "
      "`df-config.txt`, as lines `key:value,`:\n\n"
      "| df-config.txt | environment | default | meaning |\n|---|---|---|---|\n";
  for (const Row& row : table()) {
    if (row.whose == Whose::kServer) continue;
    const std::string key = keyOf(row);
    text += "| " + (key.empty() ? "" : "`" + key + "`") + " | `" + row.environment + "` | " +
            defaultText(row) + " | " +
            (row.whose == Whose::kProgram ? row.help : std::string("as `") + row.flag + "`") + " |\n";
  }
  return text +
         "\nIt exits as its `main()` does, or with 2 for an option that makes no sense, 4 and 5 as above.\n";
}

}  // namespace naiad

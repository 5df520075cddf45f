// dfbot: players without a screen, for tests, demonstrations and load.
#include <algorithm>
#include <asio/executor_work_guard.hpp>
#include <asio/io_context.hpp>
#include <chrono>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "client/bot/BotScript.h"
#include "client/bot/TruthRecorder.h"
#include "client/session/Connection.h"
#include "client/session/TrustOptions.h"
#include "shared/options/Options.h"
#include "shared/values/Version.h"

namespace {

using Clock = std::chrono::steady_clock;

/// Length of a turn of the main loop: frames are handled as they arrive, and at its end each bot is updated
/// once. The time for updating all bots after each frame would grow with the square of their number.
constexpr std::chrono::milliseconds kTurn{5};
/// A server sends a snapshot at least every kKeepAliveTicks, later if the connection is bad. If at the end of
/// play no snapshot comes for twice that time and kSnapshotTimeout, the server has crashed or hangs.
constexpr std::chrono::seconds kSnapshotTimeout{5};
constexpr int kKeepAliveTicks = 5;

constexpr const char* kScriptHelp =
    "Scripts (--script FILE or --script TEXT), durations in ticks:\n"
    "  press SPACE; hold LEFTARROW 10; wait 5; click 40 12 [right]; move 3 4; chat hello all\n"
    "  repeat 3 { press UPARROW; wait 2 }    repeat    (at the end: repeats the whole script forever)\n"
    "  Statements end with ';' or a new line; '#' starts a comment. Keys are the names of "
    "df::Keyboard::Key.\n\n";

struct BotOptions {
  naiad::ServerAddress address;
  naiad::ServerTrust trust;
  naiad::SessionOptions session;
  std::string name = "bot";
  std::string game;
  int clients = 1;
  std::optional<double> seconds;
  std::optional<std::uint32_t> ticks;
  std::optional<naiad::BotScript> script;
  std::optional<std::uint64_t> random_seed;
  std::string truth_file;
  bool quiet = false;
  bool rejoin = false;
};

/// One client: its connection, its player (script or random) and the recorder of its pictures.
class Bot {
 public:
  Bot(asio::io_context& context, const BotOptions& options, int index)
      : m_options(options),
        m_index(index),
        m_connection(context, options.address, sessionOptions(options, index), options.rejoin, options.trust),
        m_recorder(naiad::TruthRecorder::kMaxCells / static_cast<std::size_t>(options.clients)) {
    m_connection.onSession([this](naiad::ClientSession& session) {
      session.onBeforeSnapshot([this, &session](std::uint32_t tick) {
        if (!m_options.truth_file.empty()) m_recorder.beforeSnapshot(session.replica(), tick);
        if (!m_first_tick) m_first_tick = tick;
        m_heard_at = Clock::now();
      });
      session.onAfterSnapshot(
          [this, &session](const naiad::SnapshotHeader& header, const naiad::AckWindow& acks) {
            const auto before = session.welcome().resume_state.value_or(naiad::ResumeState());
            m_recorder.afterSnapshot(header, acks, !session.hasDatagrams(Clock::now()), before.snapshot);
          });
    });
    m_connection.start();
  }

  void update(Clock::time_point now) {
    m_connection.update(now);
    naiad::ClientSession* session = m_connection.session();
    if (session == nullptr || m_connection.isOver()) return;
    if (m_script == nullptr && m_random == nullptr) startPlaying(*session, now);
    while (now >= m_next_tick) {
      m_next_tick += session->welcome().tick;
      if (now - m_next_tick > std::chrono::milliseconds(250)) m_next_tick = now;  // skip missed ticks
      play(*session, now);
    }
  }

  /// Returns the number of the server's ticks since the first snapshot; 0 before the first picture.
  std::uint32_t ticks() {
    naiad::ClientSession* session = m_connection.session();
    return session != nullptr && m_first_tick ? session->clock().newestTick() - *m_first_tick : 0;
  }
  void leave() {
    if (naiad::ClientSession* session = m_connection.session()) m_recorder.finish(session->replica());
    m_connection.leave();
  }
  naiad::Connection& connection() { return m_connection; }
  const naiad::TruthRecorder& recorder() const { return m_recorder; }
  Clock::time_point joinedAt() const { return m_joined_at; }

  /// True if a snapshot has come after `then`.
  bool isHeardSince(Clock::time_point then) const { return m_heard_at > then; }
  /// True if no snapshot came for longer than a working server pauses.
  bool isSilent(Clock::time_point now) {
    const naiad::ClientSession* session = m_connection.session();
    if (session == nullptr) return false;
    return now - m_heard_at > kSnapshotTimeout + 2 * kKeepAliveTicks * session->welcome().tick;
  }
  /// True if the stream broke and no datagrams arrive either.
  bool isCutOff(Clock::time_point now) {
    const naiad::ClientSession* session = m_connection.session();
    return session != nullptr && session->isDetached() && !session->isReceiving(now);
  }

 private:
  static naiad::SessionOptions sessionOptions(const BotOptions& options, int index) {
    naiad::SessionOptions session = options.session;
    session.name = options.clients == 1 ? options.name : options.name + std::to_string(index + 1);
    session.game = options.game;
    session.program = std::string("dfbot ") + naiad::kVersion;
    return session;
  }

  void startPlaying(const naiad::ClientSession& session, Clock::time_point now) {
    m_next_tick = m_joined_at = now;
    if (m_options.random_seed) {
      const std::uint64_t seed = *m_options.random_seed + static_cast<std::uint64_t>(m_index);
      m_random = std::make_unique<naiad::RandomPlayer>(seed, session.replica().viewWidth(),
                                                       session.replica().viewHeight());
    } else {
      m_script = std::make_unique<naiad::ScriptPlayer>(m_options.script.value_or(naiad::BotScript()));
    }
  }

  void play(naiad::ClientSession& session, Clock::time_point now) {
    for (const naiad::BotAction& action : m_random ? m_random->tick() : m_script->tick()) {
      if (const auto* key = std::get_if<naiad::KeyAction>(&action))
        session.sendKey(key->key, key->action, now);
      if (const auto* click = std::get_if<naiad::BotClick>(&action)) {
        session.sendMouse(click->action, click->button, click->x, click->y, now);
      }
      if (const auto* chat = std::get_if<naiad::BotChat>(&action)) session.sendChat(chat->text);
    }
  }

  const BotOptions& m_options;
  int m_index;
  naiad::Connection m_connection;
  naiad::TruthRecorder m_recorder;
  std::optional<std::uint32_t> m_first_tick;
  Clock::time_point m_joined_at{};
  Clock::time_point m_heard_at{};
  Clock::time_point m_next_tick{};
  std::unique_ptr<naiad::ScriptPlayer> m_script;
  std::unique_ptr<naiad::RandomPlayer> m_random;
};

/// Returns the script: the contents of the file `argument` if it can be opened, else `argument` itself.
std::string scriptText(const std::string& argument) {
  std::ifstream file(argument, std::ios::binary);
  if (!file) return argument;
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

int complain(naiad::ExitCode code, const std::string& message) {
  std::fprintf(stderr, "dfbot: %s\n", message.c_str());
  return code;
}

/// Result of comparing all bots' pictures with the truth file. `fault` says why the comparison failed or
/// proves nothing; it is empty if all cells were right.
struct Proof {
  naiad::TruthRecorder::Comparison compared{.readable = true};
  std::string fault;
};

Proof compareWithTruth(const BotOptions& options, const std::vector<std::unique_ptr<Bot>>& bots) {
  Proof proof;
  for (std::size_t i = 0; i < bots.size(); ++i) {
    const std::uint32_t player = bots[i]->connection().session()->welcome().player;
    const auto one = bots[i]->recorder().compare(options.truth_file, player);
    proof.compared += one;
    if (one.ticks == 0 && proof.fault.empty()) {
      proof.fault = "no tick that bot " + std::to_string(i + 1) + " saw is in the truth file " +
                    options.truth_file + ": nothing was compared";
    }
  }
  if (!proof.compared.readable) proof.fault = "cannot read the truth file " + options.truth_file;
  if (proof.compared.wrong != 0) {
    proof.fault = std::to_string(proof.compared.wrong) + " wrong cells, the first at tick " +
                  std::to_string(proof.compared.first_wrong_tick);
  }
  return proof;
}

/// Prints the last screen of the first bot and the summary line. Returns the exit code.
int report(const BotOptions& options, std::vector<std::unique_ptr<Bot>>& bots, Clock::time_point now) {
  naiad::ClientSession& first = *bots[0]->connection().session();
  if (!options.quiet) std::fputs(first.replica().render(first.displayTick(now)).text().c_str(), stdout);

  naiad::SessionCounters total;
  for (const auto& bot : bots) {
    const naiad::SessionCounters& counters = bot->connection().session()->counters();
    total.bytes_in += counters.bytes_in;
    total.snapshots += counters.snapshots;
    total.chat_lines += counters.chat_lines;
  }
  const bool compares = !options.truth_file.empty();
  const Proof proof = compares ? compareWithTruth(options, bots) : Proof();
  const std::chrono::duration<double> played = now - bots[0]->joinedAt();
  const double per_client = static_cast<double>(total.bytes_in) / static_cast<double>(bots.size());
  std::printf("bot %s clients=%zu ticks=%u objects=%zu score=%d bytes_per_s=%.0f snapshots=%llu chat=%llu",
              proof.fault.empty() ? "ok" : "failed", bots.size(), bots[0]->ticks(),
              first.replica().aliveCount(), first.score(), per_client / std::max(played.count(), 0.001),
              static_cast<unsigned long long>(total.snapshots),
              static_cast<unsigned long long>(total.chat_lines));
  if (compares) {
    std::printf(" compared_ticks=%llu compared_cells=%llu wrong_cells=%llu moving=%zu",
                static_cast<unsigned long long>(proof.compared.ticks),
                static_cast<unsigned long long>(proof.compared.cells),
                static_cast<unsigned long long>(proof.compared.wrong), bots[0]->recorder().movingCount());
  }
  std::printf("\n");
  return proof.fault.empty() ? naiad::kExitLeft : complain(naiad::kExitTruthMismatch, proof.fault);
}

/// Reports that the connection was lost, and how much the first bot had seen. Returns the exit code.
int reportLoss(Bot& bot, const std::string& message) {
  const naiad::ClientSession* session = bot.connection().session();
  std::printf("bot lost ticks=%u objects=%zu\n", bot.ticks(),
              session != nullptr ? session->replica().aliveCount() : 0);
  std::fflush(stdout);
  return complain(naiad::kExitEnded, message);
}

int run(const BotOptions& options) {
  using State = naiad::Connection::State;
  asio::io_context context(1);
  std::vector<std::unique_ptr<Bot>> bots;
  bots.reserve(static_cast<std::size_t>(options.clients));
  for (int i = 0; i < options.clients; ++i) bots.push_back(std::make_unique<Bot>(context, options, i));

  // Sockets to a gateway belong to another thread; without this, run_for() would not wait in an idle turn.
  auto work = asio::make_work_guard(context);
  std::optional<Clock::time_point> all_joined;
  std::optional<Clock::time_point> played_at;
  while (true) {
    context.restart();
    context.run_for(kTurn);
    const Clock::time_point now = Clock::now();
    bool joined = true;
    for (const auto& bot : bots) {
      bot->update(now);
      const naiad::Connection& connection = bot->connection();
      switch (connection.state()) {
        case State::kUnreachable:
          return complain(naiad::kExitUnreachable, connection.message());
        case State::kRefused:
          return complain(naiad::kExitRefused, connection.message());
        case State::kEnded:
        case State::kLost:
          return reportLoss(*bots[0], connection.message());
        default:
          joined = joined && connection.state() == State::kJoined;
      }
      if (!options.rejoin && bot->isCutOff(now))
        return reportLoss(*bots[0], "The connection to the server was lost.");
    }
    if (joined && !all_joined) all_joined = now;
    if (!all_joined) continue;
    const std::chrono::duration<double> played = now - *all_joined;
    const bool enough =
        options.ticks ? bots[0]->ticks() >= *options.ticks : played.count() >= options.seconds.value_or(5);
    if (enough && !played_at) played_at = now;
    if (!played_at) continue;
    // Wait for a snapshot after the end of play: a server that has crashed or hangs sends none.
    const auto isAlive = [&](const auto& bot) { return bot->isHeardSince(*played_at); };
    if (std::all_of(bots.begin(), bots.end(), isAlive)) break;
    const auto isSilent = [now](const auto& bot) { return bot->isSilent(now); };
    if (!options.rejoin && std::any_of(bots.begin(), bots.end(), isSilent)) {
      return reportLoss(*bots[0], "The server stopped sending snapshots.");
    }
  }
  const Clock::time_point end = Clock::now();
  for (const auto& bot : bots) bot->leave();
  work.reset();
  context.restart();
  context.run_for(std::chrono::milliseconds(1000));  // ends as soon as the channels have closed
  return report(options, bots, end);
}

std::vector<naiad::Option> optionsOf(BotOptions& bot, naiad::ServerChoice& server, std::string& script,
                                     bool& web) {
  std::vector<naiad::Option> options = {
      naiad::serverOption(server),
      {"--web", &web, "SERVER is the address of a page, https://HOST[:PORT]/: join like a browser"},
      {.name = "--clients",
       .target = &bot.clients,
       .help = "Number of players (default 1)",
       .range = naiad::OptionRange{1, 1000}},
      {.name = "--seconds",
       .target = &bot.seconds,
       .help = "Seconds to play after all players have joined (default 5)",
       .range = naiad::OptionRange{0, 86400.0 * 365, naiad::kSecond}},
      {.name = "--ticks",
       .target = &bot.ticks,
       .help = "Instead of --seconds: number of server ticks to play",
       .excludes = "--seconds"},
      {"--script", &script, "Script file, or the script itself (see below)"},
      {.name = "--random",
       .target = &bot.random_seed,
       .help = "Random input from this seed, instead of a script",
       .excludes = "--script"},
      {"--name", &bot.name, "Name in the game (with several clients: numbered)", "NAIAD_NAME"}};
  for (naiad::Option& option : naiad::trustOptions(server, bot.trust, bot.session)) options.push_back(option);
  options.push_back(
      {"--game", &bot.game, "Game to play; refused if the server does not run it", "NAIAD_GAME"});
  options.push_back(naiad::typedOption(
      "--truth-file", "FILE", &bot.truth_file,
      "Compare each received picture with this file, written by dfserver --truth-file FILE"));
  options.push_back(
      {"--rejoin", &bot.rejoin, "Reconnect when the connection is lost, like dfclient, instead of exiting"});
  options.push_back({"--quiet", &bot.quiet, "Do not print the last screen"});
  return options;
}

int start(int argc, char** argv) {
  BotOptions options;
  naiad::ServerChoice server;
  std::string script;
  bool web = false;
  const naiad::Program program{"dfbot", "Join a Naiad server with scripted or random players and no screen.",
                               std::string(kScriptHelp) + naiad::kExitCodeHelp};
  const naiad::ParseResult parsed =
      naiad::parseOptions(program, optionsOf(options, server, script, web), argc, argv);
  if (const auto code = naiad::exitCodeOf(parsed)) return *code;

  const std::string wrong = naiad::resolveServer(server, options.address, options.trust, options.session);
  if (!wrong.empty()) return complain(naiad::kExitUsage, wrong);
  if (web && !options.trust.gateway)
    return complain(naiad::kExitUsage, "--web requires the address of a page: https://HOST[:PORT]/.");
  if (std::error_code none; std::filesystem::is_directory(script, none))
    return complain(naiad::kExitUsage,
                    "--script: " + script + " is a folder; expected a file or the script itself.");
  if (!script.empty()) {
    auto read = naiad::BotScript::parse(scriptText(script));
    if (const auto* error = std::get_if<naiad::ScriptError>(&read)) {
      return complain(naiad::kExitUsage, "script, line " + std::to_string(error->line) + ", column " +
                                             std::to_string(error->column) + ": " + error->message);
    }
    options.script = std::get<naiad::BotScript>(std::move(read));
  }
  return run(options);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return start(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "dfbot: %s\n", error.what());
    return naiad::kExitUsage;
  }
}

#include "RecoveryRun.h"

#include <signal.h>

#include <algorithm>
#include <cstdlib>
#include <set>
#include <sstream>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "client/bot/BotScript.h"
#include "client/bot/TruthRecorder.h"
#include "client/session/Connection.h"
#include "host/journal/UnfinishedRound.h"
#include "host/rounds/RoundJournals.h"
#include "host/scores/ScoreStore.h"
#include "server/replay/RecordedRound.h"
#include "server/replay/Replay.h"
#include "server/replay/RoundPlayer.h"
#include "server/replay/Verify.h"
#include "tests/support/Processes.h"

namespace naiad::test {

namespace {

constexpr std::chrono::milliseconds kBetweenKeys{20};
/// Number of further ticks that each client must see after its world was killed or hung.
constexpr std::uint32_t kSeenTicks = 10;
/// Number of these ticks that may have been sent before the world failed.
constexpr std::uint32_t kOnTheWay = 3;

/// Returns the process of the world that runs the round; 0 if there is none. A second world, which only
/// checks replays, starts later.
pid_t worldOf(pid_t server) {
  const std::vector<pid_t> worlds = processesBelow(server, "exe");  // started as /proc/self/exe
  return worlds.empty() ? 0 : worlds.front();
}

constexpr std::chrono::seconds kForLog{3};  ///< timeout for a log line that should already be written
constexpr const char* kIsBack = "\" reconnected to the recovered round";
constexpr const char* kGoesOn = "round recovered: replayed ";

}  // namespace

/// Plays at random and keeps the newest complete picture.
class RecoveryClient {
 public:
  RecoveryClient(asio::io_context& context, std::uint16_t port, const ClientSetup& setup, std::uint64_t seed)
      : m_connection(context, ServerAddress{"127.0.0.1", port}, setup.options, true, setup.trust),
        m_player(seed, 80, 24) {
    m_connection.onSession([this](ClientSession& session) {
      ++m_sessions;
      m_whole = CompletenessTracker();
      session.onBeforeSnapshot([this, &session](std::uint32_t tick) {
        if (tick != m_whole.tick()) keepPicture(session);
      });
      session.onAfterSnapshot([this, &session](const SnapshotHeader& header, const AckWindow& acks) {
        m_whole.addSnapshot(header, acks, session.welcome().resume_state.value_or(ResumeState()).snapshot);
      });
    });
    m_connection.start();
  }

  void update(Clock::time_point now) {
    m_connection.update(now);
    ClientSession* p_session = m_connection.session();
    if (p_session == nullptr || m_connection.state() != Connection::State::kJoined || now < m_next_key)
      return;
    m_next_key = now + kBetweenKeys;
    for (const BotAction& action : m_player.tick()) {
      if (const auto* p_key = std::get_if<KeyAction>(&action))
        p_session->sendKey(p_key->key, p_key->action, now);
    }
  }
  void press(df::Keyboard::Key key) {
    m_connection.session()->sendKey(key, df::KEY_PRESSED, Clock::now());
    m_connection.session()->sendKey(key, df::KEY_RELEASED, Clock::now());
  }
  void leave() { m_connection.leave(); }
  bool isJoined() { return m_connection.state() == Connection::State::kJoined; }
  /// True if the client plays in a session that began after forgetSession().
  bool isBack() { return isJoined() && m_sessions != m_sessions_before; }
  void forgetSession() { m_sessions_before = m_sessions; }
  bool isOver() const { return m_connection.isOver(); }
  const std::string& message() const { return m_connection.message(); }
  const WelcomeMessage& welcome() { return m_connection.session()->welcome(); }
  const ClientSession* session() { return m_connection.session(); }
  std::uint32_t newestTick() const { return m_whole.tick(); }
  /// True if the client has had a complete picture since freezePicture().
  bool hasPicture() const { return m_picture.has_value() || m_whole.isComplete(); }
  /// Returns the last picture before freezePicture().
  const std::optional<df::Canvas>& picture() const { return m_frozen; }
  std::uint32_t pictureTick() const { return m_frozen_tick; }
  void freezePicture() {
    if (const ClientSession* p_session = session()) keepPicture(*p_session);
    m_frozen = std::exchange(m_picture, std::nullopt);
    m_frozen_tick = m_picture_tick;
    m_whole = CompletenessTracker();
  }

 private:
  void keepPicture(const ClientSession& session) {
    if (!m_whole.isComplete()) return;
    m_picture = session.replica().render(m_whole.tick());
    m_picture_tick = m_whole.tick();
  }

  Connection m_connection;
  RandomPlayer m_player;
  Clock::time_point m_next_key;
  CompletenessTracker m_whole;
  std::optional<df::Canvas> m_picture;
  std::uint32_t m_picture_tick = 0;
  int m_sessions = 0;
  int m_sessions_before = 0;
  std::optional<df::Canvas> m_frozen;
  std::uint32_t m_frozen_tick = 0;
};

RecoveryRun::RecoveryRun(const std::string& game, int players, std::uint64_t seed,
                         std::chrono::microseconds frame)
    : m_game(game), m_random(seed), m_frame(frame), m_rounds(m_home.identity("rounds")) {
  startServer();
  for (int i = 1; i <= players; ++i) {
    m_clients.push_back(std::make_unique<RecoveryClient>(
        m_context, m_port, m_home.player("player" + std::to_string(i)), m_random()));
  }
  if (!serveUntilJoined()) throw std::runtime_error("the players cannot join: " + m_server->log());
  waitForFirstTick();
}

// Waits until the first tick is in the round's file, that is, written to disk.
void RecoveryRun::waitForFirstTick() {
  const auto end = Clock::now() + kPatience;
  while (m_first_tick == 0 && Clock::now() < end) {
    play(std::chrono::milliseconds(10));
    const UnfinishedRound so_far(round().string());
    m_first_tick = static_cast<std::uint32_t>(std::atoi(so_far.fact(kFactFirstTick).c_str()));
  }
}

RecoveryRun::~RecoveryRun() = default;

void RecoveryRun::startServer() {
  m_server.reset();
  m_server = std::make_unique<GameProgram>(
      "dfserver", std::map<std::string, std::string>{{"NAIAD_FRAME_TIME", std::to_string(m_frame.count())},
                                                     {"NAIAD_PORT", std::to_string(m_port)},
                                                     {"NAIAD_IDENTITY", m_home.identity("key").string()},
                                                     {"NAIAD_JOURNAL", m_rounds.string()},
                                                     {"NAIAD_STATE", m_home.identity("state").string()},
                                                     {"NAIAD_GAME", m_game},
                                                     {"DRAGONFLY_CONFIG", m_home.identity("none").string()}});
  m_port = m_server->port();
  if (m_port == 0) throw std::runtime_error("the server does not start: " + m_server->log());
}

bool RecoveryRun::playUntil(const std::function<bool()>& done, std::chrono::milliseconds patience) {
  const auto end = Clock::now() + patience;
  while (!done()) {
    if (Clock::now() > end) return false;
    for (const auto& client : m_clients) client->update(Clock::now());
    m_context.restart();
    m_context.run_one_for(std::chrono::milliseconds(5));
  }
  return true;
}

bool RecoveryRun::serveUntilJoined() {
  const auto is_ready = [](const auto& client) { return client->isBack() || client->isOver(); };
  return playUntil([&] { return std::ranges::all_of(m_clients, is_ready); });
}

void RecoveryRun::play(std::chrono::milliseconds time) {
  playUntil([] { return false; }, time);
}

bool RecoveryRun::playUntilPictured() {
  const auto has_picture = [](const auto& client) { return client->hasPicture(); };
  return playUntil([&] { return std::ranges::all_of(m_clients, has_picture); });
}

bool RecoveryRun::playUntilTurn(std::uint32_t turn, std::chrono::seconds patience) {
  const auto is_there = [&](const auto& client) { return client->newestTick() >= m_first_tick + turn; };
  return playUntil([&] { return std::ranges::all_of(m_clients, is_there); }, patience);
}

std::filesystem::path RecoveryRun::round() const {
  for (const auto& entry : std::filesystem::directory_iterator(m_rounds)) {
    if (m_round.empty()) m_round = entry.path();
  }
  return m_round;
}

std::uint32_t RecoveryRun::recoveredTurns() const {
  const std::string log = m_server->log();
  const std::size_t at = log.rfind(kGoesOn);
  return at == std::string::npos
             ? 0
             : static_cast<std::uint32_t>(std::atoi(log.c_str() + at + std::string_view(kGoesOn).size()));
}

KillResult RecoveryRun::kill() {
  killServer();
  return comeBack();
}

KillResult RecoveryRun::killTwice(std::chrono::milliseconds between) {
  killServer();
  startServer();
  play(between);
  m_server->end(SIGKILL);
  m_log += m_server->log();
  for (const auto& client : m_clients) client->forgetSession();  // some may already have returned
  return comeBack();
}

KillResult RecoveryRun::killBoth() {
  const pid_t world = worldOf(m_server->process());
  if (world > 0) ::kill(world, SIGKILL);
  return kill();
}

void RecoveryRun::killServer() {
  m_killed_at = Clock::now();
  m_server->end(SIGKILL);
  m_log += m_server->log();
  play(std::chrono::milliseconds(20));  // receives the messages that the server sent before
  m_before.clear();
  m_seen = 0;
  for (const auto& client : m_clients) {
    m_before.push_back(client->welcome());
    m_seen = std::max(m_seen, client->newestTick());
    client->freezePicture();
    client->forgetSession();
  }
}

// Waits for the line, because a client may have its answer before another thread has written the line.
bool RecoveryRun::isLogged(const std::string& text) {
  return playUntil([&] { return m_server->log().find(text) != std::string::npos; }, kForLog);
}

KillResult RecoveryRun::comeBack() {
  KillResult result;
  startServer();
  const bool back = serveUntilJoined();
  result.took = std::chrono::duration_cast<std::chrono::milliseconds>(Clock::now() - m_killed_at);
  judge(back, result);
  return result;
}

void RecoveryRun::judge(bool back, KillResult& result) {
  if (!back) result.problem += "not all are back: " + m_server->log();
  for (std::size_t i = 0; i < m_clients.size(); ++i) {
    RecoveryClient& client = *m_clients[i];
    ++result.players;
    const bool same = client.isBack() && client.welcome().player == m_before[i].player &&
                      client.welcome().name == m_before[i].name &&
                      isLogged("\"" + m_before[i].name + kIsBack);
    result.returned += same ? 1 : 0;
    if (!same && result.problem.empty())
      result.problem =
          m_before[i].name + " is not back: " + client.message() + "\n" + m_log + m_server->log();
  }
  const std::string log = m_server->log();
  const std::uint32_t turns = recoveredTurns();
  const std::uint32_t last = m_seen + 1 - m_first_tick;  // the world counts its ticks from 1
  if (last > turns) {
    result.ticks_lost = last - turns;
    result.problem = "a client saw tick " + std::to_string(m_seen) + ", the world's " + std::to_string(last) +
                     "; there are " + std::to_string(turns) + " turns:\n" + m_log + log;
  }
  if (result.problem.empty()) compare(result);
}

std::optional<std::chrono::milliseconds> RecoveryRun::killWorld() {
  const pid_t world = worldOf(m_server->process());
  if (world <= 0) return std::nullopt;
  return timeToNextPicture([world] { ::kill(world, SIGKILL); });
}

std::optional<std::chrono::milliseconds> RecoveryRun::killChildren(bool reversed) {
  std::vector<pid_t> children = processesBelow(m_server->process());
  if (reversed) std::ranges::reverse(children);
  return timeToNextPicture([&children] {
    for (const pid_t child : children) ::kill(child, SIGKILL);
  });
}

std::optional<std::chrono::milliseconds> RecoveryRun::hangWorld(df::Keyboard::Key key) {
  return timeToNextPicture([this, key] { m_clients.front()->press(key); });
}

std::optional<std::chrono::milliseconds> RecoveryRun::timeToNextPicture(const std::function<void()>& harm) {
  std::vector<std::pair<const ClientSession*, std::uint32_t>> before;
  for (const auto& client : m_clients) before.emplace_back(client->session(), client->newestTick());
  const auto began = Clock::now();
  harm();
  const auto sees_more = [&](std::uint32_t ticks) {
    for (std::size_t i = 0; i < m_clients.size(); ++i) {
      if (m_clients[i]->newestTick() < before[i].second + ticks) return false;
    }
    return true;
  };
  std::optional<Clock::time_point> next_picture;
  const bool seen = playUntil([&] {
    // Pictures sent before the world failed still arrive, so the first kOnTheWay ticks do not count.
    if (!next_picture && sees_more(kOnTheWay)) next_picture = Clock::now();
    return sees_more(kSeenTicks);
  });
  if (!seen) return std::nullopt;
  for (std::size_t i = 0; i < m_clients.size(); ++i) {
    if (m_clients[i]->session() != before[i].first) return std::nullopt;
  }
  return std::chrono::duration_cast<std::chrono::milliseconds>(next_picture.value_or(Clock::now()) - began);
}

// Replays the round's file, from which the world was recovered, and compares it with the last pictures.
void RecoveryRun::compare(KillResult& result) {
  const RecordedRound recorded(round());
  const ReplayEnvironment stage(recorded, replayedGame());
  FrameHistory reel(recorded, stage);
  for (const auto& client : m_clients) {
    if (!client->picture()) continue;
    const std::uint32_t tick = client->pictureTick() + 1 - m_first_tick;
    if (reel.seek(tick) != tick) {
      result.problem = "the round has no tick " + std::to_string(tick);
      return;
    }
    for (const WorldPicture& picture : reel.pictures()) {
      if (picture.player != client->welcome().player) continue;
      const df::Canvas& saw = *client->picture();
      for (int y = 0; y < saw.height(); ++y) {
        for (int x = 0; x < saw.width(); ++x) {
          ++result.cells;
          const bool same = saw.at(x, y).ch == picture.canvas.at(x, y).ch &&
                            saw.at(x, y).color == picture.canvas.at(x, y).color;
          result.wrong_cells += same ? 0 : 1;
        }
      }
    }
  }
  if (result.wrong_cells == 0) return;
  result.problem = std::to_string(result.wrong_cells) + " wrong cells; executed again, " +
                   (reel.firstDifference() == 0
                        ? "the round is as it was recorded"
                        : "tick " + std::to_string(reel.firstDifference()) + " differs from the recording");
}

bool RecoveryRun::verify(std::string& said) {
  for (const auto& client : m_clients) client->leave();
  play(std::chrono::milliseconds(200));
  m_server->end(SIGTERM);
  m_log += m_server->log();
  const RecordedRound recorded(round());
  const ReplayEnvironment stage(recorded, replayedGame());
  std::ostringstream out;
  const bool same = verifyRound(recorded, stage, out);
  said = out.str();
  return same;
}

ScoreCheck RecoveryRun::checkScores() const {
  using Row = std::tuple<std::uint32_t, int, std::string, std::string, std::int64_t>;
  const RecordedRound recorded(round());
  const ReplayEnvironment stage(recorded, replayedGame());
  Replay replay(recorded, stage);
  replay.readScores();
  std::set<Row> added;
  while (replay.step()) {
    for (const df::AddedScore& one : replay.scores())
      added.insert({one.tick, one.number, one.table, one.score.name, one.score.points});
  }
  const std::string game = std::filesystem::path(m_game).stem().string();
  ScoreStore store(m_home.identity("state") / "scores.sqlite3", game);
  const std::vector<ScoreRow> kept = store.best("", ScoreStore::kMaxRows);
  ScoreCheck check{.kept = kept.size()};
  for (const ScoreRow& row : kept) {
    const bool is_here = row.recording == round().filename();
    check.foreign +=
        is_here && added.erase({row.tick, row.number, row.table, row.name, row.points}) == 1 ? 0 : 1;
  }
  check.missing = added.size();
  return check;
}

}  // namespace naiad::test

#include "host/ops/HostAdmin.h"

#include <algorithm>
#include <asio/post.hpp>
#include <utility>

#include "host/loop/HostClients.h"
#include "host/loop/HostControls.h"
#include "host/loop/HostEndpoint.h"
#include "host/rooms/SessionTable.h"
#include "host/settings/RoomOptions.h"
#include "naiad.pb.h"
#include "shared/net/base/Limits.h"
#include "shared/net/base/SafeText.h"
#include "shared/options/Duration.h"
#include "shared/options/Options.h"
#include "shared/values/Version.h"

namespace naiad {

namespace {

/// Returns the options that may change while the server runs, without dashes.
const std::vector<std::string>& changeableOptions() {
  static const std::vector<std::string> names{"max-players",    "max-per-address", "server-name",
                                              "reconnect-time", "exit-when-empty", "drain-timeout",
                                              "idle-kick",      "vote-kick",       "log-chat"};
  return names;
}

std::chrono::seconds since(Session::Clock::time_point then, Session::Clock::time_point now) {
  return std::chrono::duration_cast<std::chrono::seconds>(now - then);
}

AdminPlayer factsOf(const Session& session, Session::Clock::time_point now) {
  AdminPlayer player;
  player.session = session.id();
  player.id = session.player();
  player.name = session.name();
  player.address = session.address();
  player.connected = since(session.status().joined(), now);
  player.idle = since(session.status().lastActivity(), now);
  player.rtt_millis = session.rttMillis();
  player.detached = session.isDetached();
  player.muted = session.status().isMuted();
  player.admin = session.status().isAdmin();
  player.room = session.welcomed().room();
  return player;
}

AdminAnswer listOf(const std::vector<ScoreRow>& scores) {
  std::vector<AdminRow> rows;
  std::int64_t place = 0;
  for (const ScoreRow& row : scores) {
    place = !rows.empty() && row.table == std::get<std::string>(rows.back()[0].second) ? place + 1 : 1;
    const std::chrono::system_clock::time_point at{std::chrono::seconds(row.at)};
    rows.push_back({{"table", row.table},
                    {"place", place},
                    {"name", row.name},
                    {"points", row.points},
                    {"at", timeText(at)},
                    {"recording", row.recording},
                    {"round", row.round},
                    {"tick", std::int64_t{row.tick}},
                    {"number", std::int64_t{row.number}}});
  }
  return AdminAnswer::list(std::move(rows), "No scores.");
}

/// Returns text like "rooms one, two".
std::string listed(const std::vector<std::string>& rooms) {
  std::string text = rooms.size() == 1 ? "room " : "rooms ";
  for (std::size_t i = 0; i < rooms.size(); ++i) text += (i > 0 ? ", " : "") + rooms[i];
  return text;
}

std::string unknownGame(const std::string& typed, const std::vector<std::string>& games) {
  const std::string near = nearestName(typed, games);
  const std::string sentence = "Unknown game \"" + safeText(typed, 100) + "\"";
  if (!near.empty()) return sentence + "; did you mean \"" + near + "\"?";
  std::string all;
  for (const std::string& game : games) all += (all.empty() ? "" : ", ") + game;
  return sentence + ". Games: " + all + ".";
}

HostControls::Done answering(std::function<void(AdminAnswer)> done) {
  return [done = std::move(done)](bool is_done, const std::string& sentence) {
    done(is_done ? AdminAnswer::done(sentence + ".") : AdminAnswer::refused(sentence + "."));
  };
}

double millis(std::chrono::microseconds time) {
  return static_cast<double>(time.count()) / 1000;
}

}  // namespace

HostAdmin::HostAdmin(const HostAccess& access, HostScores& scores)
    : m_access(access), m_scores(scores), m_began(Session::Clock::now()) {}

std::vector<AdminPlayer> HostAdmin::players() const {
  std::vector<AdminPlayer> players;
  const auto now = m_access.endpoint.network().now();
  m_access.clients.sessions().forEachPlaying(
      [&](const Session& session) { players.push_back(factsOf(session, now)); });
  std::sort(players.begin(), players.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  return players;
}

AdminRow HostAdmin::status() const {
  const Counters& counters = m_access.context.counters;
  const TickTimes& times = m_access.endpoint.network().tickTimes();
  const auto number = [](std::uint64_t count) { return static_cast<std::int64_t>(count); };
  return {
      {"server", m_access.context.options.name},
      {"version", std::string(kVersion)},
      {"game", m_access.context.game},
      {"address", m_access.endpoint.address()},
      {"join", joinCommand()},
      {"uptime_seconds", number(static_cast<std::uint64_t>(since(m_began, Session::Clock::now()).count()))},
      {"rooms", number(m_access.clients.rooms().countAwake())},
      {"players", number(m_access.clients.sessions().playingCount())},
      {"connected", number(m_access.clients.sessions().connectedCount())},
      {"max_players", std::int64_t{m_access.context.options.max_players}},
      {"password", m_access.clients.admission().needsPassword()},
      {"ticks", number(counters.ticks)},
      {"late_ticks", number(counters.late_ticks)},
      {"missed_ticks", number(counters.world_missed_ticks)},
      {"tick_p50_ms", millis(times.quantile(0.5))},
      {"tick_p99_ms", millis(times.quantile(0.99))},
      {"joined", number(counters.joined)}};
}

std::string HostAdmin::joinCommand() const {
  return m_access.endpoint.joinCommand();
}

std::vector<AdminRow> HostAdmin::rooms() const {
  std::vector<AdminRow> rows;
  if (!m_access.clients.rooms().isNamed()) return rows;
  m_access.clients.rooms().forEachRoom([&rows](const Room& room) {
    rows.push_back({{"room", room.plan()->name},
                    {"game", room.plan()->game},
                    {"players", static_cast<std::int64_t>(room.countPlaying())},
                    {"max_players", std::int64_t{room.plan()->max_players}},
                    {"asleep", room.isAsleep()},
                    {"ticks", static_cast<std::int64_t>(room.ticks())},
                    {"missed_ticks", static_cast<std::int64_t>(room.lateTicks())}});
  });
  return rows;
}

Session* HostAdmin::findPlaying(std::uint64_t session) const {
  Session* p_session = m_access.clients.sessions().find(session);
  return p_session != nullptr && p_session->state() == Session::State::kPlaying ? p_session : nullptr;
}

// This also invalidates the resume token of the session (Admission::forgetSession).
void HostAdmin::kickPlayer(std::uint64_t session, const std::string& sentence) {
  if (Session* p_session = findPlaying(session))
    p_session->sendGoodbye(safeText(sentence, kMaxMessageLength));
}

void HostAdmin::broadcast(const std::string& text) {
  m_access.clients.broadcast(text);
}

void HostAdmin::tell(std::uint64_t session, const std::string& text) {
  if (Session* p_session = findPlaying(session)) sendServerLine(*p_session, text);
}

void HostAdmin::setMuted(std::uint64_t session, bool muted) {
  Session* p_session = findPlaying(session);
  if (p_session == nullptr) return;
  p_session->status().setMuted(muted);
  m_access.clients.admission().recordSession(*p_session);
}

// ---- the server -------------------------------------------------------------------------------------------

AdminAnswer HostAdmin::stop(const std::string& sentence) {
  m_access.controls.end(
      {.at = Session::Clock::time_point(), .sentence = safeText(sentence, kMaxMessageLength)});
  return AdminAnswer::done("The server is stopping.");
}

AdminAnswer HostAdmin::restart(bool at_round_end, std::optional<std::chrono::seconds> in) {
  ShutdownScheduler::Plan plan{.is_restart = true};
  plan.at_round_end = at_round_end;
  if (!at_round_end) plan.at = in ? Session::Clock::now() + *in : Session::Clock::time_point();
  const std::string when = at_round_end ? "when the round is over"
                           : in         ? "in " + std::to_string(in->count()) + " s"
                                        : "now";
  m_access.controls.end(std::move(plan));
  return AdminAnswer::done("The server restarts " + when + ".");
}

void HostAdmin::handOverRound(std::function<void(AdminAnswer)> done) {
  m_access.controls.handOverRound(answering(std::move(done)));
}

// The time limit is that of the command, or else --drain-timeout. If both are absent, there is no limit.
AdminAnswer HostAdmin::drain(std::optional<std::chrono::seconds> most) {
  ShutdownScheduler::Plan plan{.when_empty = true};
  std::chrono::duration<double> patience(m_access.context.options.drain_time);
  if (most) patience = *most;
  std::string text = "Draining: no new players. The server stops when all players have left";
  if (most || patience.count() > 0) {
    plan.at = Session::Clock::now() + std::chrono::duration_cast<Session::Clock::duration>(patience);
    text += ", or in " + std::to_string(std::chrono::ceil<std::chrono::seconds>(patience).count()) +
            " s at the latest";
  }
  m_access.controls.end(std::move(plan));
  return AdminAnswer::done(text + ".");
}

AdminAnswer HostAdmin::cancel() {
  if (!m_access.controls.cancelEnd())
    return AdminAnswer::refused("No shutdown, restart or drain is scheduled.");
  broadcast("The server stays up: its shutdown or restart was cancelled.");
  return AdminAnswer::done("Cancelled: the server stays up.");
}

void HostAdmin::reload(std::function<void(AdminAnswer)> done) {
  m_access.controls.reload(answering(std::move(done)));
}

AdminAnswer HostAdmin::changePassword(std::optional<PasswordHash> hash) {
  const bool needed = hash.has_value();
  m_access.clients.admission().changePassword(std::move(hash));
  return AdminAnswer::done(needed ? "New players need the new password."
                                  : "New players need no password any more.");
}

std::vector<HostAdmin::Board> HostAdmin::boards() const {
  if (!m_access.clients.rooms().isNamed()) return {{m_access.context.game, {}}};
  std::vector<Board> boards;
  m_access.clients.rooms().forEachRoom([&boards](const Room& room) {
    const RoomConfig& plan = *room.plan();
    auto board = std::find_if(boards.begin(), boards.end(),
                              [&plan](const Board& one) { return one.game == plan.game; });
    if (board == boards.end()) board = boards.insert(board, {plan.game, {}});
    board->rooms.push_back(plan.name);
  });
  return boards;
}

const HostAdmin::Board* HostAdmin::findBoard(const std::vector<Board>& boards, const AdminScores& which,
                                             AdminAnswer& refusal) {
  std::vector<std::string> games;
  std::vector<std::string> rooms;
  for (const Board& board : boards) {
    games.push_back(board.game);
    rooms.insert(rooms.end(), board.rooms.begin(), board.rooms.end());
    const bool has_room = std::find(board.rooms.begin(), board.rooms.end(), which.room) != board.rooms.end();
    const bool is_meant = which.game.empty() ? has_room : board.game == which.game;
    if (is_meant) return &board;
  }
  if (which.game.empty() && which.room.empty() && boards.size() == 1) return &boards.front();
  if (!which.game.empty()) {
    refusal = AdminAnswer::refused(unknownGame(which.game, games));
  } else if (!which.room.empty()) {
    refusal = AdminAnswer::refused(rooms.empty() ? "This server has no rooms."
                                                 : unknownRoomMessage(which.room, rooms));
  } else {
    refusal = AdminAnswer::refused("Each game has its own tables; choose one with --game or --room:");
    for (const Board& board : boards)
      refusal.candidates.push_back("--game " + board.game + "  (" + listed(board.rooms) + ")");
  }
  return nullptr;
}

void HostAdmin::scores(const AdminScores& which, std::function<void(AdminAnswer)> done) {
  const std::vector<Board> all = boards();
  AdminAnswer refusal;
  const Board* const p_board = findBoard(all, which, refusal);
  if (p_board == nullptr) return done(refusal);
  ScoreKeeper& scores = m_scores.of(p_board->game);
  if (!scores.hasFile())
    return done(
        AdminAnswer::refused("This server saves no scores to disk (see its --state option and its log)."));
  const auto answer = [this, done](const auto& rows, const std::string& problem) {
    const AdminAnswer read = problem.empty() ? listOf(rows) : AdminAnswer::refused(problem);
    asio::post(m_access.context.home, [read, done] { done(read); });
  };
  const bool reads = scores.read(which.table, which.count, answer);
  if (!reads) done(AdminAnswer::refused("Busy: too many pending requests. Try again in a moment."));
}

AdminAnswer HostAdmin::set(const std::string& option, const std::optional<std::string>& value) {
  const auto& names = changeableOptions();
  const auto found = std::find_if(names.begin(), names.end(), [&option](const std::string& name) {
    return name == option || formerNameOf("--" + name) == "--" + option;
  });
  if (found == names.end()) {
    const std::string near = nearestName(option, names);
    return AdminAnswer::refused(
        "\"" + option + "\" cannot be changed while the server runs; " +
        (near.empty() ? "\"set\" lists the options that can." : "did you mean \"" + near + "\"?"));
  }
  if (!value) return {true, "", {}, {{*found, hostOptionValue(m_access.context.options, *found)}}, false, {}};
  HostOptions changed = m_access.context.options;
  try {
    setHostOption(changed, *found, *value);
  } catch (const OptionError& error) {
    return AdminAnswer::refused(error.what());
  }
  m_access.controls.applyOptions(changed);
  return AdminAnswer::done(*found + " is " + hostOptionValue(m_access.context.options, *found) + ".");
}

AdminRow HostAdmin::settings() const {
  AdminRow row;
  for (const std::string& name : changeableOptions())
    row.emplace_back(name, hostOptionValue(m_access.context.options, name));
  return row;
}

}  // namespace naiad

#include "host/rooms/Rooms.h"

#include <algorithm>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "host/process/Ending.h"
#include "host/rooms/NewsEvent.h"
#include "host/world/BuildId.h"
#include "host/world/WorldInProcess.h"
#include "naiad.pb.h"
#include "shared/net/base/SafeFile.h"

namespace naiad {

namespace {

constexpr std::uint64_t kShortestRound = 30;  ///< ticks; a shorter one has hardly begun
constexpr int kMaxShortRounds = 5;            ///< in a row
constexpr std::size_t kEndingWorlds = 8;      ///< of players who left, beside one for each player allowed

constexpr const char* kHowToSeeMore =
    "to see where: run the game by itself in a debugger, as docs/when-it-goes-wrong.md says";

/// For the log: which room; empty if it has no name.
std::string inRoom(const Room& room) {
  return room.plan() != nullptr ? " in the room " + room.plan()->name : "";
}

}  // namespace

Rooms::Rooms(const HostOptions& options, const SessionTable& sessions, Counters& counters, LogLine log,
             std::function<void()> on_late_tick, StageClock& stages)
    : m_options(options),
      m_sessions(sessions),
      m_counters(counters),
      m_log(std::move(log)),
      m_on_late_tick(std::move(on_late_tick)),
      m_stages(stages) {
  if (m_options.truth_file.empty()) return;
  requireRegular(m_options.truth_file);
  m_truth.emplace(m_options.truth_file);
  if (!m_truth->isGood())
    throw std::runtime_error("The truth file " + m_options.truth_file + " cannot be written.");
}

void Rooms::open(df::World& world) {
  const bool first_only = m_options.players == "first";
  if (isNamed()) {
    openNamed();
  } else if (!m_new_world) {
    openRoom(std::make_unique<Round>(std::make_unique<WorldInProcess>(world)), first_only);
  } else if (!isPrivate()) {
    openRoom(m_new_world(), first_only);
  }
}

Room& Rooms::openRoom(std::unique_ptr<Round> round, bool first_only) {
  Room& room = *m_rooms.emplace_back(std::make_unique<Room>(std::move(round), first_only, m_stages));
  watchWorld(room);
  return room;
}

void Rooms::watchWorld(Room& room) {
  room.round().setOnTick([this, &room] { endTick(room); });
  room.round().checkProcess(tickNumber());
  passScores(room);
  if (isNamed()) passRooms(room);
}

// Inputs like any other: before all others of its first tick. A round that goes on has had them.
void Rooms::passScores(Room& room) const {
  ScoreKeeper* const p_scores = scoresOf(room);
  if (p_scores == nullptr) return;
  if (room.round().name().id.empty()) room.round().setId(ScoreKeeper::beginRound());
  if (room.round().recovering()) return;  // they are in its journal
  for (const auto& [table, rows] : p_scores->tables()) {
    for (const df::HighScore& row : rows)
      room.round().addInput({.kind = df::InputQueue::kScore,
                             .player = 0,
                             .name = row.name,
                             .table = table,
                             .points = row.points});
  }
}

void Rooms::keepScores(Room& room) {
  const std::vector<df::AddedScore> added = room.round().takeScores();
  const RoundName& round = room.round().name();
  if (ScoreKeeper* const p_scores = scoresOf(room)) p_scores->add(round.id, added, round.file);
}

void Rooms::noteScores() {
  ScoreCounters sum;
  for (ScoreKeeper* const p_scores : m_all_scores) {
    const ScoreCounters counters = p_scores->counters();
    sum.added += counters.added;
    sum.refused += counters.refused;
    sum.written += counters.written;
    sum.dropped += counters.dropped;
    if (const std::string news = p_scores->takeNews(); !news.empty()) m_log(newsEvent(news));
  }
  m_counters.scores = sum.added;
  m_counters.scores_refused = sum.refused;
  m_counters.scores_written = sum.written;
  m_counters.scores_dropped = sum.dropped;
}

void Rooms::finishScores() {
  for (ScoreKeeper* const p_scores : m_all_scores) p_scores->finish();
  noteScores();
}

// ---- players ----------------------------------------------------------------------------------------------

std::size_t Rooms::mostWorlds(const HostOptions& options) {
  return static_cast<std::size_t>(options.max_players) + kEndingWorlds;
}

Room* Rooms::roomForNewPlayer(std::string& problem) {
  if (m_closing || m_upgraded) return nullptr;
  if (!isPrivate()) return m_rooms.front().get();
  if (m_rooms.size() >= mostWorlds(m_options)) {
    problem = "the worlds of those who left have not ended yet";
    return nullptr;
  }
  try {
    return &openRoom(m_new_world(), false);
  } catch (const std::system_error& error) {
    problem = error.what();
    return nullptr;
  }
}

Room* Rooms::roomOf(const Session& session) const {
  const auto found = std::find_if(m_rooms.begin(), m_rooms.end(),
                                  [&session](const auto& room) { return room->has(session); });
  return found != m_rooms.end() ? found->get() : nullptr;
}

Session* Rooms::findPlayer(std::uint32_t player) const {
  for (const auto& room : m_rooms) {
    if (Session* p_session = room->find(player)) return p_session;
  }
  return nullptr;
}

void Rooms::leave(const Session& session) {
  if (Room* p_room = roomOf(session)) {
    isPrivate() ? p_room->round().close() : p_room->leave(session.player());
  }
}

void Rooms::add(Room& room, Session& session) {
  room.add(session);
  m_audit.noteJoin(session, tickNumber());
}

void Rooms::removeSession(const Session& session) {
  m_audit.forget(session);
  if (Room* p_room = roomOf(session)) p_room->remove(session);
}

std::optional<int> Rooms::recovering() const {
  for (const auto& room : m_rooms) {
    if (const auto percent = room->round().recovering()) return percent;
  }
  return std::nullopt;
}

std::size_t Rooms::objects() const {
  std::size_t count = 0;
  for (const auto& room : m_rooms) count += room->objects();
  return count;
}

const std::vector<ListedPlayer>& Rooms::players() {
  m_players.clear();
  for (const auto& room : m_rooms) {
    room->forEachInWorld([this](const Session& session, const df::PlayerFacts& facts) {
      m_players.push_back({session.player(), session.name(),
                           static_cast<df::Color>(session.welcomed().color()), facts.score});
    });
  }
  if (m_rooms.size() > 1)
    std::sort(m_players.begin(), m_players.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  return m_players;
}

// ---- ticks ------------------------------------------------------------------------------------------------

void Rooms::beginTicks() {
  noteScores();
  if (isNamed()) publishRooms();
  m_in_begin = true;
  for (const auto& room : m_rooms) {
    if (room->round().recovering() || room->isAsleep()) continue;
    if (room->beginTick(m_truth.has_value(), m_audit.pictured(tickNumber()))) continue;
    ++m_counters.late_worlds;
    room->noteLate();
  }
  m_in_begin = false;
}

bool Rooms::isTicking() const {
  return std::any_of(m_rooms.begin(), m_rooms.end(), [](const auto& room) { return room->isTicking(); });
}

void Rooms::endTick(Room& room) {
  dismissLeavers(room);
  publish(room);
  keepScores(room);
  if (isNamed()) passSent(room);
  if (!m_in_begin) m_on_late_tick();
}

void Rooms::publish(Room& room) {
  const std::uint64_t sent = room.sounds().sent();
  const std::uint64_t dropped = room.sounds().dropped();
  room.publish(m_truth ? &*m_truth : nullptr);
  m_counters.sounds += room.sounds().sent() - sent;
  m_counters.sounds_dropped += room.sounds().dropped() - dropped;
  if (m_truth && !m_truth->isGood()) {
    m_log("the truth file " + m_options.truth_file + " cannot be written any more; it ends here");
    m_truth.reset();
  }
}

// The game is over for players who pressed the key that ends it; the others play on.
void Rooms::dismissLeavers(Room& room) {
  for (const std::uint32_t leaver : room.round().takeLeavers()) {
    if (hasLastPlayer()) {
      room.round().endGame();
    } else if (Session* p_session = room.find(leaver)) {
      p_session->goodbye("For you, the game is over.");
    }
  }
}

// ---- rounds -----------------------------------------------------------------------------------------------

void Rooms::checkWorlds() {
  if (!hasWorlds()) return;
  for (const auto& room : m_rooms) {
    room->round().checkProcess(tickNumber());
    if (const auto sessions = room->round().takeSessions()) endRecovery(*room, *sessions);
    if (const auto warning = room->round().takeWarning()) {
      m_log({LogEvent::Level::kWarning, *warning});
      room->say("The game takes long over something: everything stands still.");
    }
    if (const auto taken_over = room->round().takeTakeOver()) noteTakeOver(*room, *taken_over);
    const auto end = room->round().end();
    if (end && !(isPrivate() && room->isEmpty())) endRound(*room, *end);
  }
  if (isNamed()) checkSleep();
  if (!isPrivate()) return;
  std::erase_if(m_rooms, [](const auto& room) { return room->isEmpty() && room->round().end(); });
}

void Rooms::noteTakeOver(const Room& room, const TakeOver& done) {
  ++(done.by_copy ? m_counters.taken_over_by_copies : m_counters.taken_over_by_worlds);
  room.say("The game failed, and goes on from where it was.");
}

// The players of a server that was killed may come back now, to a server whose rooms may be others.
void Rooms::endRecovery(Room& room, const std::vector<KeptSession>& sessions) {
  if (m_on_sessions) m_on_sessions(room, sessions);
  if (isNamed()) passRooms(room);
}

void Rooms::countEnd(WorldEnd::Why why) {
  switch (why) {
    case WorldEnd::kGameOver:
      ++m_counters.rounds_over;
      break;
    case WorldEnd::kCrashed:
      ++m_counters.rounds_crashed;
      break;
    case WorldEnd::kHung:
      ++m_counters.rounds_hung;
      break;
    case WorldEnd::kBroken:
      ++m_counters.rounds_broken;
      break;
    case WorldEnd::kNotRecovered:
      ++m_counters.rounds_unrecovered;
      break;
    case WorldEnd::kForeign:  // it has not begun
      break;
  }
}

// Its players come back to the server once that has begun again, or are told that it has to.
void Rooms::noteUpgrade(const Room& room, const WorldEnd& end) {
  if (!std::exchange(m_upgraded, true)) {
    m_upgrade_news = "this server's program was upgraded while it runs: a new world " + end.text +
                     ", the server of " + ownBuildId().substr(0, kShownBuildId);
  }
  if (isPrivate())
    room.dismiss("The server was upgraded. It begins again when those who play have left.",
                 Ending::kLookAgain);
}

// No further round for a player alone in the game's own terminal. Nor for a game that ends again and again as
// soon as it begins: it would do so for ever.
void Rooms::endRound(Room& room, const WorldEnd& end) {
  if (end.why == WorldEnd::kForeign) return noteUpgrade(room, end);
  m_log("the round is over" + inRoom(room) + ": the game " + end.text +
        (end.when.empty() ? "" : " " + end.when));
  for (const std::string& line : end.last_lines) m_log("the game's log: " + line);
  if (end.why == WorldEnd::kCrashed) m_log(kHowToSeeMore);
  countEnd(end.why);
  // What this server was started for is the next round.
  if (end.why == WorldEnd::kNotRecovered && beginRound(room))
    return room.say("The round could not go on; the next one begins.");
  const bool is_short = room.ticks() < kShortestRound;
  const int short_rounds = room.countShortRounds(is_short);
  const bool hopeless = short_rounds >= kMaxShortRounds || (is_short && m_counters.joined == 0);
  const bool failed = end.why != WorldEnd::kGameOver;
  const std::string how = failed ? "The game " + end.text : "The round is over";
  if (m_options.on_game_over == "restart" && !hasLastPlayer() && !hopeless && !m_last_round &&
      beginRound(room)) {
    return room.say(how + (failed ? "; the next round begins." : "; the next one begins."));
  }
  const std::string sentence = failed ? how + "." : "The game is over.";
  if (isPrivate()) return room.dismiss(sentence);
  if (isNamed()) return closeRoom(room, sentence);
  m_failure = failed ? end.text : std::string();
  m_last_sentence = sentence;
  m_over = true;
}

bool Rooms::beginRound(Room& room) {
  const std::uint64_t sent = room.sounds().sent();
  m_audit.noteRound(room, tickNumber());
  try {
    room.changeRound(newRound(room));
  } catch (const std::system_error& error) {
    m_log(std::string("there is no next round: ") + error.what());
    return false;
  }
  m_counters.sounds += room.sounds().sent() - sent;
  watchWorld(room);
  if (m_on_round) m_on_round(room);
  return true;
}

// ---- the end ----------------------------------------------------------------------------------------------

bool Rooms::isOver() const {
  return hasWorlds() ? m_over : m_rooms.front()->round().isGameOver();
}

void Rooms::closeWorlds() {
  m_closing = true;
  for (const auto& room : m_rooms) {
    room->round().close();
    room->round().checkProcess(tickNumber());
  }
  std::erase_if(m_rooms,
                [this](const auto& room) { return !hasWorlds() || room->isAsleep() || room->round().end(); });
  checkEnding();
}

}  // namespace naiad

#include "host/rooms/RoomManager.h"

#include <algorithm>
#include <cstdio>
#include <random>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "engine/world/InputQueue.h"
#include "engine/world/World.h"
#include "engine/world/WorldExtras.h"
#include "host/process/ShutdownScheduler.h"
#include "host/rooms/HostContext.h"
#include "host/rooms/Room.h"
#include "host/world/BuildId.h"
#include "host/world/WorldInProcess.h"
#include "naiad.pb.h"
#include "shared/net/base/SafeFile.h"
#include "shared/program/ProcessSetup.h"

namespace naiad {

namespace {

constexpr std::uint64_t kMinRoundTicks = 30;  ///< in ticks; a shorter round counts as failed at its start
constexpr int kMaxShortRounds = 5;            ///< consecutive short rounds, after which no further one begins
constexpr std::size_t kEndingWorlds = 8;      ///< ending worlds of former players, allowed above max_players

constexpr const char* kHowToSeeMore =
    "to see where: run the game by itself in a debugger, as docs/when-it-goes-wrong.md says";

/// Counters of ended rounds; index: WorldEnd::Why. kForeign has none: its round has not begun.
constexpr std::uint64_t Counters::*kEnds[] = {&Counters::rounds_over, &Counters::rounds_crashed,
                                              &Counters::rounds_hung, &Counters::rounds_broken,
                                              &Counters::rounds_unrecovered};

/// Returns a unique id for a round: 128 random bits in hexadecimal.
std::string newRoundId() {
  std::random_device random;
  std::string name;
  for (int i = 0; i < 4; ++i) {
    char part[9];
    std::snprintf(part, sizeof part, "%08x", static_cast<unsigned>(random()));
    name += part;
  }
  return name;
}

/// Returns " in the room NAME" for the log, or "" if the room has no name.
std::string inRoom(const Room& room) {
  return room.plan() != nullptr ? " in the room " + room.plan()->name : "";
}

}  // namespace

void AuditScheduler::onJoin(Session& session, std::uint32_t tick) {
  if (m_ticks_per_second == 0) return;
  if (m_p_session == nullptr || tick - m_since >= kPeriod * m_ticks_per_second) assign(session, tick);
}

void AuditScheduler::onRound(const Room& room, std::uint32_t tick) {
  if (m_ticks_per_second == 0) return;
  if (m_p_session != nullptr && !room.has(*m_p_session)) return;  // the audited player is in another room
  Session* p_first = nullptr;
  Session* p_next = nullptr;
  room.forEachPlaying([&](Session& session) {
    if (p_first == nullptr) p_first = &session;
    if (p_next == nullptr && session.player() > m_last) p_next = &session;
  });
  if (p_next == nullptr) p_next = p_first;
  if (p_next != nullptr) assign(*p_next, tick);
}

void AuditScheduler::forget(const Session& session) {
  if (m_p_session == &session) m_p_session = nullptr;
}

// Seconds are counted from the start of the player's audit, so players with a short visit are audited, too.
std::uint32_t AuditScheduler::auditedPlayer(std::uint32_t tick) const {
  if (m_p_session == nullptr) return 0;
  return (tick - m_since) / m_ticks_per_second % kPeriod == 0 ? m_p_session->player() : 0;
}

void AuditScheduler::assign(Session& session, std::uint32_t tick) {
  if (m_p_session != nullptr) m_p_session->setAudit(false);
  session.setAudit(true);
  m_p_session = &session;
  m_since = tick;
  m_last = session.player();
}

RoomManager::RoomManager(HostContext& context, const SessionTable& sessions,
                         std::function<void()> on_late_tick)
    : m_context(context),
      m_options(context.options),
      m_sessions(sessions),
      m_counters(context.counters),
      m_log(context.log),
      m_on_late_tick(std::move(on_late_tick)),
      m_stages(context.stages) {
  if (m_options.truth_file.empty()) return;
  requireRegular(m_options.truth_file);
  m_truth.emplace(m_options.truth_file);
  if (!m_truth->isGood())
    throw std::runtime_error("The truth file " + m_options.truth_file + " cannot be written.");
}

void RoomManager::open(df::World& world) {
  const bool first_only = m_options.players == "first";
  m_p_world = &world;
  if (isNamed()) {
    openNamed();
  } else if (!m_new_world) {
    openRoom(std::make_unique<Round>(std::make_unique<WorldInProcess>(world), world.input().newestPlayer()),
             first_only);
  } else if (!isPrivate()) {
    openRoom(m_new_world(m_context.home), first_only);
  }
}

Room& RoomManager::openRoom(std::unique_ptr<Round> round, bool first_only) {
  Room& room = *m_rooms.emplace_back(std::make_unique<Room>(std::move(round), first_only, m_stages));
  setWorldCallbacks(room);
  return room;
}

void RoomManager::setWorldCallbacks(Room& room) {
  room.round().setOnTick([this, &room] { endTick(room); });
  room.round().checkProcess(tickNumber());
  sendScores(room);
  if (isNamed()) sendRoomList(room);
}

// Scores are ordinary inputs, before all others of the first tick. A resumed round has had them already.
void RoomManager::sendScores(Room& room) const {
  if (room.round().name().id.empty()) room.round().setId(newRoundId());
  if (m_p_scores == nullptr || room.round().recovering()) return;  // its journal has the scores
  for (const auto& [table, rows] : m_p_scores->tables(gameOf(room))) {
    for (const df::HighScore& row : rows)
      room.round().addInput({.kind = df::InputQueue::kScore,
                             .player = 0,
                             .name = row.name,
                             .table = table,
                             .points = row.points});
  }
}

const std::string& RoomManager::gameOf(const Room& room) const {
  return room.plan() != nullptr ? room.plan()->game : m_context.game;
}

// ---- players ----------------------------------------------------------------------------------------------

std::size_t RoomManager::maxWorlds(const HostOptions& options) {
  return static_cast<std::size_t>(options.max_players) + kEndingWorlds;
}

Room* RoomManager::roomForNewPlayer(std::string& problem) {
  if (m_closing || m_upgraded) return nullptr;
  if (!isPrivate()) return m_rooms.front().get();
  if (m_rooms.size() >= maxWorlds(m_options)) {
    problem = "the worlds of former players are still ending";
    return nullptr;
  }
  try {
    return &openRoom(m_new_world(m_context.home), false);
  } catch (const std::system_error& error) {
    problem = errorText(error);
    return nullptr;
  }
}

Room* RoomManager::roomOf(const Session& session) const {
  const auto found = std::find_if(m_rooms.begin(), m_rooms.end(),
                                  [&session](const auto& room) { return room->has(session); });
  return found != m_rooms.end() ? found->get() : nullptr;
}

Session* RoomManager::findPlayer(std::uint32_t player) const {
  for (const auto& room : m_rooms) {
    if (Session* p_session = room->find(player)) return p_session;
  }
  return nullptr;
}

void RoomManager::leave(const Session& session) {
  if (Room* p_room = roomOf(session)) {
    isPrivate() ? p_room->round().close() : p_room->leave(session.player());
  }
}

void RoomManager::add(Room& room, Session& session) {
  room.add(session);
  m_audit.onJoin(session, tickNumber());
}

void RoomManager::removeSession(const Session& session) {
  m_audit.forget(session);
  if (Room* p_room = roomOf(session)) p_room->remove(session);
}

std::optional<int> RoomManager::recovering() const {
  for (const auto& room : m_rooms) {
    if (const auto percent = room->round().recovering()) return percent;
  }
  return std::nullopt;
}

std::size_t RoomManager::objects() const {
  std::size_t count = 0;
  for (const auto& room : m_rooms) count += room->objects();
  return count;
}

const std::vector<ListedPlayer>& RoomManager::players() {
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

void RoomManager::beginTicks() {
  if (isNamed()) publishRooms();
  m_in_begin = true;
  for (const auto& room : m_rooms) {
    if (room->isPaused()) continue;
    if (room->beginTick(m_truth.has_value(), m_audit.auditedPlayer(tickNumber()))) continue;
    ++m_counters.world_missed_ticks;
    room->countLateTick();
  }
  m_in_begin = false;
}

bool RoomManager::rest() const {
  return m_ending.empty() && std::all_of(m_rooms.begin(), m_rooms.end(), [](const auto& room) {
           return (room->isAsleep() || room->sleep().still) && !room->isTicking() &&
                  !room->round().recovering();
         });
}

bool RoomManager::isTicking() const {
  return std::any_of(m_rooms.begin(), m_rooms.end(), [](const auto& room) { return room->isTicking(); });
}

void RoomManager::endTick(Room& room) {
  dismissLeavers(room);
  publish(room);
  const std::vector<df::AddedScore> added = room.round().popScores();
  if (m_p_scores != nullptr) m_p_scores->add(gameOf(room), room.round().name(), added);
  if (isNamed()) forwardTransfers(room);
  if (!m_in_begin) m_on_late_tick();
}

void RoomManager::publish(Room& room) {
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

// Says goodbye to players that pressed the key to end the game; the others continue to play. With
// setEndsWithLast(), the last connected player ends the game instead.
void RoomManager::dismissLeavers(Room& room) {
  for (const std::uint32_t leaver : room.round().popLeavers()) {
    if (hasLastPlayer()) {
      room.round().endGame();
    } else if (Session* p_session = room.find(leaver)) {
      p_session->sendGoodbye("The game is over for you.");
    }
  }
}

// ---- rounds -----------------------------------------------------------------------------------------------

void RoomManager::checkWorlds(Time now) {
  checkPlayers(now);
  if (!hasWorlds()) return;
  for (const auto& room : m_rooms) {
    room->round().checkProcess(tickNumber());
    if (const auto sessions = room->round().popSessions()) endRecovery(*room, *sessions);
    if (const auto warning = room->round().popWarning()) {
      m_log({LogEvent::Level::kWarning, *warning});
      room->broadcast("The game is not responding. Please wait.");
    }
    if (const auto taken_over = room->round().popFailover()) onFailover(*room, *taken_over);
    const auto end = room->round().end();
    if (end && !(isPrivate() && room->isEmpty())) endRound(*room, *end);
  }
  if (isNamed()) checkSleep(now);
  if (!isPrivate()) return;
  std::erase_if(m_rooms, [](const auto& room) { return room->isEmpty() && room->round().end(); });
}

// True if a room's world ticks without players: with --ticks, in the last round, or at the game's request.
bool RoomManager::runsEmpty(const Room& room) const {
  if (m_options.ticks > 0 || m_last_round) return true;
  if (room.plan() != nullptr) return room.plan()->ready.runs_empty;
  const df::WorldExtras* const p_extras = m_p_world->findExtras();
  return p_extras != nullptr && p_extras->settings.runs_empty;
}

void RoomManager::checkPlayers(Time now) {
  for (const auto& room : m_rooms) {
    RoomSleepState& sleep = room->sleep();
    if (!room->isEmpty()) {
      sleep.empty_since.reset();
    } else if (!sleep.empty_since) {
      sleep.empty_since = now;
    }
    const bool was_still = sleep.still;
    sleep.still = sleep.empty_since && now - *sleep.empty_since >= kEmptyTime && !runsEmpty(*room);
    if (!was_still && sleep.still) room->round().dropCheckpoints();
    if (was_still && !sleep.still && isNamed()) sendRoomList(*room);
  }
}

void RoomManager::onFailover(const Room& room, const Failover& done) {
  ++(done.by_checkpoint ? m_counters.failovers_by_checkpoint : m_counters.failovers_by_replay);
  room.broadcast("The game failed and was restored.");
}

// After the replay of a killed server's round, its players may reconnect. The room list may have changed.
void RoomManager::endRecovery(Room& room, const std::vector<PersistedSession>& sessions) {
  room.addTicks(room.round().ticks());
  if (m_on_sessions) m_on_sessions(room, sessions);
  if (isNamed()) sendRoomList(room);
}

// Stores the message about the upgrade. With private worlds it also disconnects the room's players, whose
// clients reconnect after the restart.
void RoomManager::onUpgrade(const Room& room, const WorldEnd& end) {
  if (!std::exchange(m_upgraded, true)) {
    m_upgrade_message = "this server's program was upgraded while it runs: a new game process " + end.text +
                        ", this server has " + ownBuildId().substr(0, kShownBuildId);
  }
  if (isPrivate())
    room.disconnectAll("The server was upgraded. It restarts when all players have left.",
                       ShutdownScheduler::kReconnectWindow);
}

// No further round begins for a player alone in the game's own terminal, nor for a game that keeps ending at
// its start, because that would continue without end.
void RoomManager::endRound(Room& room, const WorldEnd& end) {
  if (end.why == WorldEnd::kForeign) return onUpgrade(room, end);
  m_log("the round is over" + inRoom(room) + ": the game " + end.text +
        (end.when.empty() ? "" : " " + end.when));
  for (const std::string& line : end.last_lines) m_log("the game's log: " + line);
  if (end.why == WorldEnd::kCrashed) m_log(kHowToSeeMore);
  ++(m_counters.*kEnds[end.why]);
  // If the old round cannot be recovered, the server starts with the next one.
  if (end.why == WorldEnd::kNotRecovered && beginRound(room))
    return room.broadcast("The round could not be recovered; a new one begins.");
  const bool is_short = room.ticks() < kMinRoundTicks;
  const int short_rounds = room.countShortRounds(is_short);
  const bool hopeless = short_rounds >= kMaxShortRounds || (is_short && m_counters.joined == 0);
  const bool failed = end.why != WorldEnd::kGameOver;
  const std::string how = failed ? "The game " + end.text : "The round is over";
  if (m_options.on_game_over == "restart" && !hasLastPlayer() && !hopeless && !m_last_round &&
      beginRound(room)) {
    return room.broadcast(how + (failed ? "; the next round begins." : "; the next one begins."));
  }
  const std::string sentence = failed ? how + "." : "The game is over.";
  if (isPrivate()) return room.disconnectAll(sentence);
  if (isNamed()) return closeRoom(room, sentence);
  m_failure = failed ? end.text : std::string();
  m_last_sentence = sentence;
  m_over = true;
}

void RoomManager::restart() {
  Room& room = *m_rooms.front();
  room.forEachPlaying([&room](const Session& session) { room.leave(session.player()); });
  room.round().close();
  beginRound(room);
}

bool RoomManager::beginRound(Room& room) {
  const std::uint64_t sent = room.sounds().sent();
  m_audit.onRound(room, tickNumber());
  try {
    room.changeRound(newRound(room));
  } catch (const std::system_error& error) {
    m_log("cannot start the next round" + (isNamed() ? " in the room " + room.plan()->name : "") + ": " +
          errorText(error));
    return false;
  }
  m_counters.sounds += room.sounds().sent() - sent;
  setWorldCallbacks(room);
  if (m_on_round) m_on_round(room);
  return true;
}

// ---- the end ----------------------------------------------------------------------------------------------

bool RoomManager::isOver() const {
  return hasWorlds() ? m_over : m_rooms.front()->round().isGameOver();
}

void RoomManager::closeWorlds() {
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

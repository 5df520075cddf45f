// Named rooms: opening them, sleep and wake-up, and closing a room whose game cannot continue.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <system_error>
#include <utility>

#include "engine/world/InputQueue.h"
#include "engine/world/World.h"
#include "host/rooms/RoomManager.h"
#include "host/world/WorldInProcess.h"
#include "host/world/WorldPort.h"
#include "shared/program/ProcessSetup.h"

namespace naiad {

namespace {

/// Null object for a room without a world. It runs no ticks.
class NullWorld : public WorldPort {
 public:
  bool isReady() const override { return false; }
  void tick(const SentTurn& /*turn*/) override {}
  std::uint32_t nextTick() const override { return m_next_tick; }
  const df::WorldView& view() const override { return m_view; }
  void checkProcess(std::uint32_t tick) override { m_next_tick = std::max(tick, 1u); }

 private:
  std::uint32_t m_next_tick = 1;
  df::WorldView m_view;
};

/// Time that a room stays closed after its game has ended and no next round began.
constexpr std::chrono::seconds kClosedTime{30};

constexpr std::uint32_t kRoomListInterval = 15;  ///< ticks between updates of the room list that games see

df::GameRoom gameRoomOf(const Room& room) {
  return {.name = room.plan()->name,
          .game = room.plan()->game.substr(0, df::GameRoomLimits::kMaxGame),
          .players = static_cast<int>(room.countPlaying()),
          .max_players = room.plan()->max_players,
          .is_asleep = room.isAsleep()};
}

std::unique_ptr<Round> sleepingRound() {
  return std::make_unique<Round>(std::make_unique<NullWorld>());
}

RoomSleepState::Time presentTime() {
  return std::chrono::steady_clock::now();
}

}  // namespace

void RoomManager::openNamed() {
  for (const RoomConfig& plan : m_plans) {
    Room& room = *m_rooms.emplace_back(std::make_unique<Room>(sleepingRound(), plan.first_only, m_stages));
    room.setPlan(plan);
    room.sleep().asleep = true;
    room.round().checkProcess(tickNumber());
    m_game_rooms.push_back(gameRoomOf(room));
  }
  for (const auto& room : m_rooms) {
    std::string problem;
    const bool begins = room == m_rooms.front() || room->plan()->resumes_round;
    if (begins && !wake(*room, problem))
      m_log("the room " + room->plan()->name + " cannot be started: " + problem);
  }
}

Room* RoomManager::findRoom(const std::string& name) const {
  const auto found = std::find_if(m_rooms.begin(), m_rooms.end(), [&name](const auto& room) {
    return room->plan() != nullptr && room->plan()->name == name;
  });
  return found != m_rooms.end() ? found->get() : nullptr;
}

std::size_t RoomManager::countAwake() const {
  return static_cast<std::size_t>(
      std::count_if(m_rooms.begin(), m_rooms.end(), [](const auto& room) { return !room->isAsleep(); }));
}

std::vector<std::string> RoomManager::roomNames() const {
  std::vector<std::string> names;
  for (const RoomConfig& plan : m_plans) names.push_back(plan.name);
  return names;
}

std::unique_ptr<Round> RoomManager::newRound(const Room& room) const {
  if (!hasWorlds())
    return std::make_unique<Round>(std::make_unique<WorldInProcess>(*m_p_world),
                                   m_p_world->input().newestPlayer());
  return room.plan() != nullptr ? room.plan()->new_world(m_context.home) : m_new_world(m_context.home);
}

bool RoomManager::wake(Room& room, std::string& problem) {
  if (!room.isAsleep()) return true;
  if (m_closing || m_upgraded) return false;
  try {
    room.changeRound(newRound(room));
  } catch (const std::system_error& error) {
    problem = errorText(error);
    return false;
  }
  room.sleep() = {};
  setWorldCallbacks(room);
  return true;
}

void RoomManager::leaveRoom(const Session& session) {
  if (Room* const p_room = roomOf(session)) p_room->stopSounds(session);
  leave(session);
  removeSession(session);
}

// ---- the room list that games see -------------------------------------------------------------------------

void RoomManager::sendRoomList(Room& room) const {
  if (room.round().recovering())
    return;  // the journal has the original inputs; endRecovery() adds today's room list after them
  for (std::size_t i = 0; i < m_game_rooms.size(); ++i) {
    df::GameRoom known = m_game_rooms[i];
    known.is_this_one = m_rooms[i].get() == &room;
    room.round().addInput({.kind = df::InputQueue::kRoom, .player = 0, .room = std::move(known)});
  }
}

// Sends changes only, to all worlds that tick. A delay of half a second does not matter for the list.
void RoomManager::publishRooms() {
  if (tickNumber() % kRoomListInterval != 0) return;
  m_game_rooms.resize(m_rooms.size());
  for (std::size_t i = 0; i < m_rooms.size(); ++i) {
    df::GameRoom present = gameRoomOf(*m_rooms[i]);
    if (present == m_game_rooms[i]) continue;
    m_game_rooms[i] = present;
    for (const auto& room : m_rooms) {
      if (room->isPaused()) continue;
      present.is_this_one = room == m_rooms[i];
      room->round().addInput({.kind = df::InputQueue::kRoom, .player = 0, .room = present});
    }
  }
}

// A world may be an untrusted program, so it can send only its own players to other rooms.
void RoomManager::forwardTransfers(Room& room) {
  for (const df::RoomTransfer& sent : room.round().popSent()) {
    Session* const p_session = room.find(sent.player);
    if (p_session != nullptr && m_on_sent) m_on_sent(*p_session, sent.room);
  }
}

// ---- sleep ------------------------------------------------------------------------------------------------

// Ending a world takes time, but the room does not wait for it.
void RoomManager::putToSleep(Room& room) {
  auto round = room.changeRound(sleepingRound());
  room.round().checkProcess(tickNumber());
  round->setOnTick({});
  round->close();
  m_ending.push_back(std::move(round));
  room.sleep() = {.asleep = true, .empty_since = {}};
  room.countShortRounds(false);
}

void RoomManager::checkSleep(Time now) {
  const std::chrono::duration<double> patience(m_options.room_sleep);
  for (const auto& room : m_rooms) {
    const RoomSleepState& sleep = room->sleep();
    if (sleep.asleep || !sleep.empty_since || room->round().recovering()) continue;
    if (now - *sleep.empty_since >= patience) putToSleep(*room);
  }
  checkEnding();
}

void RoomManager::checkEnding() {
  for (const auto& round : m_ending) round->checkProcess(tickNumber());
  std::erase_if(m_ending, [](const auto& round) { return round->end().has_value(); });
}

// The other rooms continue. The players of this one are moved to another room in the next tick.
void RoomManager::closeRoom(Room& room, const std::string& sentence) {
  m_log("the room " + room.plan()->name + " is closed for " + std::to_string(kClosedTime.count()) +
        " s: " + sentence);
  putToSleep(room);
  room.sleep().closed_until = presentTime() + kClosedTime;
  if (m_on_closed) m_on_closed(room, sentence);
}

}  // namespace naiad

// Which worlds there are, and what becomes of one that ends (docs/rounds.md).
#include <algorithm>
#include <system_error>

#include "host/program/Host.h"

namespace naiad {

namespace {

constexpr std::uint64_t kShortestRound = 30;  ///< ticks; one that ends sooner hardly began
constexpr int kMaxShortRounds = 5;            ///< in a row

}  // namespace

Room& Host::openRoom(std::unique_ptr<WorldPort> port) {
  Room& room = *m_rooms.emplace_back(std::make_unique<Room>(std::move(port), m_options.players == "first"));
  room.port().setOnTick([this, &room] { afterTick(room); });
  room.port().look(tickNumber());
  return room;
}

// Null: there can be no world for him.
Room* Host::roomForNewcomer() {
  if (!isPrivate()) return m_rooms.front().get();
  try {
    return &openRoom(m_new_world(m_io));
  } catch (const std::system_error& error) {
    m_log(std::string("no world for another player: ") + error.what());
    return nullptr;
  }
}

// Null for those who do not play.
Room* Host::roomOf(const Session& session) const {
  const auto found = std::find_if(m_rooms.begin(), m_rooms.end(),
                                  [&session](const auto& room) { return room->has(session); });
  return found != m_rooms.end() ? found->get() : nullptr;
}

void Host::lookAfterWorlds() {
  for (const auto& room : m_rooms) {
    room->port().look(tickNumber());
    const auto end = room->port().end();
    if (end && !(isPrivate() && room->isEmpty())) endRound(*room, *end);
  }
  if (!isPrivate()) return;
  std::erase_if(m_rooms, [](const auto& room) { return room->isEmpty() && room->port().end(); });
}

// Not for the player in the game's own terminal alone. And a game that is over at once would be over at once
// for ever.
void Host::endRound(Room& room, const WorldEnd& end) {
  m_log("the round is over: the game " + end.text);
  const bool alone = m_ends_with_last && connected() <= 1;
  const bool is_short = room.ticks() < kShortestRound;
  const int short_rounds = room.countShortRounds(is_short);
  const bool hopeless = short_rounds >= kMaxShortRounds || (is_short && !m_ever_joined);
  const bool failed = end.why != WorldEnd::kGameOver;
  const std::string how = failed ? "The game " + end.text : "The round is over";
  if (m_options.on_game_over == "restart" && !alone && !hopeless && beginRound(room)) {
    return room.say(how + (failed ? "; the next round begins." : "; the next one begins."));
  }
  const std::string sentence = failed ? how + "." : "The game is over.";
  if (isPrivate()) return room.dismiss(sentence);
  m_failure = failed ? end.text : std::string();
  m_stop_sentence = sentence;
  m_worlds_over = true;
}

bool Host::beginRound(Room& room) {
  const std::uint64_t told = room.sounds().told();
  try {
    room.changeWorld(m_new_world(m_io));
  } catch (const std::system_error& error) {
    m_log(std::string("there is no next round: ") + error.what());
    return false;
  }
  m_counters.sounds += room.sounds().told() - told;
  room.port().setOnTick([this, &room] { afterTick(room); });
  room.port().look(tickNumber());
  return true;
}

// Those of other processes take their time; the one of this process needs none.
void Host::closeWorlds() {
  for (const auto& room : m_rooms) {
    room->port().close();
    room->port().look(tickNumber());
  }
  std::erase_if(m_rooms, [this](const auto& room) { return !m_new_world || room->port().end(); });
}

}  // namespace naiad

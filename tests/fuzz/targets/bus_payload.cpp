// Payloads from the bus and from a sidecar: each is rejected or has values in range, and a valid one is equal
// after being written and read again.
//
//   input   0 a presence, 1 a result or redirected players, 2 the sidecar's answer, 3 a line of its watch,
//           4 messages to a directory, each a line "SUBJECT PAYLOAD" (1) | the text
#include <algorithm>
#include <chrono>
#include <string>
#include <string_view>

#include "Target.h"
#include "host/fleet/GameServerInfo.h"
#include "server/directory/FleetRegistry.h"
#include "shared/fleet/BusPayloads.h"
#include "shared/net/base/SafeText.h"

namespace naiad::fuzz {
namespace {

void requirePresence(const std::string& text) {
  const auto presence = Presence::parse(text);
  if (!presence) return;
  REQUIRE(text.size() <= kMaxBusPayload);
  REQUIRE(isServerId(presence->id) && presence->port != 0);
  REQUIRE(safeText(presence->name, Presence::kMaxName) == presence->name);
  REQUIRE(safeText(presence->game, Presence::kMaxName) == presence->game);
  REQUIRE(presence->key.empty() || presence->key.size() == 64);
  REQUIRE(presence->host.empty() || presence->host.front() != '-');
  REQUIRE(presence->players <= 1'000'000 && presence->max_players <= 1'000'000);
  REQUIRE(presence->rooms.size() <= kMaxRooms);
  for (const PresenceRoom& room : presence->rooms) {
    REQUIRE(isRoomName(room.name) && !room.game.empty() && room.game.size() <= PresenceRoom::kMaxGame);
    REQUIRE(room.players <= 1'000'000 && room.max_players <= 1'000'000);
  }
  REQUIRE(Presence::parse(presence->payload()) == presence);
}

void requireResult(const std::string& text) {
  const auto result = GameResult::parse(text);
  if (!result) return;
  REQUIRE(text.size() <= kMaxBusPayload);
  REQUIRE(isServerId(result->server) && result->round.size() == 32 && result->number < 256);
  REQUIRE(!result->name.empty() && safeText(result->name, 16) == result->name);
  REQUIRE(result->points >= -1'000'000'000'000'000 && result->points <= 1'000'000'000'000'000);
  REQUIRE(!result->table.empty() && result->table.size() <= 32);
  REQUIRE(GameResult::parse(result->payload()) == result);
}

void requireRedirect(const std::string& text) {
  const auto send_on = Redirect::parse(text);
  if (!send_on) return;
  REQUIRE(isServerId(send_on->to));
  const auto again = Redirect::parse(send_on->payload());
  REQUIRE(again && again->to == send_on->to && again->link == send_on->link);
}

void requireFacts(const std::string& text, bool is_line) {
  const auto facts = GameServerInfo::parse(text, is_line);
  if (!facts) return;
  REQUIRE(facts->health_seconds >= 0 && facts->health_seconds <= 3600);
  for (const std::string* p_text : {&facts->name, &facts->state, &facts->address}) {
    REQUIRE(p_text->size() <= 253);
    REQUIRE(std::ranges::all_of(*p_text, [](char c) { return c > ' ' && c <= '~'; }));
  }
}

/// Requires that the assigned room is one of the server's own and has space for a player.
void requirePlace(const FleetRegistry::Assignment& place) {
  REQUIRE(place.room.empty() == place.p_server->rooms.empty());
  if (place.room.empty()) return;
  REQUIRE(std::ranges::any_of(place.p_server->rooms, [&](const PresenceRoom& room) {
    return room.name == place.room && room.players < room.max_players;
  }));
  REQUIRE(isRoomName(place.room));
}

/// Requires, whatever servers claim, that all listed ones have sent a presence, and that players are sent
/// only to servers where they can play.
void requireList(FleetRegistry& list) {
  for (const Presence& one : list.servers()) REQUIRE(Presence::parse(one.payload()) == one);
  const std::string text = serverListText(list.servers());
  REQUIRE(std::ranges::all_of(text, [](char c) { return c == '\n' || (c >= ' ' && c <= '~'); }));
  for (int i = 0; i < 3; ++i) {
    const FleetRegistry::Assignment place = list.choose({"", 4});
    const Presence* const p_chosen = place.p_server;
    if (p_chosen == nullptr) break;
    requirePlace(place);
    REQUIRE(p_chosen->is_open && !p_chosen->requires_password && p_chosen->players < p_chosen->max_players);
    REQUIRE(p_chosen->port >= kMinFleetPort && p_chosen->protocol == 4 && !linkOf(*p_chosen).empty());
  }
}

void requireDirectory(std::string_view text) {
  FleetRegistry list;
  FleetRegistry::Time now{};
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    const std::size_t blank = std::min(line.find(' '), line.size());
    const std::string subject(line.substr(0, blank));
    const std::size_t before = list.size();
    const bool is_new = list.handleHeartbeat(subject, line.substr(std::min(blank + 1, line.size())), now);
    REQUIRE(list.size() == before + (is_new ? 1 : 0));
    if (is_new)
      REQUIRE(std::ranges::any_of(list.servers(),
                                  [&](const Presence& one) { return presenceSubject(one.id) == subject; }));
    now += std::chrono::seconds(1);
    const std::size_t there = list.size();
    REQUIRE(list.removeExpired(now).size() == there - list.size());
  }
  REQUIRE(list.size() <= 6);
  requireList(list);
}

}  // namespace

void tryInput(Script script) {
  if (script.atEnd()) return;
  const std::size_t what = script.below(5);
  const std::string text = script.rest();
  switch (what) {
    case 0:
      requirePresence(text);
      break;
    case 1:
      requireResult(text);
      requireRedirect(text);
      REQUIRE(isServerId(serverIdOf(text)));
      break;
    case 4:
      requireDirectory(text);
      break;
    default:
      requireFacts(text, what == 3);
  }
}

}  // namespace naiad::fuzz

#include "host/rooms/PlayerListBroadcaster.h"

#include <algorithm>

#include "naiad.pb.h"
#include "shared/net/base/Limits.h"

namespace naiad {

namespace {

void addEntry(wire::ServerMessage& message, const ListedPlayer& player,
              const PlayerListBroadcaster::RoundTrip& round_trip) {
  wire::PlayerEntry& entry = *message.mutable_players()->add_players();
  entry.set_player(player.id);
  entry.set_name(player.name);
  entry.set_color(static_cast<std::uint32_t>(player.color));
  entry.set_score(player.score);
  if (const std::uint32_t millis = round_trip(player.id); millis > 0) entry.set_rtt_millis(millis);
}

}  // namespace

PlayerListBroadcaster::PlayerListBroadcaster() : m_best(std::make_unique<wire::ServerMessage>()) {}

PlayerListBroadcaster::~PlayerListBroadcaster() = default;

void PlayerListBroadcaster::tick(std::uint32_t tick, const std::vector<ListedPlayer>& players,
                                 const RoundTrip& round_trip, const Send& send) {
  if (players.size() > kMaxPlayers) return sendToSome(tick, players, round_trip, send);
  if (tick % kInterval == 0) sendToAll(players, round_trip, send);
}

void PlayerListBroadcaster::sendToAll(const std::vector<ListedPlayer>& players, const RoundTrip& round_trip,
                                      const Send& send) {
  wire::ServerMessage message;
  message.mutable_players();
  for (const ListedPlayer& player : players) addEntry(message, player, round_trip);
  while (message.ByteSizeLong() > kMaxServerFrame) message.mutable_players()->mutable_players()->RemoveLast();
  std::string bytes = message.SerializeAsString();
  if (bytes == m_sent) return;
  m_sent = std::move(bytes);
  for (const ListedPlayer& player : players) send(player.id, message);
}

// Each tick sends the list to a different share of the players, so that no tick sends it to all of them.
void PlayerListBroadcaster::sendToSome(std::uint32_t tick, const std::vector<ListedPlayer>& players,
                                       const RoundTrip& round_trip, const Send& send) {
  m_sent.clear();
  if (tick % kInterval == 0 || m_best->players().players().empty()) findBest(players, round_trip);
  for (const ListedPlayer& player : players) {
    if ((tick + player.id) % kCrowdInterval != 0) continue;
    const auto& best = m_best->players().players();
    const bool among = std::any_of(best.begin(), best.end(), [&](const wire::PlayerEntry& entry) {
      return entry.player() == player.id;
    });
    if (!among) addEntry(*m_best, player, round_trip);
    send(player.id, *m_best);
    if (!among) m_best->mutable_players()->mutable_players()->RemoveLast();
  }
}

void PlayerListBroadcaster::findBest(const std::vector<ListedPlayer>& players, const RoundTrip& round_trip) {
  std::vector<const ListedPlayer*> best;
  best.reserve(players.size());
  for (const ListedPlayer& player : players) best.push_back(&player);
  const auto middle = best.begin() + kCrowdEntries;
  std::partial_sort(best.begin(), middle, best.end(), [](const auto* a, const auto* b) {
    return a->score != b->score ? a->score > b->score : a->id < b->id;
  });
  best.erase(middle, best.end());
  m_best->Clear();
  for (const ListedPlayer* player : best) addEntry(*m_best, *player, round_trip);
}

}  // namespace naiad

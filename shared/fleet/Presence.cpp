#include "shared/fleet/Presence.h"

#include "shared/fleet/BusFields.h"
#include "shared/fleet/ServerId.h"
#include "shared/json/Json.h"
#include "shared/net/stream/Fingerprint.h"
#include "shared/net/stream/JoinLink.h"

namespace naiad {

namespace {

constexpr std::int64_t kPresenceFormat = 1;
constexpr std::size_t kMaxHost = 255;
constexpr std::int64_t kMaxCounted = 1'000'000;

/// Brackets are for links; here an IPv6 address is as sockets take it.
bool isHost(const std::string& host) {
  const auto read = LinkHost::parse(host.find(':') != std::string::npos ? "[" + host + "]" : host);
  return read && read->host == host && read->port == kDefaultPort;
}

}  // namespace

std::string Presence::payload() const {
  Json all{{"v", kPresenceFormat},
           {"id", id},
           {"name", name},
           {"game", game},
           {"host", host},
           {"port", port},
           {"key", key},
           {"protocol", protocol},
           {"players", players},
           {"max_players", max_players},
           {"password", asks_password},
           {"open", is_open}};
  if (const std::string text = roomsText(rooms); !text.empty()) all.set("rooms", text);
  return all.toString();
}

std::optional<Presence> Presence::parse(std::string_view payload) {
  BusFields fields(payload);
  Presence presence;
  fields.number("v", kPresenceFormat, kPresenceFormat);
  presence.id = fields.word("id", kMaxServerId);
  presence.name = fields.line("name", kMaxName);
  presence.game = fields.line("game", kMaxName);
  presence.host = fields.word("host", kMaxHost);
  presence.port = static_cast<std::uint16_t>(fields.number("port", 1, 65'535));
  presence.key = fields.word("key", 64);
  presence.protocol = static_cast<std::uint32_t>(fields.number("protocol", 1, 65'535));
  presence.players = static_cast<std::uint32_t>(fields.number("players", 0, kMaxCounted));
  presence.max_players = static_cast<std::uint32_t>(fields.number("max_players", 0, kMaxCounted));
  presence.asks_password = fields.flag("password");
  presence.is_open = fields.flag("open");
  auto rooms =
      fields.has("rooms") ? readRooms(fields.line("rooms", kMaxRoomsText)) : std::vector<PresenceRoom>();
  const bool has_rooms = rooms.has_value();
  if (rooms) presence.rooms = *std::move(rooms);
  const auto key = Fingerprint::parse(presence.key);
  const bool good = fields.ok() && has_rooms && isServerId(presence.id) &&
                    (presence.key.empty() || (key && key->text() == presence.key)) &&
                    (presence.host.empty() || isHost(presence.host));
  return good ? std::optional(presence) : std::nullopt;
}

}  // namespace naiad

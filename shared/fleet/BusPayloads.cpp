#include "shared/fleet/BusPayloads.h"

#include <algorithm>
#include <limits>
#include <set>
#include <variant>

#include "shared/net/base/Limits.h"
#include "shared/net/base/SafeText.h"
#include "shared/net/stream/Fingerprint.h"

namespace naiad {
namespace {

bool isIdLetter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9');
}

constexpr std::int64_t kResultFormat = 1;
constexpr std::size_t kMaxGame = 64;
constexpr std::size_t kMaxTable = 32;                       // as in HighScores.h
constexpr std::int64_t kMaxPoints = 1'000'000'000'000'000;  // as in HighScores.h
constexpr std::size_t kRoundDigits = 32;
constexpr std::size_t kMaxRecording = 128;
constexpr std::int64_t kLastSecond = 253'402'300'799;  // the last second of the year 9999

bool isTable(const std::string& table) {
  return !table.empty() && isPlainName(table) && table.find('.') == std::string::npos;
}

bool isRound(const std::string& round) {
  return round.size() == kRoundDigits && round.find_first_not_of("0123456789abcdef") == std::string::npos;
}

constexpr std::int64_t kRedirectFormat = 1;
constexpr std::size_t kMaxLink = 512;

bool isGameWord(std::string_view game) {
  return !game.empty() && game.size() <= PresenceRoom::kMaxGame && isPlainName(game);
}

/// Removes the text up to and including `mark` and returns the part before it. If there is no mark, returns
/// nullopt and leaves `text` unchanged.
std::optional<std::string_view> takeUntil(std::string_view& text, char mark) {
  const std::size_t at = text.find(mark);
  if (at == std::string_view::npos) return std::nullopt;
  const std::string_view part = text.substr(0, at);
  text.remove_prefix(at + 1);
  return part;
}

std::optional<PresenceRoom> readRoom(std::string_view entry) {
  const auto name = takeUntil(entry, '=');
  const auto game = takeUntil(entry, ':');
  const auto players = takeUntil(entry, '/');
  if (!name || !game || !players || !isRoomName(*name) || !isGameWord(*game)) return std::nullopt;
  const auto count = readNumber<std::uint32_t>(*players, 0, PresenceRoom::kMaxPlaces);
  const auto places = readNumber<std::uint32_t>(entry, 0, PresenceRoom::kMaxPlaces);
  if (!count || !places) return std::nullopt;
  return PresenceRoom{std::string(*name), std::string(*game), *count, *places};
}

constexpr std::int64_t kPresenceFormat = 1;
constexpr std::size_t kMaxHost = 255;
constexpr std::int64_t kMaxCounted = 1'000'000;

/// True for a valid host. An IPv6 address has no brackets here, as for sockets.
bool isHost(const std::string& host) {
  const auto read = LinkHost::parse(host.find(':') != std::string::npos ? "[" + host + "]" : host);
  return read && read->host == host && read->port == kDefaultPort;
}

}  // namespace

std::string validateBusSettings(const BusSettings& settings) {
#ifndef NAIAD_NATS
  return "--bus: this program was built without NATS (Debian: libnats-dev)";
#endif
  const std::string& url = settings.url;
  const std::string scheme = settings.isEncrypted() ? "tls://" : "nats://";
  if (!url.starts_with(scheme) || url.size() == scheme.size())
    return "--bus: expected nats://HOST:PORT or tls://HOST:PORT";
  if (!settings.isEncrypted() && !settings.authorities.empty()) return "--bus-ca requires a tls:// bus";
  return "";
}

BusFields::BusFields(std::string_view payload) {
  if (payload.size() <= kMaxBusPayload) m_object = Json::parse(payload, 1).value_or(Json());
  m_ok = m_object.object() != nullptr &&
         std::ranges::none_of(*m_object.object(), [](const Json::Member& member) {
           return member.second.isInteger() && !member.second.integer();  // too large for 63 bits
         });
}

bool BusFields::has(std::string_view name) const {
  const Json& value = m_object[name];
  return value.text() != nullptr || value.integer() || value.boolean() != nullptr;
}

std::int64_t BusFields::number(std::string_view name, std::int64_t least, std::int64_t most) {
  const auto value = m_object[name].integer();
  if (value && *value >= least && *value <= most) return *value;
  m_ok = false;
  return least;
}

bool BusFields::flag(std::string_view name) {
  const bool* const p_value = m_object[name].boolean();
  if (p_value == nullptr) m_ok = false;
  return p_value != nullptr && *p_value;
}

std::string BusFields::line(std::string_view name, std::size_t most) {
  const std::string* const p_value = m_object[name].text();
  if (p_value != nullptr && safeText(*p_value, most) == *p_value) return *p_value;
  m_ok = false;
  return "";
}

std::string BusFields::word(std::string_view name, std::size_t most) {
  std::string text = line(name, most);
  if (std::ranges::all_of(text, [](char c) { return c > ' ' && c <= '~'; })) return text;
  m_ok = false;
  return "";
}

bool isServerId(std::string_view text) {
  return !text.empty() && text.size() <= kMaxServerId && isIdLetter(text.front()) &&
         std::all_of(text.begin(), text.end(), [](char c) { return isIdLetter(c) || c == '-'; });
}

std::string serverIdOf(std::string_view text) {
  std::string id;
  for (const char c : lowerCase(text)) {
    if (isIdLetter(c)) {
      id += c;
    } else if (!id.empty()) {
      id += '-';
    }
    if (id.size() == kMaxServerId) break;
  }
  return id.empty() ? "server" : id;
}

std::string presenceSubject(std::string_view id) {
  return "naiad.presence." + std::string(id);
}

std::string resultSubject(std::string_view id) {
  return "naiad.results." + std::string(id);
}

std::string redirectSubject(std::string_view id) {
  return "naiad.redirect." + std::string(id);
}

std::string formerRedirectSubject(std::string_view id) {
  return "naiad.sendon." + std::string(id);
}

std::string GameResult::payload() const {
  return Json{{"v", kResultFormat}, {"server", server},      {"game", game},
              {"table", table},     {"name", name},          {"points", points},
              {"at", at},           {"round", round},        {"tick", tick},
              {"number", number},   {"recording", recording}}
      .toString();
}

std::string GameResult::messageId() const {
  return round + "-" + std::to_string(tick) + "-" + std::to_string(number);
}

std::optional<GameResult> GameResult::parse(std::string_view payload) {
  BusFields fields(payload);
  GameResult result;
  fields.number("v", kResultFormat, kResultFormat);
  result.server = fields.word("server", kMaxServerId);
  result.game = fields.line("game", kMaxGame);
  result.table = fields.word("table", kMaxTable);
  result.name = fields.line("name", kMaxNameLength);
  result.points = fields.number("points", -kMaxPoints, kMaxPoints);
  result.at = fields.number("at", 0, kLastSecond);
  result.round = fields.word("round", kRoundDigits);
  result.tick =
      static_cast<std::uint32_t>(fields.number("tick", 0, std::numeric_limits<std::uint32_t>::max()));
  result.number = static_cast<int>(fields.number("number", 0, 255));
  result.recording = fields.word("recording", kMaxRecording);
  const bool good = fields.ok() && isServerId(result.server) && isTable(result.table) &&
                    !result.name.empty() && isRound(result.round);
  return good ? std::optional(result) : std::nullopt;
}

std::string Redirect::payload() const {
  return Json{{"v", kRedirectFormat}, {"to", to}, {"link", link.text()}}.toString();
}

// Also refuses a link whose text differs from the one that a directory writes for this link.
std::optional<Redirect> Redirect::parse(std::string_view payload) {
  BusFields fields(payload);
  fields.number("v", kRedirectFormat, kRedirectFormat);
  const std::string to = fields.word("to", kMaxServerId);
  const std::string text = fields.word("link", kMaxLink);
  const auto parsed = JoinLink::parse(text);
  const auto* const p_link = std::get_if<JoinLink>(&parsed);
  const bool good = fields.ok() && isServerId(to) && p_link != nullptr && p_link->text() == text;
  return good ? std::optional(Redirect{to, *p_link}) : std::nullopt;
}

std::string roomsText(const std::vector<PresenceRoom>& rooms) {
  std::string text;
  for (const PresenceRoom& room : rooms) {
    if (!isGameWord(room.game)) continue;
    const std::string entry = (text.empty() ? "" : " ") + room.name + "=" + room.game + ":" +
                              std::to_string(room.players) + "/" + std::to_string(room.max_players);
    if (text.size() + entry.size() > kMaxRoomsText) break;
    text += entry;
  }
  return text;
}

// Also refuses other texts than roomsText() writes for these rooms, so that each list has only one text.
std::optional<std::vector<PresenceRoom>> readRooms(std::string_view text) {
  std::vector<PresenceRoom> rooms;
  std::set<std::string> names;
  for (std::string_view rest = text; !rest.empty();) {
    const auto entry = takeUntil(rest, ' ');
    const auto room = readRoom(entry ? *entry : rest);
    if (!entry) rest = {};
    if (!room || rooms.size() == kMaxRooms) return std::nullopt;
    if (!names.insert(lowerCase(room->name)).second) return std::nullopt;
    rooms.push_back(*room);
  }
  if (roomsText(rooms) != text) return std::nullopt;
  return rooms;
}

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
           {"password", requires_password},
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
  presence.requires_password = fields.flag("password");
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

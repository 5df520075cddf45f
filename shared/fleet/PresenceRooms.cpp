#include "shared/fleet/PresenceRooms.h"

#include <algorithm>
#include <charconv>
#include <set>

#include "shared/net/base/RoomName.h"

namespace naiad {

namespace {

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

bool isGameWord(std::string_view game) {
  return !game.empty() && game.size() <= PresenceRoom::kMaxGame && std::ranges::all_of(game, [](char c) {
    return (lower(c) >= 'a' && lower(c) <= 'z') || (c >= '0' && c <= '9') || c == '-' || c == '_' || c == '.';
  });
}

std::string entryOf(const PresenceRoom& room) {
  return room.name + "=" + room.game + ":" + std::to_string(room.players) + "/" +
         std::to_string(room.max_players);
}

/// What is in front of `mark`, which goes with it; nothing, and `text` stays, if there is none.
std::optional<std::string_view> takeUntil(std::string_view& text, char mark) {
  const std::size_t at = text.find(mark);
  if (at == std::string_view::npos) return std::nullopt;
  const std::string_view part = text.substr(0, at);
  text.remove_prefix(at + 1);
  return part;
}

std::optional<std::uint32_t> readCount(std::string_view text) {
  std::uint32_t count = 0;
  const auto [p_read, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  const bool good =
      error == std::errc() && p_read == text.data() + text.size() && count <= PresenceRoom::kMaxPlaces;
  return good ? std::optional(count) : std::nullopt;
}

std::optional<PresenceRoom> readRoom(std::string_view entry) {
  const auto name = takeUntil(entry, '=');
  const auto game = takeUntil(entry, ':');
  const auto players = takeUntil(entry, '/');
  if (!name || !game || !players || !isRoomName(*name) || !isGameWord(*game)) return std::nullopt;
  const auto count = readCount(*players);
  const auto places = readCount(entry);
  if (!count || !places) return std::nullopt;
  return PresenceRoom{std::string(*name), std::string(*game), *count, *places};
}

}  // namespace

std::string roomsText(const std::vector<PresenceRoom>& rooms) {
  std::string text;
  for (const PresenceRoom& room : rooms) {
    if (!isGameWord(room.game)) continue;
    std::string entry(text.empty() ? "" : " ");
    entry += entryOf(room);
    if (text.size() + entry.size() > kMaxRoomsText) break;
    text += entry;
  }
  return text;
}

// Numbers have one spelling, so what is written again is the same.
std::optional<std::vector<PresenceRoom>> readRooms(std::string_view text) {
  std::vector<PresenceRoom> rooms;
  std::set<std::string> names;
  for (std::string_view rest = text; !rest.empty();) {
    const auto entry = takeUntil(rest, ' ');
    const auto room = readRoom(entry ? *entry : rest);
    if (!entry) rest = {};
    if (!room || rooms.size() == kMaxRooms) return std::nullopt;
    std::string name = room->name;
    std::ranges::transform(name, name.begin(), lower);
    if (!names.insert(name).second) return std::nullopt;
    rooms.push_back(*room);
  }
  if (roomsText(rooms) != text) return std::nullopt;
  return rooms;
}

}  // namespace naiad

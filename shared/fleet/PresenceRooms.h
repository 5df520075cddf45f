// The rooms of a server (RoomName.h) in what it says of itself (Presence.h): a text of one entry for each,
// with blanks between.
//
//   "lobby=lobby:2/64 duel=tron:2/2 arcade=saucershoot:0/8"   NAME=GAME:PLAYERS/PLACES
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace naiad {

struct PresenceRoom {
  static constexpr std::size_t kMaxGame = 64;
  static constexpr std::uint32_t kMaxPlaces = 1'000'000;

  std::string name;  ///< isRoomName()
  std::string game;  ///< 1 to kMaxGame of the characters of a room's name
  std::uint32_t players = 0;
  std::uint32_t max_players = 0;

  friend bool operator==(const PresenceRoom&, const PresenceRoom&) = default;
};

/// Of the text. With the rest of a presence it fits into a payload of the bus.
inline constexpr std::size_t kMaxRoomsText = 900;

/// The first ones that fit, without those whose game has no name that can be written.
std::string roomsText(const std::vector<PresenceRoom>& rooms);
/// Nothing for what roomsText() does not write; names differ, and not only in case.
std::optional<std::vector<PresenceRoom>> readRooms(std::string_view text);

}  // namespace naiad

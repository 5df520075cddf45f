// Names of a server's rooms, as operators, players and links write them.
#pragma once

#include <cstddef>
#include <string_view>

namespace naiad {

inline constexpr std::size_t kMaxRoomName = 32;
/// Rooms of a server.
inline constexpr std::size_t kMaxRooms = 64;
/// What a name has to be, for complaints.
inline constexpr const char* kRoomNameRule =
    "1 to 32 of a-z, A-Z, 0-9, '-', '_' and '.', beginning with a letter or digit";

/// kRoomNameRule holds.
bool isRoomName(std::string_view name);

}  // namespace naiad

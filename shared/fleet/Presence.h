// What a server says of itself on the bus, again and again: where it is, which key it proves, who plays.
//
//   naiad.presence.ID {"v":1,"id":"berlin-9876","name":"Berlin","game":"tron","host":"192.0.2.7","port":9876,
//                       "key":"…64 hexadecimal digits…","protocol":4,"players":3,"max_players":64,
//                       "password":false,"open":true,"rooms":"lobby=lobby:3/64 duel=tron:0/2"}
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "shared/fleet/PresenceRooms.h"
#include "shared/fleet/ServerFacts.h"

namespace naiad {

struct Presence : ServerFacts {
  /// Between two, unless --bus-interval says another; a server that is silent for three of them is gone.
  static constexpr std::chrono::milliseconds kInterval{2000};
  static constexpr std::chrono::milliseconds kLeastInterval{50};  ///< so much each server costs the directory
  /// Players are sent to a dead server for three of them.
  static constexpr std::chrono::milliseconds kMaxInterval{60'000};

  std::string id;          ///< ServerId.h
  std::string host;        ///< name or numeric address for players; empty: it does not know
  std::uint16_t port = 0;  ///< 1 to 65535
  std::string key;         ///< Fingerprint::text(); empty: without encryption
  bool is_open = true;     ///< lets players in: it neither drains nor ends
  /// Those that have names, in the server's order, as many as fit (kMaxRoomsText). A server without them has
  /// none, and says nothing of rooms.
  std::vector<PresenceRoom> rooms = {};

  std::string payload() const;
  /// Nothing for what no server writes.
  static std::optional<Presence> parse(std::string_view payload);

  friend bool operator==(const Presence&, const Presence&) = default;
};

}  // namespace naiad

// What servers of a fleet and its directory say on the bus: each a JSON object (BusFields), under the
// subject of a server.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "shared/fleet/ServerFacts.h"
#include "shared/json/Json.h"
#include "shared/net/stream/JoinLink.h"

namespace naiad {

/// Which bus a fleet has, and how to reach it.
struct BusSettings {
  std::string url;          ///< nats://HOST:PORT or tls://HOST:PORT
  std::string credentials;  ///< file of a user's token and seed; empty: none
  std::string authorities;  ///< file of certificates (PEM) that the bus's is signed with; empty: the system's
  std::vector<std::string> subjects = {};  ///< to listen to; "naiad.presence.*" are all with one word there

  bool isEncrypted() const { return url.starts_with("tls://"); }
};

/// Returns why there can be no such bus: a sentence; empty if there can. Whether it can be reached shows
/// later.
std::string busComplaint(const BusSettings& settings);

inline constexpr std::size_t kMaxBusPayload = 2048;

/// Reads a payload of the bus: one flat JSON object (RFC 8259) of kMaxBusPayload bytes at most. Payloads are
/// as untrusted as a client's: what is missing, of another kind or out of range makes the whole unreadable.
/// Members that are not known are left out, so that a fleet may have servers of two versions.
class BusFields {
 public:
  explicit BusFields(std::string_view payload);

  /// All that was asked for was there and good.
  bool ok() const { return m_ok; }

  /// True if the payload has the member, as a text, a number or a flag.
  bool has(std::string_view name) const;

  // Of a member; fails, and is empty, for one that is not so.

  std::int64_t number(std::string_view name, std::int64_t least, std::int64_t most);
  bool flag(std::string_view name);
  /// Drawable characters only, `most` of them; an empty one is good.
  std::string line(std::string_view name, std::size_t most);
  /// As it stands, `most` bytes of printable ASCII.
  std::string word(std::string_view name, std::size_t most);

 private:
  Json m_object;
  bool m_ok = true;
};

// How servers of a fleet are called on the bus.
inline constexpr std::size_t kMaxServerId = 48;

/// 1 to kMaxServerId of a-z, 0-9 and '-', beginning with a letter or digit: one word of a subject, whose
/// parts are separated by dots.
bool isServerId(std::string_view text);
/// The same made of any text: others become '-'. "server" if nothing is left.
std::string serverIdOf(std::string_view text);

/// "naiad.presence.ID", "naiad.results.ID", "naiad.sendon.ID".
std::string presenceSubject(std::string_view id);
std::string resultSubject(std::string_view id);
std::string sendOnSubject(std::string_view id);

/// A score of a server's game on the bus (HighScores.h): a row of a table, with what names it.
///
///   naiad.results.ID  {"v":1,"server":"berlin-9876","game":"tron","table":"rides","name":"Ann","points":143,
///                      "at":1800000000,"round":"…32 hexadecimal
///                      digits…","tick":4711,"number":0,"recording":""}
///
/// messageId() names the row for JetStream, which keeps one of each.
struct GameResult {
  std::string server;  ///< isServerId()
  std::string game;
  std::string table;
  std::string name;  ///< of the player
  std::int64_t points = 0;
  std::int64_t at = 0;  ///< seconds since 1970
  std::string round;
  std::uint32_t tick = 0;
  int number = 0;
  std::string recording;  ///< empty: there is none

  /// Returns the JSON text that parse() reads.
  std::string payload() const;
  /// "ROUND-TICK-NUMBER".
  std::string messageId() const;
  /// Nothing for what no server writes.
  static std::optional<GameResult> parse(std::string_view payload);

  friend bool operator==(const GameResult&, const GameResult&) = default;
};

/// What a directory says to a server that is full, or nearly so: where it may send players on. Said as often
/// as servers say that they are there (Presence) while it holds; after three times that without a word it
/// does not.
///
///   naiad.sendon.ID  {"v":1,"to":"paris-9876","link":"naiad://192.0.2.8:9876/duel#…26 characters…"}
struct SendOn {
  std::string to;  ///< the other server: isServerId()
  JoinLink link;   ///< to it, and to a room of it where it has rooms

  /// Returns the JSON text that parse() reads.
  std::string payload() const;
  /// Nothing for what no directory writes.
  static std::optional<SendOn> parse(std::string_view payload);

  friend bool operator==(const SendOn&, const SendOn&) = default;
};

/// The rooms of a server (isRoomName()) in what it says of itself (Presence): a text of one entry for each,
/// with blanks between.
///
///   "lobby=lobby:2/64 duel=tron:2/2 arcade=saucershoot:0/8"   NAME=GAME:PLAYERS/PLACES
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

/// What a server says of itself on the bus, again and again: where it is, which key it proves, who plays.
///
///   naiad.presence.ID
///   {"v":1,"id":"berlin-9876","name":"Berlin","game":"tron","host":"192.0.2.7","port":9876,
///                       "key":"…64 hexadecimal digits…","protocol":4,"players":3,"max_players":64,
///                       "password":false,"open":true,"rooms":"lobby=lobby:3/64 duel=tron:0/2"}
struct Presence : ServerFacts {
  /// Between two, unless --bus-interval says another; a server that is silent for three of them is gone.
  static constexpr std::chrono::milliseconds kInterval{2000};
  static constexpr std::chrono::milliseconds kLeastInterval{50};  ///< so much each server costs the directory
  /// Players are sent to a dead server for three of them.
  static constexpr std::chrono::milliseconds kMaxInterval{60'000};

  std::string id;          ///< isServerId()
  std::string host;        ///< name or numeric address for players; empty: it does not know
  std::uint16_t port = 0;  ///< 1 to 65535
  std::string key;         ///< Fingerprint::text(); empty: without encryption
  bool is_open = true;     ///< lets players in: it neither drains nor ends
  /// Those that have names, in the server's order, as many as fit (kMaxRoomsText). A server without them has
  /// none, and says nothing of rooms.
  std::vector<PresenceRoom> rooms = {};

  /// Returns the JSON text that parse() reads.
  std::string payload() const;
  /// Nothing for what no server writes.
  static std::optional<Presence> parse(std::string_view payload);

  friend bool operator==(const Presence&, const Presence&) = default;
};

}  // namespace naiad

// The messages of a fleet's servers and directory on the bus: each is a JSON object (BusFields) under the
// subject of a server.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "shared/fleet/ServerInfo.h"
#include "shared/json/Json.h"
#include "shared/net/stream/JoinLink.h"

namespace naiad {

/// The bus of a fleet, and how to connect to it.
struct BusSettings {
  std::string url;          ///< nats://HOST:PORT or tls://HOST:PORT
  std::string credentials;  ///< file with a user's token and seed; empty: none
  std::string authorities;  ///< PEM file of authorities for the bus's certificate; empty: the system's
  std::vector<std::string> subjects = {};  ///< subjects to subscribe to; in "naiad.presence.*", * is any word

  bool isEncrypted() const { return url.starts_with("tls://"); }
};

/// Returns why the settings are invalid, as a sentence; empty if they are valid. Does not connect.
std::string validateBusSettings(const BusSettings& settings);

inline constexpr std::size_t kMaxBusPayload = 2048;

/// Reads a payload of the bus: one flat JSON object (RFC 8259) of at most kMaxBusPayload bytes, whose
/// integers fit 63 bits and a sign. Payloads are as untrusted as a client's: a missing, mistyped or
/// out-of-range member makes the whole payload invalid. Unknown members are ignored, so that a fleet may mix
/// two versions of servers.
class BusFields {
 public:
  explicit BusFields(std::string_view payload);

  /// True if the payload is a valid object and all members read so far were present and valid.
  bool ok() const { return m_ok; }

  /// True if the payload has the member as a text, an integer or a flag.
  bool has(std::string_view name) const;

  // Each returns a member. If it is missing or invalid, ok() is false and the result empty, false or `least`.

  std::int64_t number(std::string_view name, std::int64_t least, std::int64_t most);
  bool flag(std::string_view name);
  /// Returns a text of at most `most` drawable characters; may be empty.
  std::string line(std::string_view name, std::size_t most);
  /// Returns a text of at most `most` printable ASCII characters without blanks; may be empty.
  std::string word(std::string_view name, std::size_t most);

 private:
  Json m_object;
  bool m_ok = true;
};

/// Maximum length of a server's id on the bus, in characters.
inline constexpr std::size_t kMaxServerId = 48;

/// True for 1 to kMaxServerId characters a-z, 0-9 and '-', beginning with a letter or digit: one word of a
/// subject, whose words are separated by dots.
bool isServerId(std::string_view text);
/// Makes an id of any text: letters become lower case, and characters other than letters and digits become
/// '-', or are omitted at the beginning. Truncates too long texts. Returns "server" if nothing is left.
std::string serverIdOf(std::string_view text);

/// Returns "naiad.presence.ID", "naiad.results.ID" and "naiad.redirect.ID".
std::string presenceSubject(std::string_view id);
std::string resultSubject(std::string_view id);
std::string redirectSubject(std::string_view id);
/// Returns "naiad.sendon.ID", used before version 0.2 instead of redirectSubject(). This version uses both.
std::string formerRedirectSubject(std::string_view id);

/// A score on the bus (HighScores.h): a row of a table, with its origin.
///
///   naiad.results.ID  {"v":1,"server":"berlin-9876","game":"tron","table":"rides","name":"Ann","points":143,
///                      "at":1800000000,"round":"…32 hexadecimal
///                      digits…","tick":4711,"number":0,"recording":""}
///
/// messageId() identifies the row for JetStream, which drops duplicates.
struct GameResult {
  std::string server;  ///< the id of the server: isServerId() is true for it
  std::string game;
  std::string table;
  std::string name;  ///< the player's name
  std::int64_t points = 0;
  std::int64_t at = 0;  ///< seconds since 1970
  std::string round;
  std::uint32_t tick = 0;
  int number = 0;
  std::string recording;  ///< name of the recording; empty: none

  /// Returns the JSON text that parse() reads.
  std::string payload() const;
  /// Returns "ROUND-TICK-NUMBER".
  std::string messageId() const;
  /// Returns nullopt for an invalid payload, which no server writes.
  static std::optional<GameResult> parse(std::string_view payload);

  friend bool operator==(const GameResult&, const GameResult&) = default;
};

/// A directory's message to a full or nearly full server: the server to which it may redirect players. While
/// the redirect is valid, the message is repeated as often as servers send Presence. The redirect expires
/// after three intervals without a message.
///
///   naiad.redirect.ID  {"v":1,"to":"paris-9876","link":"naiad://192.0.2.8:9876/duel#…26 characters…"}
struct Redirect {
  std::string to;  ///< id of the other server: isServerId() is true for it
  JoinLink link;   ///< link to the server, and to one of its rooms if it has rooms

  /// Returns the JSON text that parse() reads.
  std::string payload() const;
  /// Returns nullopt for an invalid payload, which no directory writes.
  static std::optional<Redirect> parse(std::string_view payload);

  friend bool operator==(const Redirect&, const Redirect&) = default;
};

/// A room of a server in its Presence, whose `rooms` is a text with an entry per room, separated by blanks.
///
///   "lobby=lobby:2/64 duel=tron:2/2 arcade=saucershoot:0/8"   NAME=GAME:PLAYERS/PLACES
struct PresenceRoom {
  static constexpr std::size_t kMaxGame = 64;
  static constexpr std::uint32_t kMaxPlaces = 1'000'000;

  std::string name;  ///< a name for which isRoomName() is true
  std::string game;  ///< 1 to kMaxGame characters, as allowed in a room's name
  std::uint32_t players = 0;
  std::uint32_t max_players = 0;

  friend bool operator==(const PresenceRoom&, const PresenceRoom&) = default;
};

/// Maximum bytes of roomsText(). A presence with a text of this length fits into a payload of the bus.
inline constexpr std::size_t kMaxRoomsText = 900;

/// Returns the text of the first rooms that fit. Omits rooms whose game has a name that cannot be written.
std::string roomsText(const std::vector<PresenceRoom>& rooms);
/// Parses the format of roomsText(). Returns nullopt for other texts, for more than kMaxRooms rooms, and if
/// two names are equal or differ only in case.
std::optional<std::vector<PresenceRoom>> readRooms(std::string_view text);

/// A server's heartbeat on the bus: its address, its key, its players.
///
///   naiad.presence.ID
///   {"v":1,"id":"berlin-9876","name":"Berlin","game":"tron","host":"192.0.2.7","port":9876,
///                       "key":"…64 hexadecimal digits…","protocol":4,"players":3,"max_players":64,
///                       "password":false,"open":true,"rooms":"lobby=lobby:3/64 duel=tron:0/2"}
struct Presence : ServerInfo {
  /// Heartbeat interval without --bus-interval; a server silent for three of them is removed.
  static constexpr std::chrono::milliseconds kInterval{2000};
  static constexpr std::chrono::milliseconds kMinInterval{50};  ///< limits a server's load on the directory
  /// Limits how long players may be redirected to a dead server: for up to three intervals.
  static constexpr std::chrono::milliseconds kMaxInterval{60'000};

  std::string id = {};     ///< the server's id: isServerId() is true for it
  std::string host = {};   ///< name or numeric address for players; empty: unknown
  std::uint16_t port = 0;  ///< 1 to 65535
  std::string key = {};    ///< Fingerprint::text(); empty: no encryption
  bool is_open = true;     ///< accepts players: it neither drains nor shuts down
  /// The named rooms in the server's order, as many as fit (kMaxRoomsText). Empty for a server without rooms,
  /// whose payload has no member "rooms".
  std::vector<PresenceRoom> rooms = {};

  /// Returns the JSON text that parse() reads.
  std::string payload() const;
  /// Returns nullopt for an invalid payload, which no server writes.
  static std::optional<Presence> parse(std::string_view payload);

  friend bool operator==(const Presence&, const Presence&) = default;
};

}  // namespace naiad

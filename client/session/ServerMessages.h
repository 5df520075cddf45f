// What a server may say, after everything in it was checked.
//
// A server may be hostile or broken. readServerMessage() is the only place where bytes from the network
// become values: numbers out of range, too many entries or malformed records make the whole message bad;
// texts are made safe for a terminal (SafeText.h), never refused: a strange name is no reason to leave.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "shared/values/Color.h"

namespace naiad {

/// Where a process continues a session that another process began.
struct Continuation {
  std::uint32_t snapshot = 0;    ///< number of the newest
  std::uint8_t world_epoch = 0;  ///< 0 … 3
  std::uint32_t input = 0;       ///< id of the newest
};

/// The join was granted.
struct WelcomeMessage {
  std::uint32_t player = 0;  ///< this player's id, never 0
  std::string name;          ///< as granted
  std::string game;
  std::string server;                     ///< program and version
  std::chrono::microseconds tick{33333};  ///< 1 ms to 1 s
  int view_width = 80;
  int view_height = 24;
  df::Color color = df::COLOR_DEFAULT;
  std::vector<std::string> help;             ///< the game's own lines
  std::uint32_t tick_now = 0;                ///< the world's tick, about now
  std::uint64_t connection_id = 0;           ///< of the session's datagrams
  std::uint32_t aead = 0;                    ///< their cipher; 0: no datagrams
  std::uint32_t epoch = 0;                   ///< of their keys
  std::string resume_token;                  ///< empty: the session ends with its stream
  bool resumed = false;                      ///< an earlier session goes on
  std::chrono::milliseconds grace{0};        ///< how long the server waits for another stream
  std::optional<Continuation> continuation;  ///< for a process that was not there before
  std::uint32_t received = 0;                ///< for one that was: newest reliable frame received
  bool second_stream = false;                ///< the server takes one; or: this is it
  std::string room;                          ///< that the player is in; empty: the server has none
};

/// The session goes on in another room.
struct EnteredMessage {
  std::uint32_t player = 0;  ///< this player's id there, never 0
  std::string room;
  std::string game;
  int view_width = 80;
  int view_height = 24;
  std::vector<std::string> help = {};
  std::uint32_t tick_now = 0;    ///< the world's tick, about now
  std::uint8_t world_epoch = 0;  ///< of the snapshots to come, 0 … 3
};

struct RoomLine {
  std::string name;
  std::string game;
  std::uint32_t players = 0;
  std::uint32_t max_players = 0;
  bool asleep = false;
  friend bool operator==(const RoomLine&, const RoomLine&) = default;
};

struct RoomsMessage {
  std::vector<RoomLine> rooms;
};

struct RefusedMessage {
  bool for_now = false;   ///< another attempt in a moment may succeed
  bool password = false;  ///< it was missing or wrong
  std::string sentence;
  /// To another server that has a place: a link (JoinLink.h), as the server wrote it. Empty: none.
  std::string redirect = {};
  std::string redirect_room = {};  ///< of that server: a name of a room, or empty
  bool full = false;               ///< it has no place
};

struct GoodbyeMessage {
  std::string sentence;
  std::chrono::seconds again{0};  ///< the server is back within this time; 0: it is not
};

/// The bytes of a snapshot; only the replica can read them.
struct SnapshotMessage {
  std::string bytes;
};

struct PlayerLine {
  std::uint32_t player = 0;
  std::string name;
  df::Color color = df::COLOR_DEFAULT;
  std::int32_t score = 0;
  std::uint32_t rtt_millis = 0;
};

struct PlayersMessage {
  std::vector<PlayerLine> players;
  std::uint32_t number = 0;  ///< of a reliable frame (ReliableFrames.h); 0: it is none
};

struct ChatMessage {
  std::uint32_t player = 0;  ///< 0: the server itself
  std::string text;
  std::uint32_t number = 0;  ///< of a reliable frame; 0: it is none
};

/// A sound or a piece of music began, paused or stopped.
struct SoundLine {
  enum class Action : std::uint8_t { kPlay, kPause, kStop };
  std::string label;
  Action action = Action::kPlay;
  bool music = false;        ///< else a sound
  bool loop = false;         ///< again and again
  std::uint32_t player = 0;  ///< that caused it; 0: none
  friend bool operator==(const SoundLine&, const SoundLine&) = default;
};

struct SoundsMessage {
  std::vector<SoundLine> sounds;  ///< in the order in which it happened
  std::uint32_t number = 0;       ///< of a reliable frame; 0: it is none
};

struct PongMessage {
  std::uint64_t token = 0;
  std::uint32_t received = 0;  ///< newest of the client's reliable frames that arrived
};

using ServerMessageValue =
    std::variant<WelcomeMessage, RefusedMessage, GoodbyeMessage, SnapshotMessage, PlayersMessage, ChatMessage,
                 SoundsMessage, PongMessage, EnteredMessage, RoomsMessage>;

/// The message in a frame; nothing if it is not one that this version of the protocol allows.
std::optional<ServerMessageValue> readServerMessage(std::string_view frame);

}  // namespace naiad

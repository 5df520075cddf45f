// Messages from a server, with checked contents.
//
// A server may be hostile or broken. Except in snapshots, readServerMessage() is the only place where bytes
// of a stream become values: numbers out of range, too many entries or malformed records make the whole
// message bad. Texts are not rejected but made safe for a terminal (SafeText.h). Names of rooms that the
// player enters, or that are listed, must be valid.
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

/// State of a session that a new client process resumes.
struct ResumeState {
  std::uint32_t snapshot = 0;    ///< number of the newest snapshot
  std::uint8_t world_epoch = 0;  ///< 0 … 3
  std::uint32_t input = 0;       ///< id of the newest input
};

/// The world in which the player is.
struct PlayerWorld {
  std::uint32_t player = 0;  ///< this player's id there, never 0
  std::string room = {};     ///< the player's room; empty: the server has no rooms
  std::string game = {};
  int view_width = 80;
  int view_height = 24;
  std::vector<std::string> help = {};  ///< help lines of the game
};

/// Message that the server has accepted the client.
struct WelcomeMessage : PlayerWorld {
  std::string name;                       ///< this player's name in the game
  std::string server;                     ///< program and version
  std::chrono::microseconds tick{33333};  ///< length of a tick, 1 ms to 1 s
  df::Color color = df::COLOR_DEFAULT;
  std::uint32_t tick_now = 0;               ///< the world's approximate current tick
  std::uint64_t connection_id = 0;          ///< connection id of datagrams
  std::uint32_t aead = 0;                   ///< cipher of datagrams; 0: no datagrams
  std::uint32_t epoch = 0;                  ///< key epoch of datagrams
  std::string resume_token;                 ///< empty: the session ends with its stream
  bool resumed = false;                     ///< the server has resumed an earlier session
  std::chrono::milliseconds grace{0};       ///< how long the server keeps a session without a stream
  std::optional<ResumeState> resume_state;  ///< set if a new client process resumed the session
  /// Number of the newest reliable frame that the server received, if it resumed the session of this process.
  std::uint32_t last_frame = 0;
  bool second_stream = false;  ///< second streams are accepted, or this is one
};

struct RoomEnteredMessage : PlayerWorld {
  std::uint32_t tick_now = 0;    ///< the world's approximate current tick
  std::uint8_t world_epoch = 0;  ///< epoch of the snapshots to come, 0 … 3
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
  bool is_temporary = false;  ///< a retry in a moment may succeed
  bool password = false;      ///< the password was missing or wrong
  std::string message;
  /// Link to another server with a free place (JoinLink.h), unchecked. Empty: none.
  std::string redirect = {};
  std::string redirect_room = {};  ///< room of the other server; may be empty
  bool full = false;               ///< the server has no free place
};

struct GoodbyeMessage {
  std::string message;
  std::chrono::seconds restart_time{0};  ///< the server will be back within this time; 0: no restart
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
  std::uint32_t number = 0;  ///< number of the reliable frame (ReliableFrames.h); 0: not reliable
};

struct ChatMessage {
  std::uint32_t player = 0;  ///< 0: the server itself
  std::string text;
  std::uint32_t number = 0;  ///< number of the reliable frame; 0: not reliable
};

/// A sound or a piece of music that began, paused or stopped.
struct SoundLine {
  enum class Action : std::uint8_t { kPlay, kPause, kStop };
  std::string label;
  Action action = Action::kPlay;
  bool music = false;        ///< false: a sound
  bool loop = false;         ///< repeated until stopped
  std::uint32_t player = 0;  ///< player that caused it; 0: none
  friend bool operator==(const SoundLine&, const SoundLine&) = default;
};

struct SoundsMessage {
  std::vector<SoundLine> sounds;  ///< oldest first
  std::uint32_t number = 0;       ///< number of the reliable frame; 0: not reliable
};

struct PongMessage {
  std::uint64_t token = 0;
  std::uint32_t last_frame = 0;  ///< number of the client's newest reliable frame that arrived
};

using ServerMessageValue =
    std::variant<WelcomeMessage, RefusedMessage, GoodbyeMessage, SnapshotMessage, PlayersMessage, ChatMessage,
                 SoundsMessage, PongMessage, RoomEnteredMessage, RoomsMessage>;

/// Returns the message in a frame; nullopt if this version of the protocol does not allow it.
std::optional<ServerMessageValue> readServerMessage(std::string_view frame);

}  // namespace naiad

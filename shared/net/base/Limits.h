// Sizes and counts of frames and messages, which both ends enforce. PROTOCOL.md lists them; those
// of snapshots are in shared/replica/Limits.h.
#pragma once

#include <cstddef>
#include <cstdint>

namespace naiad {

inline constexpr std::uint32_t kProtocolVersion = 4;
inline constexpr std::uint32_t kHelloMagic = 0x6e616961;
inline constexpr std::uint16_t kDefaultPort = 9876;

/// Largest frame payload, in bytes: server to client; client to server; before login.
inline constexpr std::size_t kMaxServerFrame = std::size_t{16} * 1024;
inline constexpr std::size_t kMaxClientFrame = std::size_t{4} * 1024;
inline constexpr std::size_t kMaxHelloFrame = 1024;

/// Names and chat, in characters.
inline constexpr std::size_t kMaxNameLength = 16;
inline constexpr std::size_t kMaxChatLength = 200;
inline constexpr std::size_t kMaxNameBytes = 4 * kMaxNameLength;  ///< as UTF-8
/// Sentences for people (refusals, goodbyes), names of games and programs, in characters.
inline constexpr std::size_t kMaxSentenceLength = 300;
inline constexpr std::size_t kMaxProgramLength = 40;
/// The game's lines for the help screen.
inline constexpr std::size_t kMaxHelpLines = 24;
inline constexpr std::size_t kMaxHelpLength = 76;
/// Entries of a player list (so that it fits a frame).
inline constexpr std::size_t kMaxPlayers = 200;

/// Entries of one message of sounds, and characters of a sound's label.
inline constexpr std::size_t kMaxSounds = 16;
inline constexpr std::size_t kMaxSoundLabel = 40;

}  // namespace naiad

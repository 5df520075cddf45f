// Sizes and counts that both ends hold each other to. PROTOCOL.md lists them; a test compares.
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

/// Largest snapshot, in bytes: on the stream (leaves room for the message around it); in a datagram.
inline constexpr std::size_t kMaxSnapshot = std::size_t{15} * 1024;
inline constexpr std::size_t kMaxDatagramSnapshot = 1150;

/// Names and chat, in characters.
inline constexpr std::size_t kMaxNameLength = 16;
inline constexpr std::size_t kMaxChatLength = 200;
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

/// Slots of the replica; a server with more Objects in one world replicates the first ones and says so.
inline constexpr std::uint32_t kMaxSlots = 1u << 20;
/// Characters of one appearance, and the bytes its encoding may take (so that a birth fits a snapshot).
inline constexpr std::size_t kMaxGlyphs = 8192;
inline constexpr std::size_t kMaxLookBytes = std::size_t{14} * 1024;
/// Player texts ("a text shown to one player only").
inline constexpr std::uint32_t kMaxTexts = 16;

/// The view a server grants, in cells.
inline constexpr int kMinViewWidth = 20;
inline constexpr int kMinViewHeight = 10;
inline constexpr int kMaxViewWidth = 400;
inline constexpr int kMaxViewHeight = 150;

}  // namespace naiad

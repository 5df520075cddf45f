// Limits of the sizes and counts of frames and messages, which both ends enforce. PROTOCOL.md lists them;
// shared/replica/Limits.h has those of snapshots.
#pragma once

#include <cstddef>
#include <cstdint>

namespace naiad {

inline constexpr std::uint32_t kProtocolVersion = 4;
inline constexpr std::uint32_t kHelloMagic = 0x6e616961;
inline constexpr std::uint16_t kDefaultPort = 9876;

/// Largest frame payload in bytes: from the server; from the client; from the client before its login.
inline constexpr std::size_t kMaxServerFrame = std::size_t{16} * 1024;
inline constexpr std::size_t kMaxClientFrame = std::size_t{4} * 1024;
inline constexpr std::size_t kMaxHelloFrame = 1024;

/// Maximum length of a name and of a chat line, in characters.
inline constexpr std::size_t kMaxNameLength = 16;
inline constexpr std::size_t kMaxChatLength = 200;
inline constexpr std::size_t kMaxNameBytes = 4 * kMaxNameLength;  ///< maximum bytes of a name in UTF-8
/// Maximum characters of a message for people (refusal, goodbye), and of the name of a game or program.
inline constexpr std::size_t kMaxMessageLength = 300;
inline constexpr std::size_t kMaxProgramLength = 40;
/// Maximum number of the game's lines on the help screen, and maximum length of a line in characters.
inline constexpr std::size_t kMaxHelpLines = 24;
inline constexpr std::size_t kMaxHelpLength = 76;
/// Maximum number of entries of a player list. A list of this size fits one frame.
inline constexpr std::size_t kMaxPlayers = 200;

/// Maximum number of sounds in one message, and of characters in a sound's label.
inline constexpr std::size_t kMaxSounds = 16;
inline constexpr std::size_t kMaxSoundLabel = 40;

}  // namespace naiad

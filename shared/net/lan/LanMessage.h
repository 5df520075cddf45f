// The two messages by which clients find the servers of the local network. PROTOCOL.md has every byte.
//
//   query   512 bytes   "nlan" | format 1 | kind 1 | 0 0 | nonce 16 | zeros
//   answer  ≤ 370       "nlan" | format 1 | kind 2 | protocol 2 | nonce 16 | port 2 | flags | 0 | players 2 |
//                       most players 2 | short key 16 | length, name | length, game
//
// The query is padded, so that an answer is never longer than what it answers: a forged query brings its
// victim no more than its sender has paid for. All texts are from strangers: what is read is safe to draw.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "shared/fleet/ServerFacts.h"
#include "shared/net/stream/Fingerprint.h"

namespace naiad {

/// The UDP port of queries. It has nothing to do with the ports that games are played on.
inline constexpr std::uint16_t kLanPort = 19876;
/// Neither is forwarded by any router: 224.0.0.0/24 is the link's own (RFC 5771; .254 is for experiments,
/// RFC 4727), ff12::/16 has the scope of the link (RFC 4291 2.7; the group is a transient one, RFC 3307
/// 4.3).
inline constexpr const char* kLanGroup4 = "224.0.0.254";
inline constexpr const char* kLanGroup6 = "ff12::ee61:6961";
/// Of what is sent, both ways, and demanded of what comes: a router would have lowered it (RFC 5082).
inline constexpr int kLanHopLimit = 255;

inline constexpr std::size_t kLanQuerySize = 512;
/// Characters of a name or a game, and their bytes as UTF-8.
inline constexpr std::size_t kMaxLanText = 40;
inline constexpr std::size_t kMaxLanTextBytes = 4 * kMaxLanText;

/// 128 random bits of the client, which an answer repeats.
using LanNonce = std::array<std::uint8_t, 16>;

/// What a server says of itself. Nothing of it is proved.
/// Numbers have 16 bits on the wire. Name and game are drawable (SafeText.h), and have kMaxLanText characters
/// at most.
struct LanAnswer : ServerFacts {
  LanNonce nonce{};
  std::uint16_t port = 0;  ///< that it is played on, TCP and UDP; never 0
  ShortKey key = ShortKey::ofBytes({});

  friend bool operator==(const LanAnswer&, const LanAnswer&) = default;
};

/// kLanQuerySize bytes.
std::string writeLanQuery(const LanNonce& nonce);
/// Nothing unless `bytes` are a query to the last bit of their padding.
std::optional<LanNonce> readLanQuery(std::string_view bytes);

/// Texts are made safe and cut; the port must not be 0.
std::string writeLanAnswer(const LanAnswer& answer);
/// Nothing unless every field is in its range and nothing is left over. Texts are made safe.
std::optional<LanAnswer> readLanAnswer(std::string_view bytes);

}  // namespace naiad

// The two messages with which clients find servers in the local network. PROTOCOL.md describes every byte.
//
//   query   512 bytes   "nlan" | format 1 | kind 1 | 0 0 | nonce 16 | zeros
//   answer  ≤ 370       "nlan" | format 1 | kind 2 | protocol 2 | nonce 16 | port 2 | flags | 0 | players 2 |
//                       max players 2 | short key 16 | length, name | length, game
//
// The query is padded so that an answer is never longer: forged queries cannot amplify traffic. All texts
// come from untrusted machines; the read functions make them safe to draw.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "shared/fleet/ServerInfo.h"
#include "shared/net/stream/Fingerprint.h"

namespace naiad {

/// The UDP port of queries. It is independent of the ports of the games.
inline constexpr std::uint16_t kLanPort = 19876;
/// The multicast groups of queries. Routers forward neither: 224.0.0.0/24 is link-local (RFC 5771; .254 is
/// for experiments, RFC 4727), ff12::/16 has link-local scope (RFC 4291 2.7; the group is transient, RFC 3307
/// 4.3).
inline constexpr const char* kLanGroup4 = "224.0.0.254";
inline constexpr const char* kLanGroup6 = "ff12::ee61:6961";
/// Hop limit of all sent packets. Received packets must still have it, because a router would have lowered it
/// (RFC 5082).
inline constexpr int kLanHopLimit = 255;

inline constexpr std::size_t kLanQuerySize = 512;
/// Longest name of a server or game, in characters and in bytes as UTF-8.
inline constexpr std::size_t kMaxLanText = 40;
inline constexpr std::size_t kMaxLanTextBytes = 4 * kMaxLanText;

/// 128 random bits chosen by the client; the answer repeats them.
using LanNonce = std::array<std::uint8_t, 16>;

/// A server's description of itself, unverified. Numbers have 16 bits on the wire. Name and game are drawable
/// (SafeText.h) and have at most kMaxLanText characters.
struct LanAnswer : ServerInfo {
  LanNonce nonce{};
  std::uint16_t port = 0;  ///< port of the game, TCP and UDP; never 0
  ShortKey key = ShortKey::ofBytes({});

  friend bool operator==(const LanAnswer&, const LanAnswer&) = default;
};

/// Returns a query of kLanQuerySize bytes.
std::string writeLanQuery(const LanNonce& nonce);
/// Returns the nonce if all of `bytes`, including the padding, is a valid query; nullopt if not.
std::optional<LanNonce> readLanQuery(std::string_view bytes);

/// Encodes an answer. Texts are sanitized and truncated; the port must not be 0.
std::string writeLanAnswer(const LanAnswer& answer);
/// Decodes an answer; nullopt unless every field is in its range and no bytes remain. Texts are sanitized.
std::optional<LanAnswer> readLanAnswer(std::string_view bytes);

}  // namespace naiad

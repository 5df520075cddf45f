// The link to a game: naiad://HOST[:PORT][/ROOM]#KEY.
//
// HOST is a name or an address (IPv6 in brackets), PORT is optional, KEY is the short name of the server's
// key (ShortKey). Links come from untrusted pages and chats: they contain only these four parts, each checked
// strictly. %XX is decoded because desktops may encode the links that they pass on (RFC 3986 2.1).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "shared/net/base/Limits.h"
#include "shared/net/stream/Fingerprint.h"

namespace naiad {

/// The reason why a text is not a valid link. `message` ends a sentence, and contains no text of the link.
struct LinkError {
  std::string message;
};

/// HOST or HOST:PORT.
struct LinkHost {
  std::string host;  ///< IPv6 without brackets
  std::uint16_t port = kDefaultPort;

  /// Parses a name of ASCII letters, digits, '-', '_' and dots that does not begin with '-', an IPv4 address,
  /// or an IPv6 address in brackets, without a zone; then a port of 1 … 65535, or none for `default_port`.
  /// Returns nullopt for other texts.
  static std::optional<LinkHost> parse(std::string_view text, std::uint16_t default_port = kDefaultPort);
  /// Returns "game.example" or "[::1]:9877"; omits the port if it is `default_port`.
  std::string text(std::uint16_t default_port = kDefaultPort) const;

  friend bool operator==(const LinkHost&, const LinkHost&) = default;
};

struct JoinLink {
  LinkHost address;
  std::string room;  ///< empty, or a name that isRoomName() accepts
  ShortKey key;

  /// True if the text begins with "naiad:", in upper or lower case: parse it as a link.
  static bool looksLikeLink(std::string_view text);
  static std::variant<JoinLink, LinkError> parse(std::string_view text);
  std::string text() const;

  friend bool operator==(const JoinLink&, const JoinLink&) = default;
};

}  // namespace naiad

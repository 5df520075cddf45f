// The link that leads to a game: naiad://HOST[:PORT][/ROOM]#KEY.
//
// HOST is a name or an address (IPv6 in brackets), PORT the default one if it is left out, KEY the short name
// of the server's key (ShortKey). A link comes from strangers, by way of pages, chats and desktops: it
// holds these four and nothing else, each checked strictly. %XX is decoded, as desktops may encode what they
// pass on (RFC 3986 2.1).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "shared/net/base/Limits.h"
#include "shared/net/stream/Fingerprint.h"

namespace naiad {

/// Why a text is no link: the end of a sentence, "it has no key at its end". It has no text of the link in
/// it.
struct LinkProblem {
  std::string sentence;
};

/// HOST or HOST:PORT.
struct LinkHost {
  std::string host;  ///< IPv6 without brackets
  std::uint16_t port = kDefaultPort;

  /// A name of ASCII letters, digits, '-', '_' and dots that does not begin with '-', an IPv4 address, or an
  /// IPv6 address in brackets, without a zone; and a port of 1 … 65535, `default_port` if there is none.
  /// Nothing if it is none of these.
  static std::optional<LinkHost> parse(std::string_view text, std::uint16_t default_port = kDefaultPort);
  /// Returns "game.example" or "[::1]:9877". Leaves the port out if it is `default_port`.
  std::string text(std::uint16_t default_port = kDefaultPort) const;

  friend bool operator==(const LinkHost&, const LinkHost&) = default;
};

struct JoinLink {
  LinkHost where;
  std::string room;  ///< empty, or a name that isRoomName() takes
  ShortKey key;

  /// Does the text mean to be a link? It begins with "naiad:", in any case.
  static bool isMeant(std::string_view text);
  static std::variant<JoinLink, LinkProblem> parse(std::string_view text);
  std::string text() const;

  friend bool operator==(const JoinLink&, const JoinLink&) = default;
};

}  // namespace naiad

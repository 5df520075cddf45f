// The address of a list of servers on the web: https://HOST[:PORT]/PATH.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace naiad {

struct ListUrl {
  std::string host;  ///< a name or an address, IPv6 without brackets
  std::uint16_t port = 443;
  std::string target = "/";  ///< path and query, as the request has them

  /// Nothing if it is no such address: another scheme, a user's name, characters beyond printable ASCII, more
  /// than 2000 of them. What begins with # is left out.
  static std::optional<ListUrl> parse(std::string_view text);
  /// Where a redirect of this list leads: an https address, or a path of the same host. Nothing for all else,
  /// so that none leads out of encryption.
  std::optional<ListUrl> redirected(std::string_view location) const;
  /// What stands in the header Host.
  std::string hostText() const;

  friend bool operator==(const ListUrl&, const ListUrl&) = default;
};

}  // namespace naiad

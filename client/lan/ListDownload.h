// Downloads a list of servers from the web, over HTTPS (shared/net/http/HttpExchange.h).
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

namespace naiad {

/// The address of a list of servers on the web: https://HOST[:PORT]/PATH.
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

/// Why there is no list: a sentence for people, without anything from the other end in it.
struct DownloadProblem {
  std::string sentence;
};

inline constexpr std::size_t kMaxListBytes = std::size_t{1} << 20;
inline constexpr std::chrono::seconds kListPatience{5};  ///< for all of it, redirects too
inline constexpr int kMaxListRedirects = 3;

/// Waits for the list. The certificate must be good in the eyes of the system's trust store. A redirect is
/// followed as far as ListUrl::redirected() goes.
std::variant<std::string, DownloadProblem> downloadList(const ListUrl& url);

}  // namespace naiad

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
  std::string target = "/";  ///< path and query, as in the request

  /// Parses the address, without the part from '#' on. Nullopt for another scheme, an invalid host or port, a
  /// user name, a blank or a character that is not printable ASCII, or more than 2000 characters.
  static std::optional<ListUrl> parse(std::string_view text);
  /// Returns the target of a redirect: an https address, or a path on this host that begins with '/'. Nullopt
  /// for anything else, so a redirect cannot turn encryption off.
  std::optional<ListUrl> redirected(std::string_view location) const;
  /// Returns the value of the header Host.
  std::string hostText() const;

  friend bool operator==(const ListUrl&, const ListUrl&) = default;
};

/// Reason of a failed download: a message for people. It contains no text from the other end.
struct DownloadError {
  std::string message;
};

inline constexpr std::size_t kMaxListBytes = std::size_t{1} << 20;
inline constexpr std::chrono::seconds kListTimeout{5};  ///< limit on the whole download, with redirects
inline constexpr int kMaxListRedirects = 3;

/// Downloads the list; blocks for up to kListTimeout. The system's trust store must accept the certificate.
/// Follows up to kMaxListRedirects redirects that ListUrl::redirected() allows. Returns the document.
std::variant<std::string, DownloadError> downloadList(const ListUrl& url);

}  // namespace naiad

#include "shared/net/stream/JoinLink.h"

#include <algorithm>
#include <asio/ip/address_v6.hpp>
#include <charconv>
#include <system_error>

#include "shared/net/base/SafeText.h"

namespace naiad {
namespace {

constexpr std::string_view kScheme = "naiad:";
constexpr std::size_t kMaxLink = 512;  // maximum bytes; the longest valid link has about 330
constexpr std::size_t kMaxHost = 253;  // maximum characters of a host name (RFC 1035 2.3.4)
constexpr std::size_t kMaxLabel = 63;  // maximum characters between two dots of a host name
constexpr std::size_t kMaxPortDigits = 5;

bool isGraphic(char c) {
  return c > ' ' && c < 0x7f;
}

/// Decodes %XX. Returns nullopt if it is malformed or the result is not printable ASCII.
std::optional<std::string> decoded(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      result.push_back(text[i]);
      continue;
    }
    unsigned byte = 0;
    if (i + 2 >= text.size()) return std::nullopt;
    const char* const last = text.data() + i + 3;
    const auto [end, error] = std::from_chars(text.data() + i + 1, last, byte, 16);
    if (error != std::errc{} || end != last || !isGraphic(static_cast<char>(byte))) return std::nullopt;
    result.push_back(static_cast<char>(byte));
    i += 2;
  }
  return result;
}

bool isName(std::string_view host) {
  if (host.ends_with('.')) host.remove_suffix(1);
  if (host.empty() || host.size() > kMaxHost || host.front() == '-' || !isPlainName(host)) return false;
  std::size_t label = 0;
  for (const char c : host) {
    if (c == '.' && label == 0) return false;
    label = c == '.' ? 0 : label + 1;
    if (label > kMaxLabel) return false;
  }
  return label > 0;
}

// Checks the characters first: Asio's parser stops at a zero byte and accepts a scope after a %.
bool isIPv6(std::string_view host) {
  if (host.find_first_not_of("0123456789abcdefABCDEF:.") != std::string_view::npos) return false;
  std::error_code error;
  asio::ip::make_address_v6(std::string(host), error);
  return !error;
}

}  // namespace

std::optional<LinkHost> LinkHost::parse(std::string_view text, std::uint16_t default_port) {
  LinkHost result;
  result.port = default_port;
  if (text.starts_with('[')) {
    const std::size_t end = text.find(']');
    if (end == std::string_view::npos) return std::nullopt;
    result.host = text.substr(1, end - 1);
    text.remove_prefix(end + 1);
    if (!isIPv6(result.host)) return std::nullopt;
  } else {
    const std::size_t end = std::min(text.find(':'), text.size());
    result.host = text.substr(0, end);
    text.remove_prefix(end);
    if (!isName(result.host)) return std::nullopt;
  }
  if (text.empty()) return result;
  if (text.front() != ':' || text.size() > 1 + kMaxPortDigits) return std::nullopt;
  const auto port = readNumber<std::uint16_t>(text.substr(1), 1, 65'535);
  if (!port) return std::nullopt;
  result.port = *port;
  return result;
}

std::string LinkHost::text(std::uint16_t default_port) const {
  const std::string shown = host.find(':') != std::string::npos ? "[" + host + "]" : host;
  return port == default_port ? shown : shown + ":" + std::to_string(port);
}

bool JoinLink::looksLikeLink(std::string_view text) {
  return lowerCase(text.substr(0, kScheme.size())) == kScheme;
}

std::variant<JoinLink, LinkError> JoinLink::parse(std::string_view text) {
  if (text.size() > kMaxLink) return LinkError{"it is longer than 512 characters"};
  if (!std::all_of(text.begin(), text.end(), isGraphic))
    return LinkError{"it contains a space or a character that is not printable ASCII"};
  if (!looksLikeLink(text) || !text.substr(kScheme.size()).starts_with("//"))
    return LinkError{"it does not begin with naiad://"};
  text.remove_prefix(kScheme.size() + 2);

  const std::size_t hash = text.find('#');
  if (hash == std::string_view::npos || hash + 1 == text.size())
    return LinkError{"it has no key (#…) at its end; it may be truncated"};
  const auto key_text = decoded(text.substr(hash + 1));
  const auto key = key_text ? ShortKey::parse(*key_text) : std::nullopt;
  if (!key)
    return LinkError{"the key after the # must be 26 letters and digits 2 to 7, as dfserver prints it"};
  text = text.substr(0, hash);

  if (text.find('?') != std::string_view::npos) return LinkError{"it contains a ?, which is not allowed"};
  const std::size_t slash = std::min(text.find('/'), text.size());
  const auto authority = decoded(text.substr(0, slash));
  const auto room = decoded(text.substr(std::min(slash + 1, text.size())));
  if (!authority || !room) return LinkError{"it contains a % that does not encode a printable character"};
  if (authority->find('@') != std::string::npos)
    return LinkError{"it contains a user name, which is not allowed"};
  const auto where = LinkHost::parse(*authority);
  if (!where) return LinkError{"expected HOST or HOST:PORT after naiad://"};
  if (!room->empty() && !isRoomName(*room)) return LinkError{"the part after the / is not a valid room name"};
  return JoinLink{*where, *room, *key};
}

std::string JoinLink::text() const {
  return "naiad://" + address.text() + (room.empty() ? "" : "/" + room) + "#" + key.text();
}

}  // namespace naiad

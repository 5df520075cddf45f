#include "client/lan/ListUrl.h"

#include <algorithm>

#include "shared/net/stream/JoinLink.h"

namespace naiad {
namespace {

constexpr std::string_view kScheme = "https://";
constexpr std::uint16_t kHttpsPort = 443;
constexpr std::size_t kMaxUrl = 2000;

bool isPlain(std::string_view text) {
  return text.size() <= kMaxUrl &&
         std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c < 0x7f; });
}

}  // namespace

std::optional<ListUrl> ListUrl::parse(std::string_view text) {
  if (!text.starts_with(kScheme) || !isPlain(text)) return std::nullopt;
  text = text.substr(kScheme.size());
  text = text.substr(0, text.find('#'));
  const std::size_t end = std::min(text.find_first_of("/?"), text.size());
  const auto where = LinkHost::parse(text.substr(0, end), kHttpsPort);
  if (!where) return std::nullopt;
  const std::string_view rest = text.substr(end);
  return ListUrl{where->host, where->port, (rest.starts_with('/') ? "" : "/") + std::string(rest)};
}

std::optional<ListUrl> ListUrl::redirected(std::string_view location) const {
  if (!location.starts_with('/') || location.starts_with("//")) return parse(location);
  if (!isPlain(location)) return std::nullopt;
  ListUrl url = *this;
  url.target = location.substr(0, location.find('#'));
  return url;
}

std::string ListUrl::hostText() const {
  const std::string name = host.find(':') != std::string::npos ? "[" + host + "]" : host;
  return port == kHttpsPort ? name : name + ":" + std::to_string(port);
}

}  // namespace naiad

#include "server/gateway/AllowedOrigins.h"

#include <algorithm>

#include "shared/net/base/SafeText.h"
#include "shared/net/stream/JoinLink.h"

namespace naiad {
namespace {

constexpr std::string_view kHttp = "http://";
constexpr std::string_view kHttps = "https://";

std::uint16_t ownPort(bool is_secure) {
  return is_secure ? 443 : 80;
}

}  // namespace

std::optional<WebOrigin> WebOrigin::parse(std::string_view text) {
  const std::string lower = lowerCase(text);
  std::string_view rest = lower;
  WebOrigin origin;
  origin.is_secure = rest.starts_with(kHttps);
  if (!origin.is_secure && !rest.starts_with(kHttp)) return std::nullopt;
  rest.remove_prefix(origin.is_secure ? kHttps.size() : kHttp.size());
  if (rest.ends_with('/')) rest.remove_suffix(1);
  const auto where = LinkHost::parse(rest, ownPort(origin.is_secure));
  if (!where) return std::nullopt;
  origin.host = where->host.find(':') == std::string::npos ? where->host : "[" + where->host + "]";
  origin.port = where->port;
  return origin;
}

std::string WebOrigin::hostText() const {
  return port == ownPort(is_secure) ? host : host + ":" + std::to_string(port);
}

std::string WebOrigin::text() const {
  return std::string(is_secure ? kHttps : kHttp) + hostText();
}

void AllowedOrigins::add(const WebOrigin& origin) {
  m_hosts.push_back(origin.hostText());
  m_hosts.push_back(origin.host + ":" + std::to_string(origin.port));
  m_origins.push_back(origin.text());
}

bool AllowedOrigins::allowsHost(std::string_view host) const {
  return std::ranges::find(m_hosts, lowerCase(host)) != m_hosts.end();
}

bool AllowedOrigins::allowsOrigin(std::string_view origin) const {
  return std::ranges::find(m_origins, origin) != m_origins.end();
}

}  // namespace naiad

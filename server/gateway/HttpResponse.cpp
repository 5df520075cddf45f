#include "server/gateway/HttpResponse.h"

#include <algorithm>
#include <boost/beast/http/rfc7230.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <ctime>

namespace naiad {
namespace {

namespace http = boost::beast::http;

constexpr HttpResponses::Header kCommon[] = {
    {"Content-Security-Policy",
     "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self'; font-src 'self'; img-src "
     "'self'; "
     "connect-src 'self'; manifest-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
    {"X-Content-Type-Options", "nosniff"},
    {"Referrer-Policy", "no-referrer"},
    {"Cross-Origin-Opener-Policy", "same-origin"},
    {"Cross-Origin-Resource-Policy", "same-origin"},
    {"Cache-Control", "no-cache"}};
constexpr HttpResponses::Header kStrictTransport{"Strict-Transport-Security", "max-age=31536000"};
constexpr int kOtherMethod = 405;
constexpr std::string_view kTextType = "Content-Type: text/plain; charset=utf-8\r\n";

std::string_view viewOf(boost::beast::string_view text) {
  return {text.data(), text.size()};
}

std::string_view headerOf(const WebRequest& request, http::field name) {
  return viewOf(request[name]);
}

std::string statusLine(int status) {
  const auto reason = viewOf(http::obsolete_reason(static_cast<http::status>(status)));
  return "HTTP/1.1 " + std::to_string(status) + " " + std::string(reason) + "\r\n";
}

/// Returns "Date: Sun, 06 Nov 1994 08:49:37 GMT" (RFC 9110 5.6.7) for the current time, in any locale.
std::string dateLine() {
  static constexpr const char* kDays[] = {"Sun", "Mon", "Tue", "Wed", "Thu", "Fri", "Sat"};
  static constexpr const char* kMonths[] = {"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                                            "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  char line[64];
  std::snprintf(line, sizeof line, "Date: %s, %02d %s %04d %02d:%02d:%02d GMT\r\n", kDays[utc.tm_wday],
                utc.tm_mday, kMonths[utc.tm_mon], utc.tm_year + 1900, utc.tm_hour, utc.tm_min, utc.tm_sec);
  return line;
}

/// True if Accept-Encoding has "gzip" with a weight above 0 (RFC 9110 12.5.3).
bool acceptsGzip(const WebRequest& request) {
  for (const auto& coding : http::ext_list(request[http::field::accept_encoding])) {
    if (!boost::beast::iequals(coding.first, "gzip")) continue;
    return std::none_of(coding.second.begin(), coding.second.end(), [](const auto& parameter) {
      const std::string_view weight = viewOf(parameter.second);
      return boost::beast::iequals(parameter.first, "q") && weight.find_first_not_of("0.") == weight.npos;
    });
  }
  return false;
}

bool hasFile(const WebRequest& request, const std::string& tag) {
  const std::string_view known = headerOf(request, http::field::if_none_match);
  return known == "*" || known.find(tag) != std::string_view::npos;
}

bool offersSubprotocol(const WebRequest& request) {
  return http::token_list(request[http::field::sec_websocket_protocol])
      .exists(boost::beast::string_view(kSubprotocol.data(), kSubprotocol.size()));
}

}  // namespace

HttpResponses::HttpResponses(const PageFiles& page, const AllowedOrigins& origins, std::string server_json,
                             bool has_tls)
    : m_page(page),
      m_origins(origins),
      m_server_json(std::move(server_json)),
      m_common(std::begin(kCommon), std::end(kCommon)) {
  if (has_tls) m_common.push_back(kStrictTransport);
  for (const auto& [name, value] : m_common) {
    m_common_text.append(name).append(": ").append(value).append("\r\n");
  }
}

std::string_view HttpResponses::pathOf(const WebRequest& request) {
  const std::string_view target = viewOf(request.target());
  return target.substr(0, target.find('?'));
}

HttpResponse HttpResponses::response(const WebRequest& request) const {
  if (const Refusal* const why = validateHost(request)) return refusal(why->status, why->message);
  if (request.method() != http::verb::get && request.method() != http::verb::head)
    return make(request, kOtherMethod, "Allow: GET, HEAD\r\n" + std::string(kTextType),
                "Only GET and HEAD are allowed.\n");
  const std::string_view path = pathOf(request);
  if (path == "/server") return make(request, 200, "Content-Type: application/json\r\n", m_server_json);
  if (path == kPlayPath)
    return make(request, 426, "Upgrade: websocket\r\nConnection: Upgrade\r\n" + std::string(kTextType),
                "This address requires a WebSocket.\n");
  if (const PageFile* const file = m_page.find(path)) return fileResponse(request, *file);
  return make(request, 404, kTextType, "No such file.\n");
}

HttpResponse HttpResponses::fileResponse(const WebRequest& request, const PageFile& file) const {
  // The compressed form needs a tag of its own, although the content is equal (RFC 9110 8.8.3).
  const bool packs = !file.compressed.empty() && acceptsGzip(request);
  std::string tag = file.tag;
  if (packs) tag.insert(tag.size() - 1, "-gz");
  std::string headers = "ETag: " + tag + "\r\n";
  if (!file.compressed.empty()) headers += "Vary: Accept-Encoding\r\n";
  if (hasFile(request, tag)) return make(request, 304, headers, {});
  headers += "Content-Type: " + file.type + "\r\n";
  if (packs) headers += "Content-Encoding: gzip\r\n";
  const std::string& content = packs ? file.compressed : file.content;
  HttpResponse result =
      make(request, 200, headers + "Content-Length: " + std::to_string(content.size()) + "\r\n", {});
  if (request.method() == http::verb::get) result.content = content;
  return result;
}

/// Makes a response. Adds Content-Length if there is a body; else `headers` may have it.
HttpResponse HttpResponses::make(const WebRequest& request, int status, std::string_view headers,
                                 std::string_view body) const {
  HttpResponse result;
  // A request with another method may have a body, which is not read.
  result.keeps_connection = request.keep_alive() && status != kOtherMethod;
  result.is_refusal = status >= 400;
  result.head = statusLine(status) + dateLine() + m_common_text;
  result.head += headers;
  if (!body.empty()) result.head += "Content-Length: " + std::to_string(body.size()) + "\r\n";
  if (!result.keeps_connection) result.head += "Connection: close\r\n";
  result.head += "\r\n";
  if (request.method() != http::verb::head) result.text = body;
  return result;
}

HttpResponse HttpResponses::refusal(int status, std::string_view message) const {
  HttpResponse result;
  result.keeps_connection = false;
  result.is_refusal = true;
  result.head = statusLine(status) + dateLine() + m_common_text;
  result.head += kTextType;
  result.head += "Content-Length: " + std::to_string(message.size()) + "\r\nConnection: close\r\n\r\n";
  result.text = message;
  return result;
}

const HttpResponses::Refusal* HttpResponses::validateHost(const WebRequest& request) const {
  static constexpr Refusal kVersion{505, "Only HTTP/1.1 is supported.\n"};
  static constexpr Refusal kHost{421, "Unknown server name. The host can add it with dfweb --origin.\n"};
  if (request.version() != 11) return &kVersion;
  const bool is_ours =
      request.count(http::field::host) == 1 && m_origins.allowsHost(headerOf(request, http::field::host));
  return is_ours ? nullptr : &kHost;
}

const HttpResponses::Refusal* HttpResponses::validateUpgrade(const WebRequest& request) const {
  static constexpr Refusal kPath{404, "This path has no WebSocket.\n"};
  static constexpr Refusal kOrigin{403, "Only this server's own page may connect.\n"};
  static constexpr Refusal kProtocol{400, "The subprotocol naiad.1 is required.\n"};
  if (const Refusal* const why = validateHost(request)) return why;
  if (viewOf(request.target()) != kPlayPath) return &kPath;
  if (request.count(http::field::origin) != 1 ||
      !m_origins.allowsOrigin(headerOf(request, http::field::origin)))
    return &kOrigin;
  if (!offersSubprotocol(request)) return &kProtocol;
  return nullptr;
}

}  // namespace naiad

// Requests to the gateway for browsers: each response is one of the gateway's own, with the headers that
// guard the page, and only its own page can open a WebSocket.
//
//   input   0 | address of an origin        a program's own list of names
//           1 | text                        as a string of JSON
//           2 … | the bytes of a request
#include <stdlib.h>

#include <algorithm>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <filesystem>
#include <fstream>
#include <optional>

#include "Target.h"
#include "server/gateway/HttpResponse.h"
#include "shared/json/Json.h"

namespace naiad::fuzz {
namespace {

namespace http = boost::beast::http;
using Parser = http::request_parser<http::empty_body>;

const std::string kJson = "{\"name\": \"a game\"}\n";
constexpr const char* kOrigin = "https://play.example";

PageFiles smallPage() {
  std::string folder = std::filesystem::temp_directory_path() / "naiad-fuzz-XXXXXX";
  REQUIRE(mkdtemp(folder.data()) != nullptr);
  std::ofstream(folder + "/index.html") << std::string(500, 'a');
  std::ofstream(folder + "/font.woff2") << "font";
  PageFiles files{std::filesystem::path(folder)};
  std::filesystem::remove_all(folder);
  return files;
}

struct Site {
  PageFiles page = smallPage();
  AllowedOrigins names;
  HttpResponses responses{page, names, kJson, true};
  Site() { names.add(*WebOrigin::parse(kOrigin)); }
};

const Site& site() {
  static const Site kept;
  return kept;
}

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c | 0x20 : c);
  return result;
}

std::string only(const WebRequest& request, http::field name) {
  REQUIRE(request.count(name) == 1);
  return std::string(request[name]);
}

/// Requires a head of lines with printable characters, of which only the last is empty.
void requireHead(const std::string& head) {
  REQUIRE(head.starts_with("HTTP/1.1 ") && head.ends_with("\r\n\r\n"));
  REQUIRE(head.find("\r\n\r\n") == head.size() - 4);
  for (std::size_t i = 0; i < head.size(); ++i) {
    const bool is_end = head[i] == '\r' && i + 1 < head.size() && head[i + 1] == '\n';
    if (is_end) ++i;
    REQUIRE(is_end || (head[i] >= ' ' && head[i] < 0x7f));
  }
  for (const auto& [name, value] : site().responses.commonHeaders())
    REQUIRE(head.find("\r\n" + std::string(name) + ": " + std::string(value) + "\r\n") != std::string::npos);
}

void requireResponse(const HttpResponse& response) {
  requireHead(response.head);
  const std::string status = response.head.substr(9, 3);
  REQUIRE(response.is_refusal == (status >= "400"));
  if (!response.content.empty()) {
    const PageFile& index = *site().page.find("/");
    const PageFile& font = *site().page.find("/font.woff2");
    REQUIRE(response.content == index.content || response.content == index.compressed ||
            response.content == font.content);
  }
  const std::size_t length = response.head.find("Content-Length: ");
  if (!response.body().empty())
    REQUIRE(std::stoul(response.head.substr(length + 16)) == response.body().size());
  REQUIRE(response.keeps_connection ==
          (response.head.find("\r\nConnection: close\r\n") == std::string::npos));
}

void requireOwnPage(const WebRequest& request) {
  const std::string host = lower(only(request, http::field::host));
  REQUIRE(host == "play.example" || host == "play.example:443");
  REQUIRE(only(request, http::field::origin) == kOrigin);
  REQUIRE(request.target() == "/play" && request.version() == 11);
  REQUIRE(lower(std::string(request[http::field::sec_websocket_protocol])).find("naiad.1") !=
          std::string::npos);
}

/// Answers a request like WebConnection does.
void serve(const std::string& bytes) {
  Parser parser;
  parser.header_limit(8 * 1024);
  parser.body_limit(0);
  boost::beast::error_code error;
  parser.put(boost::asio::buffer(bytes), error);
  if (error || !parser.is_done()) return requireResponse(site().responses.refusal(400, "No.\n"));
  const WebRequest& request = parser.get();
  if (boost::beast::websocket::is_upgrade(request)) {
    const auto* const refusal = site().responses.validateUpgrade(request);
    if (!refusal) return requireOwnPage(request);
    REQUIRE(refusal->status >= 400);
    return requireResponse(site().responses.refusal(refusal->status, refusal->message));
  }
  requireResponse(site().responses.response(request));
}

void readOrigin(const std::string& text) {
  const auto origin = WebOrigin::parse(text);
  if (!origin) return;
  REQUIRE(origin->port != 0 && !origin->host.empty());
  REQUIRE(origin->text().find_first_of(" /?#@\\", 8) == std::string::npos);
  const auto again = WebOrigin::parse(origin->text());
  REQUIRE(again && again->text() == origin->text() && again->port == origin->port);
  AllowedOrigins names;
  names.add(*origin);
  REQUIRE(names.allowsOrigin(origin->text()) && names.allowsHost(origin->hostText()));
  REQUIRE(!names.allowsOrigin(kOrigin) || origin->text() == kOrigin);
}

void quote(const std::string& text) {
  for (const Json::Style style : {Json::Style::kCompact, Json::Style::kAscii}) {
    const std::string quoted = Json(text).toString(style);
    const auto read = Json::parse(quoted, 0);
    REQUIRE(read && read->text() != nullptr && read->toString(style) == quoted);
  }
}

}  // namespace

void tryInput(Script script) {
  const std::uint8_t what = script.byte();
  const std::string text = script.rest();
  if (what == 0) {
    readOrigin(text);
  } else if (what == 1) {
    quote(text);
  } else {
    serve(text);
  }
}

}  // namespace naiad::fuzz

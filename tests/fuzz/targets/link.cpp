// Addresses written by strangers: links to games, keys, and addresses of servers and pages. An accepted one
// has only allowed parts, and the text made from it has an equal meaning.
//
//   input   the text
#include <algorithm>
#include <variant>

#include "Target.h"
#include "client/trust/ServerAddress.h"
#include "shared/net/stream/JoinLink.h"

namespace naiad::fuzz {
namespace {

bool isGraphicText(std::string_view text) {
  return std::ranges::all_of(text, [](char c) { return c > ' ' && c < 0x7f; });
}

/// Requires a host without characters that end a name or begin an option.
void requireHost(const std::string& host) {
  REQUIRE(!host.empty() && host.size() <= 254 && host.front() != '-');
  REQUIRE(isGraphicText(host));
  REQUIRE(host.find_first_of("/#?@%[]\\'\"$&;|<>`") == std::string::npos);
}

void readLink(std::string_view text) {
  const auto parsed = JoinLink::parse(text);
  if (const auto* const problem = std::get_if<LinkError>(&parsed)) {
    REQUIRE(!problem->message.empty());
    return;
  }
  const JoinLink& link = std::get<JoinLink>(parsed);
  REQUIRE(JoinLink::looksLikeLink(text));
  requireHost(link.address.host);
  REQUIRE(link.address.port != 0);
  REQUIRE(link.room.size() <= 32 && link.room.find_first_of("/#?@%:") == std::string::npos);
  REQUIRE(isGraphicText(link.text()));
  const auto again = JoinLink::parse(link.text());
  REQUIRE(std::holds_alternative<JoinLink>(again) && std::get<JoinLink>(again) == link);
}

/// Requires that each key has exactly one valid text, apart from upper and lower case.
void readKey(std::string_view text) {
  const auto key = ShortKey::parse(text);
  if (!key) return;
  std::string lower(text);
  for (char& c : lower) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c | 0x20 : c);
  REQUIRE(key->text() == lower);
}

/// Requires that only a slash and a fragment, which stays in the browser, may follow the host.
void readPage(const std::string& text) {
  const auto address = GatewayAddress::parse(text);
  if (!address) return;
  REQUIRE(GatewayAddress::looksLikeLink(text));
  requireHost(address->host);
  REQUIRE(text.starts_with(address->encrypted ? "https://" : "http://"));
  const std::string behind =
      text.substr(std::min(text.size(), text.find_first_of("/#", text.find("//") + 2)));
  REQUIRE(behind.empty() || behind == "/" || behind.starts_with('#') || behind.starts_with("/#"));
  const auto again = GatewayAddress::parse(address->origin() + "/");
  REQUIRE(again && again->host == address->host && again->port == address->port &&
          again->encrypted == address->encrypted);
}

/// Requires that text() and canonicalText() parse to an equal address.
void readServer(const std::string& text) {
  const auto address = ServerAddress::parse(text);
  if (!address) return;
  REQUIRE(!address->host.empty() && address->port != 0);
  REQUIRE(ServerAddress::parse(address->text()) == address);
  const auto canonical = ServerAddress::parse(address->canonicalText());
  REQUIRE(!canonical || canonical->canonicalText() == address->canonicalText());
}

void readFingerprint(std::string_view text) {
  const auto key = Fingerprint::parse(text);
  if (!key) return;
  REQUIRE(text.size() == 64 && Fingerprint::parse(key->text()) == key);
  REQUIRE(ShortKey::parse(ShortKey::of(*key).text()) == ShortKey::of(*key));
}

}  // namespace

void tryInput(Script script) {
  const std::string text = script.rest();
  readLink(text);
  readKey(text);
  readPage(text);
  readServer(text);
  readFingerprint(text);
}

}  // namespace naiad::fuzz

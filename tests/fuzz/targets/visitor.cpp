// The header of a connection to the visitors' socket. An accepted header names an address that limits can
// count, and all spellings of that address are read alike.
//
//   input   a header; also read as a text like "192.0.2.7:50312", which other doors pass on
#include "Target.h"
#include "shared/net/stream/ProxyHeader.h"

namespace naiad::fuzz {
namespace {

using asio::ip::tcp;

void requireVisitor(const tcp::endpoint& visitor) {
  const asio::ip::address& address = visitor.address();
  REQUIRE(visitor.port() != 0);
  REQUIRE(!address.is_unspecified() && !address.is_multicast());
  REQUIRE(address.is_v4() || !address.to_v6().is_v4_mapped());
  REQUIRE(!address.is_v4() || address.to_v4() != asio::ip::address_v4::broadcast());
}

void readHeader(std::string_view bytes) {
  const Exactly begin(bytes.substr(0, kProxyHeaderBegin));
  const auto rest = proxyHeaderRest(begin.view());
  if (rest) REQUIRE(*rest >= 12 && *rest <= kMaxProxyHeaderRest);
  const auto visitor = readProxyHeader(bytes);
  // A listener reads exactly this many bytes before it parses the header.
  const Exactly whole(bytes.substr(0, kProxyHeaderBegin + rest.value_or(0)));
  const auto cut = readProxyHeader(whole.view());
  if (visitor) REQUIRE(rest && bytes.size() == kProxyHeaderBegin + *rest && cut == visitor);
  if (!cut) return;
  REQUIRE(rest);
  requireVisitor(*cut);
  REQUIRE(readProxyHeader(proxyHeader(*cut)) == cut);
}

void readText(std::string_view text) {
  const auto visitor = proxiedPeerFromText(text);
  if (!visitor) return;
  requireVisitor(*visitor);
  const std::string address = visitor->address().to_string();
  const std::string again =
      (visitor->address().is_v4() ? address : "[" + address + "]") + ":" + std::to_string(visitor->port());
  REQUIRE(proxiedPeerFromText(again) == visitor);
}

}  // namespace

void tryInput(Script script) {
  const std::string bytes = script.rest();
  readHeader(bytes);
  readText(bytes);
}

}  // namespace naiad::fuzz

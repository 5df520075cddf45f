// Whom a door speaks for: the header of a connection to the visitors' socket. What is taken names an address
// that limits can count, and is read alike however it is written.
//
//   input   a header; and, as another door's program writes it, the same bytes as a text
#include "Target.h"
#include "shared/net/stream/VisitorHeader.h"

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
  const Exactly begin(bytes.substr(0, kVisitorHeaderBegin));
  const auto rest = visitorHeaderRest(begin.view());
  if (rest) REQUIRE(*rest >= 12 && *rest <= kMaxVisitorHeaderRest);
  const auto visitor = readVisitorHeader(bytes);
  // A listener reads so many bytes and no more.
  const Exactly whole(bytes.substr(0, kVisitorHeaderBegin + rest.value_or(0)));
  const auto cut = readVisitorHeader(whole.view());
  if (visitor) REQUIRE(rest && bytes.size() == kVisitorHeaderBegin + *rest && cut == visitor);
  if (!cut) return;
  REQUIRE(rest);
  requireVisitor(*cut);
  REQUIRE(readVisitorHeader(visitorHeader(*cut)) == cut);
}

void readText(std::string_view text) {
  const auto visitor = visitorFromText(text);
  if (!visitor) return;
  requireVisitor(*visitor);
  const std::string address = visitor->address().to_string();
  const std::string again =
      (visitor->address().is_v4() ? address : "[" + address + "]") + ":" + std::to_string(visitor->port());
  REQUIRE(visitorFromText(again) == visitor);
}

}  // namespace

void tryInput(Script script) {
  const std::string bytes = script.rest();
  readHeader(bytes);
  readText(bytes);
}

}  // namespace naiad::fuzz

#include "shared/net/stream/VisitorFacts.h"

#include "shared/net/stream/ByteStream.h"
#include "shared/net/stream/VisitorHeader.h"

namespace naiad {

VisitorFacts VisitorFacts::of(const AddressPrefix::Bytes& address, std::uint16_t port) {
  const asio::ip::tcp::endpoint endpoint(unmapped(asio::ip::address_v6(address)), port);
  return {visitorHeader(endpoint), peerName(endpoint), AddressPrefix(address)};
}

}  // namespace naiad

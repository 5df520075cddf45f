#include "shared/net/stream/ProxiedPeer.h"

#include "shared/net/stream/ByteStream.h"
#include "shared/net/stream/ProxyHeader.h"

namespace naiad {

ProxiedPeer ProxiedPeer::of(const AddressPrefix::Bytes& address, std::uint16_t port) {
  const asio::ip::tcp::endpoint endpoint(unmapped(asio::ip::address_v6(address)), port);
  return {proxyHeader(endpoint), peerName(endpoint), AddressPrefix(address)};
}

}  // namespace naiad

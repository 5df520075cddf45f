// The address of a door's visitor, in each form that the door needs. A door is a local program between the
// server and its visitors (ProxyListener.h).
//
// It has no Asio types: a door may be built with Boost's copy of Asio, and no source can include both.
#pragma once

#include <cstdint>
#include <string>

#include "shared/net/base/AddressPrefix.h"

namespace naiad {

struct ProxiedPeer {
  std::string header;    ///< bytes for the server's visitors' socket (ProxyHeader.h)
  std::string name;      ///< "192.0.2.7:50312"
  AddressPrefix prefix;  ///< key of per-address limits

  /// `address`: IPv6, or IPv4 mapped into it.
  static ProxiedPeer of(const AddressPrefix::Bytes& address, std::uint16_t port);
};

}  // namespace naiad

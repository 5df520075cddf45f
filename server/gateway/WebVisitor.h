// Where a connection comes from, by its socket: no header of a request counts.
#pragma once

#include <cstdint>
#include <string>

#include "shared/net/base/AddressPrefix.h"

namespace naiad {

struct WebVisitor {
  std::string header;    ///< for the server's visitors' socket (VisitorHeader.h)
  std::string name;      ///< "192.0.2.7:50312"
  AddressPrefix prefix;  ///< for limits

  /// `address`: IPv6, or IPv4 mapped into it.
  static WebVisitor of(const AddressPrefix::Bytes& address, std::uint16_t port);
};

}  // namespace naiad

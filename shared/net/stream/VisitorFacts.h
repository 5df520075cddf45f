// Where the visitor of a door comes from, in each form that the door needs.
//
// Without types of Asio: a door may be made with Boost's copy of it, and no source can include both.
#pragma once

#include <cstdint>
#include <string>

#include "shared/net/base/AddressPrefix.h"

namespace naiad {

struct VisitorFacts {
  std::string header;    ///< for the server's visitors' socket (VisitorHeader.h)
  std::string name;      ///< "192.0.2.7:50312"
  AddressPrefix prefix;  ///< for limits

  /// `address`: IPv6, or IPv4 mapped into it.
  static VisitorFacts of(const AddressPrefix::Bytes& address, std::uint16_t port);
};

}  // namespace naiad

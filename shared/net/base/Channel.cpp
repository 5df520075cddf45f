#include "shared/net/base/Channel.h"

namespace naiad {

std::string_view describe(CloseReason reason) {
  switch (reason) {
    case CloseReason::kLocal:
      return "closed here";
    case CloseReason::kPeer:
      return "the other end closed";
    case CloseReason::kError:
      return "the connection broke";
    case CloseReason::kProtocol:
      return "the other end broke the protocol";
    case CloseReason::kOverflow:
      return "the other end was too slow";
  }
  return "ended for an unknown reason";
}

std::string ReliableChannel::exportSecret(std::string_view, std::string_view, std::size_t) const {
  return {};
}

}  // namespace naiad

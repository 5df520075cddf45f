#include "shared/net/stream/ClientHelloGuard.h"

#include <algorithm>

namespace naiad {
namespace {

constexpr std::uint8_t kHandshakeRecord = 22;

}  // namespace

bool ClientHelloGuard::accept(std::string_view bytes) {
  while (!bytes.empty()) {
    if (record_left_ == 0) {
      record_header_[record_header_size_++] = static_cast<std::uint8_t>(bytes.front());
      bytes.remove_prefix(1);
      if (record_header_size_ < record_header_.size()) continue;
      record_header_size_ = 0;
      record_left_ = std::size_t{record_header_[3]} << 8 | record_header_[4];
      continue;
    }
    const std::string_view part = bytes.substr(0, std::min(record_left_, bytes.size()));
    if (record_header_[0] == kHandshakeRecord && !acceptMessages(part)) return false;
    record_left_ -= part.size();
    bytes.remove_prefix(part.size());
  }
  return true;
}

bool ClientHelloGuard::acceptMessages(std::string_view bytes) {
  while (!bytes.empty()) {
    if (message_left_ > 0) {
      const std::size_t part = std::min(message_left_, bytes.size());
      message_left_ -= part;
      bytes.remove_prefix(part);
      continue;
    }
    message_header_[message_header_size_++] = static_cast<std::uint8_t>(bytes.front());
    bytes.remove_prefix(1);
    if (message_header_size_ < message_header_.size()) continue;
    message_header_size_ = 0;
    message_left_ =
        std::size_t{message_header_[1]} << 16 | std::size_t{message_header_[2]} << 8 | message_header_[3];
    if (message_left_ > kMaxHello) return false;
  }
  return true;
}

}  // namespace naiad

#include "shared/net/datagram/SealedHeader.h"

#include "shared/values/LittleEndian.h"

namespace naiad {
namespace {

// Returns the value of the field "kind". All other values are reserved.
constexpr unsigned kindOf(SealDirection direction) {
  return direction == SealDirection::kClientToServer ? 1 : 2;
}

}  // namespace

HeaderFault readSealedHeader(SealDirection direction, std::string_view packet, SealedHeader& header) {
  if (packet.size() < smallestSealedPacket(direction)) return HeaderFault::kTooShort;
  if (packet.size() > kMaxDatagram) return HeaderFault::kTooLong;
  const auto first = static_cast<unsigned char>(packet[0]);
  if (first >> kEpochBits != kindOf(direction)) return HeaderFault::kKind;
  header.epoch_bits = first & kEpochMask;
  if (direction == SealDirection::kClientToServer) {
    header.id.value = loadLittleEndian<std::uint64_t>(packet.data() + 1);
  }
  header.sequence = loadLittleEndian<std::uint16_t>(packet.data() + sealedHeaderSize(direction) - 2);
  return HeaderFault::kNone;
}

std::size_t writeSealedPrefix(SealDirection direction, Epoch epoch, ConnectionId id, char* out) {
  out[0] = static_cast<char>(kindOf(direction) << kEpochBits | (epoch & kEpochMask));
  if (direction == SealDirection::kClientToServer) storeLittleEndian(id.value, out + 1);
  return sealedHeaderSize(direction) - 2;
}

}  // namespace naiad

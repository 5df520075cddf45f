#include <gtest/gtest.h>

#include <string>

#include "shared/net/datagram/SealedHeader.h"

namespace naiad {
namespace {

constexpr SealDirection kBoth[] = {SealDirection::kClientToServer, SealDirection::kServerToClient};

std::string packetOf(SealDirection direction, std::size_t size) {
  std::string packet(std::max(size, sealedHeaderSize(direction)), '\x7f');
  writeSealedPrefix(direction, 5, {42}, packet.data());
  packet.resize(size);
  return packet;
}

TEST(SealedHeader, LengthsHaveLimits) {
  EXPECT_EQ(smallestSealedPacket(SealDirection::kClientToServer), 28u);
  EXPECT_EQ(smallestSealedPacket(SealDirection::kServerToClient), 20u);
  for (const SealDirection direction : kBoth) {
    SealedHeader header;
    for (std::size_t size = 0; size <= 1300; ++size) {
      const HeaderFault expected = size < smallestSealedPacket(direction) ? HeaderFault::kTooShort
                                   : size > 1200                          ? HeaderFault::kTooLong
                                                                          : HeaderFault::kNone;
      ASSERT_EQ(readSealedHeader(direction, packetOf(direction, size), header), expected) << size;
    }
  }
}

TEST(SealedHeader, AllOtherKindsAreRefused) {
  for (const SealDirection direction : kBoth) {
    std::string packet = packetOf(direction, 50);
    SealedHeader header;
    int accepted = 0;
    for (int first = 0; first < 256; ++first) {
      packet[0] = static_cast<char>(first);
      const HeaderFault fault = readSealedHeader(direction, packet, header);
      if (fault == HeaderFault::kNone) {
        ++accepted;
        EXPECT_EQ(first >> 4, direction == SealDirection::kClientToServer ? 1 : 2);
      } else {
        EXPECT_EQ(fault, HeaderFault::kKind);
      }
    }
    EXPECT_EQ(accepted, 16);
  }
}

}  // namespace
}  // namespace naiad

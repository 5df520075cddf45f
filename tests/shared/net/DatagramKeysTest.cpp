#include <gtest/gtest.h>

#include <set>

#include "DatagramKeys.h"
#include "SealKit.h"

namespace naiad::test {
namespace {

constexpr ConnectionId kId{0x0123456789abcdef};

// Made with HMAC-SHA256 and a few lines of Python, from exporter_master_secret 00 01 … 1f.
TEST(DatagramKeys, KnownAnswersOfAes) {
  const DatagramKeys keys = deriveDatagramKeys(knownExporter(), AeadId::kAes128Gcm, kId, 0x13);
  EXPECT_EQ(toHex(keys.client.key.data(), 16), "908ab96aa909c31c4132142367de241a");
  EXPECT_EQ(toHex(keys.client.iv.data(), 12), "c64ae3a75494527a916a2385");
  EXPECT_EQ(toHex(keys.server.key.data(), 16), "55fa02ad23aaa78bcc66eb4a4933df59");
  EXPECT_EQ(toHex(keys.server.iv.data(), 12), "971c93bb50faa6ce88313963");
}

TEST(DatagramKeys, KnownAnswersOfChaCha) {
  const DatagramKeys keys = deriveDatagramKeys(knownExporter(), AeadId::kChaCha20Poly1305, kId, 0x13);
  EXPECT_EQ(toHex(keys.client.key.data(), 32),
            "beccef6e205bba8d4a448d625b3135be95d01182833ae48962a9b31b81284022");
  EXPECT_EQ(toHex(keys.client.iv.data(), 12), "f98f4640e63a252deaece0a9");
  EXPECT_EQ(toHex(keys.server.key.data(), 32),
            "b3c7345f330d0426cb685733ee18215d3de01357d3f28ca82cab82ed17846f1c");
  EXPECT_EQ(toHex(keys.server.iv.data(), 12), "824ead7be2f7a44df6eb15a9");
}

TEST(DatagramKeys, ExporterIsAskedForWhatThePageSays) {
  std::string label, context;
  std::size_t asked = 0;
  const KeyExporter spy = [&](std::string_view l, std::string_view c, std::size_t bytes) {
    label = l;
    context = c;
    asked = bytes;
    return std::string(bytes, 'k');
  };
  deriveDatagramKeys(spy, AeadId::kChaCha20Poly1305, kId, 0x13);
  EXPECT_EQ(label, "EXPERIMENTAL-naiad-datagram");
  EXPECT_EQ(toHex(context), "0300000002efcdab896745230113000000");
  EXPECT_EQ(asked, 88u);
}

TEST(DatagramKeys, NoTwoSessionsEpochsOrCiphersShareKeys) {
  std::set<std::string> all;
  for (const AeadId aead : kBothAeads) {
    for (const ConnectionId id : {ConnectionId{0}, ConnectionId{1}, ConnectionId{1ull << 63}}) {
      for (const Epoch epoch : {0u, 1u, 16u, 1u << 31}) {
        const DatagramKeys keys = deriveDatagramKeys(knownExporter(), aead, id, epoch);
        for (const SealKey* key : {&keys.client, &keys.server}) {
          EXPECT_EQ(key->aead, aead);
          all.insert(toHex(key->key.data(), 16));
          all.insert(toHex(key->iv.data(), 12));
        }
      }
    }
  }
  EXPECT_EQ(all.size(), 2u * 3 * 4 * 2 * 2);
}

TEST(DatagramKeys, ExporterThatFailsIsAnError) {
  for (const std::size_t size : {0u, 55u, 57u}) {
    const KeyExporter broken = [&](auto, auto, std::size_t) { return std::string(size, 'k'); };
    EXPECT_THROW(deriveDatagramKeys(broken, AeadId::kAes128Gcm, kId, 0), KeyExportError) << size;
  }
}

TEST(DatagramKeys, OnlyKnownCiphersHaveNumbers) {
  EXPECT_EQ(aeadFromWire(1), AeadId::kAes128Gcm);
  EXPECT_EQ(aeadFromWire(2), AeadId::kChaCha20Poly1305);
  for (const std::uint32_t number : {0u, 3u, 255u, 257u, 0xffffffffu}) EXPECT_FALSE(aeadFromWire(number));
}

}  // namespace
}  // namespace naiad::test

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
  EXPECT_EQ(toHex(keys.client.key.data(), 16), "dcc79784d226f89bc32145c6d412e2a9");
  EXPECT_EQ(toHex(keys.client.iv.data(), 12), "7c076190190c2b5ea574a494");
  EXPECT_EQ(toHex(keys.server.key.data(), 16), "47e7c1913b4a9e437182727006c01d08");
  EXPECT_EQ(toHex(keys.server.iv.data(), 12), "f92db1a170c83f4bc0209522");
}

TEST(DatagramKeys, KnownAnswersOfChaCha) {
  const DatagramKeys keys = deriveDatagramKeys(knownExporter(), AeadId::kChaCha20Poly1305, kId, 0x13);
  EXPECT_EQ(toHex(keys.client.key.data(), 32),
            "6cdc19ec5f5c7203a055e167f75d43474b6ff2ac7cface4825e83c8d0d55180f");
  EXPECT_EQ(toHex(keys.client.iv.data(), 12), "d0889574cc39351d2f797e20");
  EXPECT_EQ(toHex(keys.server.key.data(), 32),
            "7120610b98122e53215ff759c1c207d57753d03dda5aba271d7d829a1a27329e");
  EXPECT_EQ(toHex(keys.server.iv.data(), 12), "9197542a450836a0c7096bfc");
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
  EXPECT_EQ(toHex(context), "0200000002efcdab896745230113000000");
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

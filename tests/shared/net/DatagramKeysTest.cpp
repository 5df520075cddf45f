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
  EXPECT_EQ(toHex(keys.client.key.data(), 16), "f7816f32d4a8bc907e3ccba853045e5c");
  EXPECT_EQ(toHex(keys.client.iv.data(), 12), "d9301b0fee8215ed785fb5f6");
  EXPECT_EQ(toHex(keys.server.key.data(), 16), "a2247a5040d4ab5b402a8b042a1c4874");
  EXPECT_EQ(toHex(keys.server.iv.data(), 12), "433fa8945325bf231f5931d7");
}

TEST(DatagramKeys, KnownAnswersOfChaCha) {
  const DatagramKeys keys = deriveDatagramKeys(knownExporter(), AeadId::kChaCha20Poly1305, kId, 0x13);
  EXPECT_EQ(toHex(keys.client.key.data(), 32),
            "06a726080eb488e6e03ba569655ad82e709ffb5dbea0970109cb9765e8bcbc98");
  EXPECT_EQ(toHex(keys.client.iv.data(), 12), "6e41ddf41b741fd0709dedaa");
  EXPECT_EQ(toHex(keys.server.key.data(), 32),
            "e50c4453e29b2893e9337a1c5499a2958a794a268def0329558fd5574d8b4a1c");
  EXPECT_EQ(toHex(keys.server.iv.data(), 12), "a4a77d340635454970be1cfd");
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
  EXPECT_EQ(toHex(context), "0100000002efcdab896745230113000000");
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

#include <gtest/gtest.h>

#include <set>
#include <span>

#include "SealKit.h"
#include "shared/net/base/SafeText.h"
#include "shared/net/datagram/DatagramKeys.h"

namespace naiad::test {
namespace {

/// Returns key and initial vector in hexadecimal.
std::string hexOf(const SealKey& key, std::size_t key_size) {
  return hexText(std::span(key.key).first(key_size)) + " " + hexText(key.iv);
}

// Computed with HMAC-SHA256 in Python from the exporter_master_secret 00 01 … 1f.
TEST(DatagramKeys, MatchKnownAnswers) {
  const DatagramKeys aes = deriveDatagramKeys(knownExporter(), AeadId::kAes128Gcm, kKnownId, 0x13);
  EXPECT_EQ(hexOf(aes.client, 16), "4bf58675aeb5d26a6fb351d2ba56c3d4 84784d40194d0940a7028eaf");
  EXPECT_EQ(hexOf(aes.server, 16), "8ebd5d909a24e84b1f9686b6ddfe75f1 d644bd65fb79bc54285b075c");
  const DatagramKeys chacha = deriveDatagramKeys(knownExporter(), AeadId::kChaCha20Poly1305, kKnownId, 0x13);
  EXPECT_EQ(hexOf(chacha.client, 32),
            "1bc0cc8be1216a553b07211a30a06e3986c4f21d15c63c5cd08f3cde5ea50e01 d891b999d7072a7ac76783af");
  EXPECT_EQ(hexOf(chacha.server, 32),
            "2ac40823402de6c8644557c32cc7898c0d4c1faa52c9aaca408106344d118137 14a508dfd5a797fd08477130");
}

TEST(DatagramKeys, NoTwoSessionsEpochsOrCiphersShareKeys) {
  std::set<std::string> all;
  for (const AeadId aead : kBothAeads) {
    for (const ConnectionId id : {ConnectionId{0}, ConnectionId{1}, ConnectionId{1ull << 63}}) {
      for (const Epoch epoch : {0u, 1u, 16u, 1u << 31}) {
        const DatagramKeys keys = deriveDatagramKeys(knownExporter(), aead, id, epoch);
        for (const SealKey* key : {&keys.client, &keys.server}) {
          EXPECT_EQ(key->aead, aead);
          all.insert(hexText(std::span(key->key).first(16)));
          all.insert(hexText(key->iv));
        }
      }
    }
  }
  EXPECT_EQ(all.size(), 2u * 3 * 4 * 2 * 2);
}

TEST(DatagramKeys, FailingExporterIsAnError) {
  for (const std::size_t size : {0u, 55u, 57u}) {
    const KeyExporter broken = [&](auto, auto, std::size_t) { return std::string(size, 'k'); };
    EXPECT_THROW(deriveDatagramKeys(broken, AeadId::kAes128Gcm, kKnownId, 0), KeyExportError) << size;
  }
}

TEST(DatagramKeys, UnknownCipherNumbersAreRefused) {
  EXPECT_EQ(aeadFromWire(1), AeadId::kAes128Gcm);
  EXPECT_EQ(aeadFromWire(2), AeadId::kChaCha20Poly1305);
  for (const std::uint32_t number : {0u, 3u, 255u, 257u, 0xffffffffu}) EXPECT_FALSE(aeadFromWire(number));
}

}  // namespace
}  // namespace naiad::test

#include <gtest/gtest.h>
#include <openssl/err.h>
#include <openssl/evp.h>

#include <memory>
#include <set>
#include <utility>
#include <vector>

#include "SealKit.h"
#include "shared/net/base/SafeText.h"
#include "shared/net/datagram/Seal.h"
#include "shared/values/SplitMix64.h"

namespace naiad::test {
namespace {

using namespace std::string_literals;

constexpr std::size_t kHeader = 11;

std::string sealWith(Sealer& sealer, std::string_view payload, SealDirection direction) {
  std::string packet(kMaxDatagram, '\0');
  const std::size_t prefix = writeSealedPrefix(direction, 0x13, kKnownId, packet.data());
  packet.replace(prefix + 2, payload.size(), payload);
  packet.resize(sealer.seal(packet.data(), prefix, payload.size()));
  return packet;
}

std::string sealWith(Sealer& sealer, std::string_view payload) {
  return sealWith(sealer, payload, SealDirection::kClientToServer);
}

OpenResult openWith(Opener& opener, std::string_view packet, std::string* payload = nullptr,
                    std::uint64_t* sequence = nullptr) {
  std::string text(packet.size() - kHeader - kSealTagSize, '\0');
  std::uint64_t number = 0;
  const OpenResult result = opener.open(packet, kHeader, text.data(), number);
  if (payload) *payload = text;
  if (sequence) *sequence = number;
  return result;
}

/// Decrypts a packet in the simplest way, with a new context and a nonce made here.
std::string openPlainly(const SealKey& key, std::uint64_t sequence, std::string_view packet) {
  const std::unique_ptr<EVP_CIPHER, decltype(&EVP_CIPHER_free)> cipher(
      EVP_CIPHER_fetch(nullptr, key.aead == AeadId::kAes128Gcm ? "AES-128-GCM" : "ChaCha20-Poly1305",
                       nullptr),
      EVP_CIPHER_free);
  const std::unique_ptr<EVP_CIPHER_CTX, decltype(&EVP_CIPHER_CTX_free)> context(EVP_CIPHER_CTX_new(),
                                                                                EVP_CIPHER_CTX_free);
  auto nonce = key.iv;
  for (int byte = 11; byte >= 4; --byte, sequence >>= 8) nonce[byte] ^= sequence & 0xff;
  std::string header(packet.substr(0, kHeader)), tag(packet.substr(packet.size() - 16));
  std::string text(packet.substr(kHeader, packet.size() - kHeader - 16));
  auto* const bytes = reinterpret_cast<unsigned char*>(text.data());
  int written = 0;
  EVP_DecryptInit_ex2(context.get(), cipher.get(), key.key.data(), nonce.data(), nullptr);
  EVP_DecryptUpdate(context.get(), nullptr, &written, reinterpret_cast<unsigned char*>(header.data()),
                    kHeader);
  EVP_DecryptUpdate(context.get(), bytes, &written, bytes, static_cast<int>(text.size()));
  EVP_CIPHER_CTX_ctrl(context.get(), EVP_CTRL_AEAD_SET_TAG, 16, tag.data());
  return EVP_DecryptFinal_ex(context.get(), bytes + text.size(), &written) == 1 ? text : "<forged>";
}

/// Sealer and opener of packets from the client.
struct Ends {
  explicit Ends(AeadId aead) : keys(knownKeys(aead)) {}

  DatagramKeys keys;
  Sealer sealer{keys.client};
  Opener opener{keys.client};
};

struct KnownAnswer {
  AeadId aead;
  SealDirection direction;
  std::vector<std::string> packets;  // packets 0, 1 and 258, with the payloads "hello", "" and "\0world"
};

// Made with Python's "cryptography" by a program written from PROTOCOL.md alone.
const KnownAnswer kKnownAnswers[] = {
    {AeadId::kAes128Gcm,
     SealDirection::kClientToServer,
     {"13efcdab89674523010000664d07ba85437f9ad9df6fb60cef5479dd40a0ee71",
      "13efcdab8967452301010070ccbdf6327f0d425f95094dc2be1b3f",
      "13efcdab896745230102019461e58dbdf6e9b7ff5600b2b608743bfaf20a3f6c88"}},
    {AeadId::kAes128Gcm,
     SealDirection::kServerToClient,
     {"23000066fbca4b6285a2ea26163bab4ba10f3cdf89973d0b", "230100d6acbc8583166aff532d321f67649841",
      "23020155532c0eec30acdc963f22b43e31a1fe43d3fc8205d4"}},
    {AeadId::kChaCha20Poly1305,
     SealDirection::kClientToServer,
     {"13efcdab89674523010000619f513742324e7fb790d90ba9c471d874b7b52e95",
      "13efcdab896745230101003627efa96c619ff9a5a8779da8a7cc7b",
      "13efcdab896745230102015503972d58b9ae6daa6c9074f03643233a9482375910"}},
    {AeadId::kChaCha20Poly1305,
     SealDirection::kServerToClient,
     {"2300004135f34a7d6269c5b477f486ebe08dd6f8ae03c793", "230100878a1633f107f1065782a6d72776e88e",
      "2302012717c3d916a5ef3a5c231b3d413875a05a507ea0ffcf"}},
};

TEST(Seal, MatchesKnownAnswers) {
  for (const KnownAnswer& known : kKnownAnswers) {
    const DatagramKeys keys = knownKeys(known.aead, kKnownId, 0x13);
    Sealer sealer(known.direction == SealDirection::kClientToServer ? keys.client : keys.server);
    std::vector<std::string> packets;
    for (int number = 0; number <= 258; ++number) {
      const std::string payload = number == 0 ? "hello"s : number == 258 ? "\0world"s : ""s;
      const std::string packet = sealWith(sealer, payload, known.direction);
      if (number < 2 || number == 258) packets.push_back(hexText(packet));
    }
    EXPECT_EQ(packets, known.packets);
  }
}

TEST(Seal, PlainOpenSslOpensSealedPackets) {
  SplitMix64 rng(1);
  for (const AeadId aead : kBothAeads) {
    const DatagramKeys keys = knownKeys(aead);
    Sealer sealer(keys.client);
    for (std::uint64_t number = 0; number < 70'000; ++number) {
      const std::string payload(rng.below(number % 1000 == 0 ? 1170 : 20), static_cast<char>(rng.next()));
      const std::string packet = sealWith(sealer, payload);
      if (number < 300 || number % 97 == 0 || number > 65'500) {
        ASSERT_EQ(openPlainly(keys.client, number, packet), payload) << number;
      }
    }
  }
}

TEST(Seal, OpensAcrossManySequenceNumberWraps) {
  for (const AeadId aead : kBothAeads) {
    Ends ends(aead);
    SplitMix64 rng(2);
    std::uint64_t next_kept = 0;
    for (std::uint64_t number = 0; number < 300'000; ++number) {
      const std::string packet = sealWith(ends.sealer, "x");
      if (number != next_kept) continue;
      std::uint64_t restored = 0;
      ASSERT_EQ(openWith(ends.opener, packet, nullptr, &restored), OpenResult::kOpened) << number;
      ASSERT_EQ(restored, number);
      next_kept += 1 + rng.below(rng.below(50) == 0 ? 32'000 : 10);
    }
  }
}

TEST(Seal, EveryPacketOpensOnceInAnyOrder) {
  Ends ends(AeadId::kChaCha20Poly1305);
  std::vector<std::string> packets;
  for (int i = 0; i < 1000; ++i) packets.push_back(sealWith(ends.sealer, std::to_string(i)));
  SplitMix64 rng(4);
  std::vector<int> opened(packets.size());
  for (int i = 0; i < 20'000; ++i) {
    const auto chosen = rng.below(packets.size());
    std::string payload;
    const OpenResult result = openWith(ends.opener, packets[chosen], &payload);
    ASSERT_EQ(result, opened[chosen] ? OpenResult::kReplayed : OpenResult::kOpened);
    if (result == OpenResult::kOpened) {
      EXPECT_EQ(payload, std::to_string(chosen));
    }
    opened[chosen] = 1;
  }
  EXPECT_EQ(ends.opener.failures(), 0u);
}

TEST(Seal, EveryFlippedBitAndOtherSizeIsRefused) {
  for (const AeadId aead : kBothAeads) {
    Ends ends(aead);
    const std::string packet = sealWith(ends.sealer, "a payload of some length");
    for (std::size_t bit = 0; bit < 8 * packet.size(); ++bit) {
      std::string changed = packet;
      changed[bit / 8] = static_cast<char>(changed[bit / 8] ^ 1 << bit % 8);
      ASSERT_EQ(openWith(ends.opener, changed), OpenResult::kForged) << "bit " << bit;
    }
    EXPECT_EQ(ends.opener.failures(), 8 * packet.size());
    for (std::size_t size = kHeader + kSealTagSize; size < packet.size(); ++size)
      ASSERT_EQ(openWith(ends.opener, packet.substr(0, size)), OpenResult::kForged) << size;
    for (std::size_t more = 1; more < 40; ++more)
      ASSERT_EQ(openWith(ends.opener, packet + std::string(more, '\0')), OpenResult::kForged) << more;
    EXPECT_EQ(ERR_peek_error(), 0u);  // otherwise TLS on this thread would take the error for its own
    EXPECT_EQ(openWith(ends.opener, packet), OpenResult::kOpened);
  }
}

TEST(Seal, KeyWithTooManyForgeriesOpensNothing) {
  EXPECT_EQ(maxFailedOpens(AeadId::kAes128Gcm), std::uint64_t{1} << 52);
  EXPECT_EQ(maxFailedOpens(AeadId::kChaCha20Poly1305), std::uint64_t{1} << 36);
  const DatagramKeys keys = knownKeys(AeadId::kChaCha20Poly1305);
  Sealer sealer(keys.client);
  Opener opener(keys.client, 3);
  std::string forged = sealWith(sealer, "x");
  forged.back() = static_cast<char>(forged.back() ^ 1);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(openWith(opener, forged), OpenResult::kForged);
  EXPECT_EQ(openWith(opener, forged), OpenResult::kExhausted);
  EXPECT_EQ(openWith(opener, sealWith(sealer, "real")), OpenResult::kExhausted);
}

TEST(Seal, SealersMoveAndAreNeverCopied) {
  static_assert(!std::is_copy_constructible_v<Sealer> && !std::is_copy_assignable_v<Sealer>);
  const DatagramKeys keys = knownKeys(AeadId::kAes128Gcm);
  Sealer first(keys.client);
  Opener opener(keys.client);
  EXPECT_EQ(openWith(opener, sealWith(first, "x")), OpenResult::kOpened);
  Sealer second = std::move(first);
  EXPECT_EQ(second.sealed(), 1u);
  EXPECT_EQ(openWith(opener, sealWith(second, "x")), OpenResult::kOpened);
}

using Result = ReplayWindow::Result;

/// Computes the expected result of check() from all marked numbers.
Result plainly(const std::set<std::uint64_t>& marked, std::uint64_t sequence) {
  if (marked.contains(sequence))
    return *marked.rbegin() - sequence < ReplayWindow::kSize ? Result::kSeen : Result::kTooOld;
  const bool old = !marked.empty() && *marked.rbegin() >= sequence + ReplayWindow::kSize;
  return old ? Result::kTooOld : Result::kNew;
}

TEST(ReplayWindow, MatchesASetOfAllNumbers) {
  SplitMix64 rng(3);
  for (int round = 0; round < 60; ++round) {
    ReplayWindow window;
    std::set<std::uint64_t> marked;
    std::uint64_t around = rng.below(2) ? 0 : rng.next() >> 8;
    const std::uint64_t spread = 1 + rng.below(3000);
    for (int i = 0; i < 3000; ++i) {
      const std::uint64_t jump = rng.below(400) == 0 ? rng.below(5000) : rng.below(3);
      around += jump;
      const std::uint64_t back = rng.below(spread);
      const std::uint64_t sequence = around > back ? around - back : 0;
      const Result verdict = window.check(sequence);
      ASSERT_EQ(verdict, plainly(marked, sequence)) << "round " << round << ", number " << sequence;
      if (verdict != Result::kNew || rng.below(4) == 0)
        continue;  // some numbers are not marked, like those of forged packets
      window.mark(sequence);
      marked.insert(sequence);
      ASSERT_EQ(window.expected(), *marked.rbegin() + 1);
    }
  }
}

TEST(RestoreSequence, MatchesTheRfcExample) {
  EXPECT_EQ(expandSequence(0xa82f30ea + 1, 0x9b32), 0xa82f9b32u);  // RFC 9000, A.3
}

TEST(RestoreSequence, NearbyNumbersAreRestored) {
  SplitMix64 rng(9);
  for (int i = 0; i < 300'000; ++i) {
    const std::uint64_t expected = rng.below(3) == 0 ? rng.below(200'000) : rng.next() >> (2 + rng.below(60));
    const std::uint64_t offset = rng.below(0xffff);  // true number = expected − 32767 … expected + 32767
    if (expected + offset < 0x7fff) continue;
    const std::uint64_t truth = expected + offset - 0x7fff;
    if (truth >= std::uint64_t{1} << 62) continue;
    ASSERT_EQ(expandSequence(expected, static_cast<std::uint16_t>(truth)), truth) << expected;
  }
}

TEST(RestoreSequence, IsNeverBelowZero) {
  for (std::uint32_t wire = 0; wire <= 0xffff; ++wire)
    ASSERT_EQ(expandSequence(0, static_cast<std::uint16_t>(wire)), wire);
}

}  // namespace
}  // namespace naiad::test

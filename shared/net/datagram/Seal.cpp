#include "shared/net/datagram/Seal.h"

#include <openssl/evp.h>

#include <cassert>
#include <cstring>
#include <new>

#include "shared/values/LittleEndian.h"

namespace naiad {
namespace {

using Nonce = std::array<unsigned char, kAeadIvSize>;

enum class Mode { kOpen = 0, kSeal = 1 };

const EVP_CIPHER* cipherOf(AeadId aead) {
  return aead == AeadId::kAes128Gcm ? EVP_aes_128_gcm() : EVP_chacha20_poly1305();
}

detail::CipherContext makeContext(const SealKey& key, Mode mode) {
  detail::CipherContext context(EVP_CIPHER_CTX_new());
  if (!context || EVP_CipherInit_ex(context.get(), cipherOf(key.aead), nullptr, key.key.data(), nullptr,
                                    static_cast<int>(mode)) != 1) {
    throw std::bad_alloc();  // out of memory, because both ciphers always exist
  }
  return context;
}

Nonce nonceOf(const Nonce& iv, std::uint64_t sequence) {
  Nonce nonce = iv;
  for (std::size_t i = 0; i < 8; ++i) {
    nonce[kAeadIvSize - 1 - i] ^= static_cast<unsigned char>(sequence >> (8 * i));
  }
  return nonce;
}

const unsigned char* bytes(const char* text) {
  return reinterpret_cast<const unsigned char*>(text);
}
unsigned char* bytes(char* text) {
  return reinterpret_cast<unsigned char*>(text);
}

}  // namespace

std::uint64_t expandSequence(std::uint64_t expected, std::uint16_t wire) {
  constexpr std::uint64_t kWindow = 1u << 16;
  constexpr std::uint64_t kHalf = kWindow / 2;
  const std::uint64_t candidate = (expected & ~(kWindow - 1)) | wire;
  if (candidate + kHalf <= expected && candidate < (std::uint64_t{1} << 62) - kWindow) {
    return candidate + kWindow;
  }
  if (candidate > expected + kHalf && candidate >= kWindow) return candidate - kWindow;
  return candidate;
}

ReplayWindow::Result ReplayWindow::check(std::uint64_t sequence) const {
  if (sequence >= expected_) return Result::kNew;
  if (expected_ - sequence > kSize) return Result::kTooOld;
  return word(sequence) >> (sequence % 64) & 1 ? Result::kSeen : Result::kNew;
}

void ReplayWindow::mark(std::uint64_t sequence) {
  if (sequence >= expected_) {
    // Clears the bits of the skipped numbers, which belonged to the numbers that leave the window.
    if (sequence - expected_ >= kSize) {
      seen_.fill(0);
    } else {
      for (std::uint64_t skipped = expected_; skipped != sequence; ++skipped) {
        seen_[(skipped / 64) % seen_.size()] &= ~(std::uint64_t{1} << (skipped % 64));
      }
    }
    expected_ = sequence + 1;
  }
  seen_[(sequence / 64) % seen_.size()] |= std::uint64_t{1} << (sequence % 64);
}

std::uint64_t maxFailedOpens(AeadId aead) {
  return std::uint64_t{1} << (aead == AeadId::kAes128Gcm ? 52 : 36);
}

void detail::CipherContextDeleter::operator()(evp_cipher_ctx_st* context) const {
  EVP_CIPHER_CTX_free(context);
}

Sealer::Sealer(const SealKey& key, SealLimits limits)
    : context_(makeContext(key, Mode::kSeal)), iv_(key.iv), limits_(limits) {}

std::size_t Sealer::seal(char* packet, std::size_t prefix, std::size_t size) {
  assert(context_);
  if (exhausted()) return 0;
  const std::uint64_t sequence = next_++;
  storeLittleEndian(static_cast<std::uint16_t>(sequence), packet + prefix);
  const std::size_t header = prefix + 2;
  unsigned char* const text = bytes(packet + header);
  unsigned char* const tag = text + size;
  const Nonce nonce = nonceOf(iv_, sequence);
  EVP_CIPHER_CTX* const context = context_.get();
  int written = 0;
  const bool done =
      EVP_EncryptInit_ex(context, nullptr, nullptr, nullptr, nonce.data()) == 1 &&
      EVP_EncryptUpdate(context, nullptr, &written, bytes(packet), static_cast<int>(header)) == 1 &&
      EVP_EncryptUpdate(context, text, &written, text, static_cast<int>(size)) == 1 &&
      EVP_EncryptFinal_ex(context, tag, &written) == 1 &&
      EVP_CIPHER_CTX_ctrl(context, EVP_CTRL_AEAD_GET_TAG, kSealTagSize, tag) == 1;
  assert(done);  // cannot fail: it depends neither on the packet nor on the machine
  return done ? header + size + kSealTagSize : 0;
}

Opener::Opener(const SealKey& key, std::uint64_t max_failures)
    : context_(makeContext(key, Mode::kOpen)), iv_(key.iv), max_failures_(max_failures) {}

OpenResult Opener::check(std::uint16_t wire_sequence) const {
  if (exhausted()) return OpenResult::kExhausted;
  switch (window_.check(expandSequence(window_.expected(), wire_sequence))) {
    case ReplayWindow::Result::kNew:
      return OpenResult::kOpened;
    case ReplayWindow::Result::kSeen:
      return OpenResult::kReplayed;
    case ReplayWindow::Result::kTooOld:
      break;
  }
  return OpenResult::kTooOld;
}

OpenResult Opener::open(std::string_view packet, std::size_t header, char* payload, std::uint64_t& sequence) {
  assert(context_ && packet.size() >= header + kSealTagSize);
  const auto wire = loadLittleEndian<std::uint16_t>(packet.data() + header - 2);
  const OpenResult checked = check(wire);
  if (checked != OpenResult::kOpened) return checked;
  sequence = expandSequence(window_.expected(), wire);
  if (!decrypt(packet, header, payload, sequence)) {
    ++failures_;
    return OpenResult::kForged;
  }
  window_.mark(sequence);
  return OpenResult::kOpened;
}

bool Opener::decrypt(std::string_view packet, std::size_t header, char* payload, std::uint64_t sequence) {
  const std::size_t size = packet.size() - header - kSealTagSize;
  unsigned char tag[kSealTagSize];  // a copy, because OpenSSL needs writable bytes
  std::memcpy(tag, packet.data() + header + size, sizeof tag);
  const Nonce nonce = nonceOf(iv_, sequence);
  EVP_CIPHER_CTX* const context = context_.get();
  int written = 0;
  return EVP_DecryptInit_ex(context, nullptr, nullptr, nullptr, nonce.data()) == 1 &&
         EVP_DecryptUpdate(context, nullptr, &written, bytes(packet.data()), static_cast<int>(header)) == 1 &&
         EVP_DecryptUpdate(context, bytes(payload), &written, bytes(packet.data() + header),
                           static_cast<int>(size)) == 1 &&
         EVP_CIPHER_CTX_ctrl(context, EVP_CTRL_AEAD_SET_TAG, sizeof tag, tag) == 1 &&
         EVP_DecryptFinal_ex(context, bytes(payload) + size, &written) == 1;
}

}  // namespace naiad

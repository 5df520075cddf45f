// Sealing and opening datagrams: authenticated encryption (RFC 5116) with a counted nonce.
//
// The nonce is the IV with the 64-bit sequence number, big-endian, XORed into its last eight bytes (RFC 9001,
// 5.3). The header as sent is the associated data; its last two bytes are the low bits of the sequence
// number. Sealer and Opener keep OpenSSL's context with the expanded key, so that a packet costs no
// allocation.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>

#include "shared/net/datagram/DatagramKeys.h"

struct evp_cipher_ctx_st;

namespace naiad {

/// The full number whose low 16 bits are `wire` and which is nearest to the one expected next
/// (RFC 9000, appendix A.3): right whenever it is less than 2¹⁵ away.
std::uint64_t restoreSequence(std::uint64_t expected, std::uint16_t wire);

/// Which sequence numbers have been seen: the newest, and a bit for each of those just before it.
/// A number that is kNew may be tried; only what then proves authentic is marked. Otherwise a forger could
/// make the window forget, or shut out, what is real. (RFC 4303, 3.4.3.)
class ReplayWindow {
 public:
  /// Numbers that are still distinguished, the newest included.
  static constexpr std::uint64_t kSize = 1024;

  enum class Verdict : std::uint8_t { kNew, kSeen, kTooOld };

  /// Returns whether the number is new. Changes nothing.
  Verdict check(std::uint64_t sequence) const;
  /// Marks a number that was kNew as seen. Call after its packet was authenticated.
  void mark(std::uint64_t sequence);

  /// One more than the newest number marked; 0 before the first.
  std::uint64_t expected() const { return expected_; }

 private:
  std::uint64_t word(std::uint64_t sequence) const { return seen_[(sequence / 64) % seen_.size()]; }

  std::uint64_t expected_ = 0;
  std::array<std::uint64_t, kSize / 64> seen_{};  // a ring: bit (n mod kSize) of the last kSize numbers
};

/// Packets after which a key should be, and must be, replaced. The defaults follow RFC 9001, 6.6 and
/// appendix B: 2²³ AES-GCM packets whatever their size, 2²⁸ of at most 2 KiB.
struct SealLimits {
  std::uint64_t new_epoch_after = std::uint64_t{1} << 23;
  std::uint64_t most = std::uint64_t{1} << 28;
};

/// Failed opens after which a key must not be used any more (RFC 9001, 6.6): 2⁵² or 2³⁶.
std::uint64_t mostFailedOpens(AeadId aead);

namespace detail {

struct CipherContextDeleter {
  void operator()(evp_cipher_ctx_st* context) const;
};
using CipherContext = std::unique_ptr<evp_cipher_ctx_st, CipherContextDeleter>;

}  // namespace detail

/// Owns a key and the counter that goes with it, so no sequence number is ever used twice: it cannot be
/// copied, and one that was moved from must not be used. Not thread-safe.
class Sealer {
 public:
  /// Throws std::bad_alloc.
  explicit Sealer(const SealKey& key, SealLimits limits = {});
  Sealer(Sealer&&) noexcept = default;
  Sealer& operator=(Sealer&&) noexcept = default;

  /// Seal `size` bytes in place. `packet` holds `prefix` header bytes, two bytes that are filled in here with
  /// the sequence number, the payload, and room for the tag. Returns the size of the whole packet, or 0
  /// (and the payload is untouched) once `limits.most` packets were sealed.
  std::size_t seal(char* packet, std::size_t prefix, std::size_t size);

  /// Time to start a new epoch.
  bool wantsNewEpoch() const { return next_ >= limits_.new_epoch_after; }
  /// Nothing more can be sealed.
  bool exhausted() const { return next_ >= limits_.most; }
  /// Packets sealed so far, which is the next sequence number.
  std::uint64_t sealed() const { return next_; }

 private:
  detail::CipherContext context_;
  std::array<unsigned char, kAeadIvSize> iv_;
  SealLimits limits_;
  std::uint64_t next_ = 0;
};

enum class OpenResult : std::uint8_t {
  kOpened,
  kTooOld,     ///< behind the replay window
  kReplayed,   ///< opened before
  kForged,     ///< not sealed with this key, or changed on the way
  kExhausted,  ///< too many forgeries: this key opens nothing any more
};

/// Opens what the Sealer with the same key sealed, each packet once. When 2¹⁵ packets in a row are lost, 16
/// bits of sequence number are too few to go on, and it takes a new epoch. Not thread-safe.
class Opener {
 public:
  /// Throws std::bad_alloc.
  explicit Opener(const SealKey& key) : Opener(key, mostFailedOpens(key.aead)) {}
  Opener(const SealKey& key, std::uint64_t most_failures);
  Opener(Opener&&) noexcept = default;
  Opener& operator=(Opener&&) noexcept = default;

  /// Whether open() would get as far as decrypting; no cryptography is done. kOpened if so.
  OpenResult check(std::uint16_t wire_sequence) const;

  /// Open `packet`, whose header takes `header` bytes. `payload` has room for packet.size() − header − 16
  /// bytes; what is there is meaningless unless the result is kOpened. `sequence` is set to the full number.
  OpenResult open(std::string_view packet, std::size_t header, char* payload, std::uint64_t& sequence);

  /// Nothing more can be opened.
  bool exhausted() const { return failures_ >= most_failures_; }
  /// The other end has sealed so many at least: one more than the newest sequence number that opened.
  std::uint64_t expected() const { return window_.expected(); }
  /// Packets that were forged, all in all.
  std::uint64_t failures() const { return failures_; }

 private:
  bool decrypt(std::string_view packet, std::size_t header, char* payload, std::uint64_t sequence);

  detail::CipherContext context_;
  std::array<unsigned char, kAeadIvSize> iv_;
  ReplayWindow window_;
  std::uint64_t most_failures_;
  std::uint64_t failures_ = 0;
};

}  // namespace naiad

// Sealing and opening datagrams: authenticated encryption (RFC 5116) with a counted nonce.
//
// The nonce is the IV with the 64-bit sequence number, big-endian, XORed into its last eight bytes (RFC 9001,
// 5.3). The header is the associated data; its last two bytes are the low bits of the sequence number. Sealer
// and Opener keep OpenSSL's context with the expanded key, so packets need no allocation.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>

#include "shared/net/datagram/DatagramKeys.h"

struct evp_cipher_ctx_st;

namespace naiad {

/// Returns the full number whose low 16 bits are `wire` and that is nearest to the next expected one (RFC
/// 9000, appendix A.3). Correct if the sender's number is less than 2¹⁵ away from that.
std::uint64_t expandSequence(std::uint64_t expected, std::uint16_t wire);

/// The set of sequence numbers seen: the newest one, and a bit for each of the numbers just before it. Try to
/// open a packet whose number is kNew, and mark the number only if the packet is authentic: otherwise forged
/// packets could hide real ones (RFC 4303, 3.4.3).
class ReplayWindow {
 public:
  /// Size of the window, including the newest number.
  static constexpr std::uint64_t kSize = 1024;

  enum class Result : std::uint8_t { kNew, kSeen, kTooOld };

  /// Returns whether the number is new, was seen, or is older than the window. Changes nothing.
  Result check(std::uint64_t sequence) const;
  /// Marks a number that was kNew as seen. Call after its packet was authenticated.
  void mark(std::uint64_t sequence);

  /// One more than the newest marked number; 0 before the first.
  std::uint64_t expected() const { return expected_; }

 private:
  std::uint64_t word(std::uint64_t sequence) const { return seen_[(sequence / 64) % seen_.size()]; }

  std::uint64_t expected_ = 0;
  std::array<std::uint64_t, kSize / 64> seen_{};  // a ring: bit n mod kSize belongs to number n
};

/// Numbers of packets after which a key should be replaced (new_epoch_after) and seals no more (max). The
/// defaults follow RFC 9001, 6.6 and appendix B: 2²³ AES-GCM packets of any size, 2²⁸ of at most 2 KiB.
struct SealLimits {
  std::uint64_t new_epoch_after = std::uint64_t{1} << 23;
  std::uint64_t max = std::uint64_t{1} << 28;
};

/// Returns the number of failed opens after which a key must not be used (RFC 9001, 6.6): 2⁵² for AES-GCM,
/// 2³⁶ for ChaCha20.
std::uint64_t maxFailedOpens(AeadId aead);

namespace detail {

struct CipherContextDeleter {
  void operator()(evp_cipher_ctx_st* context) const;
};
using CipherContext = std::unique_ptr<evp_cipher_ctx_st, CipherContextDeleter>;

}  // namespace detail

/// Owns a key and its packet counter. No sequence number is used twice: the object cannot be copied, and must
/// not be used after a move. Not thread-safe.
class Sealer {
 public:
  /// Throws std::bad_alloc.
  explicit Sealer(const SealKey& key, SealLimits limits = {});
  Sealer(Sealer&&) noexcept = default;
  Sealer& operator=(Sealer&&) noexcept = default;

  /// Seals `size` bytes in place. `packet` holds `prefix` header bytes, two bytes that this fills with the
  /// sequence number, the payload, and space for the tag. Returns the size of the whole packet, or 0 (and
  /// leaves the payload unchanged) after `limits.max` packets.
  std::size_t seal(char* packet, std::size_t prefix, std::size_t size);

  /// True if a new epoch should start.
  bool needsNewEpoch() const { return next_ >= limits_.new_epoch_after; }
  /// True if no more packets can be sealed.
  bool exhausted() const { return next_ >= limits_.max; }
  /// The number of packets sealed, which is the next sequence number.
  std::uint64_t sealed() const { return next_; }

 private:
  detail::CipherContext context_;
  [[maybe_unused]] std::array<unsigned char, kAeadIvSize> iv_;  // unused in the page, which has no ciphers
  SealLimits limits_;
  std::uint64_t next_ = 0;
};

enum class OpenResult : std::uint8_t {
  kOpened,
  kTooOld,     ///< behind the replay window
  kReplayed,   ///< opened before
  kForged,     ///< not sealed with this key, or modified
  kExhausted,  ///< too many forgeries: the key opens no more packets
};

/// Opens the packets of the Sealer with this key, each once. After 2¹⁵ lost packets in a row, 16 bits no
/// longer identify the sequence number, and a new epoch is needed. Not thread-safe.
class Opener {
 public:
  /// Throws std::bad_alloc.
  explicit Opener(const SealKey& key) : Opener(key, maxFailedOpens(key.aead)) {}
  Opener(const SealKey& key, std::uint64_t max_failures);
  Opener(Opener&&) noexcept = default;
  Opener& operator=(Opener&&) noexcept = default;

  /// Returns kOpened if open() would decrypt the packet, else what open() would return. Decrypts nothing.
  OpenResult check(std::uint16_t wire_sequence) const;

  /// Opens `packet`, whose header has `header` bytes. `payload` has space for packet.size() − header − 16
  /// bytes; its content is meaningless unless the result is kOpened. Sets `sequence` to the full number.
  OpenResult open(std::string_view packet, std::size_t header, char* payload, std::uint64_t& sequence);

  /// True if no more packets can be opened.
  bool exhausted() const { return failures_ >= max_failures_; }
  /// One more than the newest opened sequence number: the other end has sealed at least this many packets.
  std::uint64_t expected() const { return window_.expected(); }
  /// The number of forged packets.
  std::uint64_t failures() const { return failures_; }

 private:
  bool decrypt(std::string_view packet, std::size_t header, char* payload, std::uint64_t sequence);

  detail::CipherContext context_;
  std::array<unsigned char, kAeadIvSize> iv_;
  ReplayWindow window_;
  std::uint64_t max_failures_;
  std::uint64_t failures_ = 0;
};

}  // namespace naiad

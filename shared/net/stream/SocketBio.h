// An OpenSSL BIO for a non-blocking socket, with a guard against long client hellos. OpenSSL's own socket BIO
// raises SIGPIPE and does not tell why it failed.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

struct bio_st;

namespace naiad {

/// Inspects a client's bytes before its handshake is done, so that it cannot make OpenSSL reserve much
/// memory.
///
/// OpenSSL accepts a ClientHello of up to 131,396 bytes and reserves memory for it as soon as it knows its
/// length. Honest ones have a few hundred bytes. A client sends only its hello messages unencrypted (a second
/// one may follow a HelloRetryRequest; RFC 8446 4, 5.1), so their headers can be read:
///
///   record   [type 1][version 2][length 2] payload      type 22: handshake messages, split anywhere
///   message  [kind 1][length 3] body
class ClientHelloGuard {
 public:
  /// The largest accepted hello in bytes. (Ours has about 300; a hybrid key share adds 1.2 KiB.)
  static constexpr std::size_t kMaxHello = 4096;

  /// Checks the client's next bytes, in any pieces. Returns false if they announce a hello above kMaxHello.
  bool accept(std::string_view bytes);

 private:
  bool acceptMessages(std::string_view bytes);

  std::array<std::uint8_t, 5> record_header_{};
  std::array<std::uint8_t, 4> message_header_{};
  std::size_t record_header_size_ = 0;
  std::size_t message_header_size_ = 0;
  std::size_t record_left_ = 0;
  std::size_t message_left_ = 0;
};

/// The state of a BIO. Must outlive the BIO and stay at its address.
struct SocketBio {
  int socket = -1;                        ///< connected, non-blocking; not owned
  bool ended = false;                     ///< the peer closed its side
  bool failed = false;                    ///< the socket failed
  bool refused = false;                   ///< `guard` refused the bytes
  std::optional<ClientHelloGuard> guard;  ///< while set, checks received bytes

  /// Returns a BIO that uses this object, for SSL_set_bio(); null if out of memory.
  bio_st* make();
};

}  // namespace naiad

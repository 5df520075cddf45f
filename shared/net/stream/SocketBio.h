// An OpenSSL BIO for a non-blocking socket, and its guard against long hellos. OpenSSL's own BIO for sockets
// raises SIGPIPE and does not tell why it failed.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

struct bio_st;

namespace naiad {

/// Looks at what a client sends before its handshake is done, and stops it from making OpenSSL reserve
/// memory.
///
/// OpenSSL accepts a ClientHello of up to 131,396 bytes and reserves for all of it when its length has come.
/// An honest one takes a few hundred bytes. The client's hello messages (a second one may follow a
/// HelloRetryRequest) are the only handshake messages that it sends in the clear (RFC 8446 4, 5.1), so their
/// headers can be read in passing:
///
///   record   [type 1][version 2][length 2] payload      type 22: handshake messages, cut anywhere
///   message  [kind 1][length 3] body
class ClientHelloGuard {
 public:
  /// Bytes of one hello. (Ours has about 300; a hybrid key share adds 1.2 KiB.)
  static constexpr std::size_t kMaxHello = 4096;

  /// The next bytes from the client, in any pieces. False if they announce a longer hello: hang up.
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

/// Must outlive the BIO and stay where it is.
struct SocketBio {
  int socket = -1;                        ///< connected, non-blocking; not owned
  bool ended = false;                     ///< the peer closed its side
  bool failed = false;                    ///< the socket did
  bool refused = false;                   ///< `guard` did
  std::optional<ClientHelloGuard> guard;  ///< while set, sees what comes in

  /// A BIO on this, for SSL_set_bio(); null if out of memory.
  bio_st* make();
};

}  // namespace naiad

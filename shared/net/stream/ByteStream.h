// A non-blocking byte stream on a connected socket: plain (PlainStream) or in TLS (TlsStream.h).
//
// It hides the difference from channels (TcpChannel.h). All calls must be on the thread that runs the
// socket's io_context. No call blocks or calls back; the caller waits for the socket and retries.
#pragma once

#include <asio/generic/stream_protocol.hpp>
#include <asio/ip/tcp.hpp>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace naiad {

class ByteStream {
 public:
  enum class Outcome {
    kDone,
    kWantsRead,      ///< Retry when the socket is readable.
    kWantsWrite,     ///< Retry when the socket is writable.
    kWantsApproval,  ///< A server has the client's whole hello; retry to continue (TlsStream::handshake).
    kEnd,            ///< The peer marked the end of the stream.
    kTruncated,      ///< The connection ended without the peer's mark.
    kBroken,         ///< The connection failed (reset, unreachable), or the peer ended it with an alert.
    kGarbage,        ///< The peer's bytes are not TLS or were modified, or the TLS handshake failed.
  };
  struct Progress {
    Outcome outcome;
    std::size_t bytes = 0;  ///< number of bytes read or written, at least one; only with kDone
  };

  /// A TCP or Unix domain socket.
  using Socket = asio::generic::stream_protocol::socket;

  /// Takes a connected socket and makes it non-blocking. TCP gets TCP_NODELAY and TCP_NOTSENT_LOWAT of 4 KiB.
  /// `peer`: "192.0.2.7:40000", the address of the other end; empty: the socket's own peer address.
  explicit ByteStream(Socket socket, std::string peer = {});
  virtual ~ByteStream() = default;
  ByteStream(const ByteStream&) = delete;
  ByteStream& operator=(const ByteStream&) = delete;

  virtual Progress read(std::span<char> into) = 0;
  /// Writes as many bytes as possible without waiting. `bytes`: not empty. After kWantsRead or kWantsWrite,
  /// the next call must begin with equal bytes, at any address, and may add more.
  virtual Progress write(std::string_view bytes) = 0;
  /// Tells the peer that nothing more follows. read() still works. May be called again.
  virtual Outcome end() = 0;
  /// True if read() may return bytes although the socket is not readable.
  virtual bool hasBufferedInput() const { return false; }
  /// See ReliableChannel::exportSecret().
  virtual std::string exportSecret(std::string_view label, std::string_view context, std::size_t bytes) const;

  /// The socket, for waiting and closing; use only read() and write() for the bytes.
  Socket& socket() { return socket_; }
  /// The peer's address: "127.0.0.1:40000" or "[::1]:40000", mapped IPv4 as IPv4; else "unknown".
  const std::string& peer() const { return peer_; }

 private:
  Socket socket_;
  std::string peer_;
};

/// Returns an address in the format of ByteStream::peer().
std::string peerName(const asio::ip::tcp::endpoint& endpoint);

class PlainStream : public ByteStream {
 public:
  using ByteStream::ByteStream;

  Progress read(std::span<char> into) override;
  Progress write(std::string_view bytes) override;
  Outcome end() override;
};

}  // namespace naiad

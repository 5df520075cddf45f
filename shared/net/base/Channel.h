// The two transports of a session, as the protocol code sees them.
//
// A ReliableChannel carries frames in order, each complete or not at all; a DatagramChannel carries packets
// that may be lost, duplicated or reordered. There are implementations for TCP, UDP and WebSockets, for a
// session whose sockets are on another thread, and, in tests, for a lossy link in virtual time. Neither
// interface blocks or is thread-safe: callbacks run on the thread of the channel's event loop.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace naiad {

/// The reason why a channel ended.
enum class CloseReason {
  kLocal,     ///< close() was called here.
  kPeer,      ///< The other end closed the connection properly.
  kError,     ///< The transport failed (reset, unreachable).
  kProtocol,  ///< The other end sent an invalid or too large frame, or ended within a frame.
  kOverflow,  ///< More bytes were queued for sending than the channel's limit allows.
};

/// Returns a phrase for logs: "the other end closed".
std::string_view describe(CloseReason reason);

class ReliableChannel {
 public:
  struct Callbacks {
    /// One whole frame arrived; the view is valid only in this call, which may close or destroy the channel.
    std::function<void(std::string_view frame)> on_frame;
    /// The channel ended. Called once, unless destroyed before; never from inside send() or close().
    std::function<void(CloseReason)> on_closed;
  };

  virtual ~ReliableChannel() = default;

  /// Begins to receive. Call once.
  virtual void start(Callbacks callbacks) = 0;
  /// Queues one frame of 1 … 65535 bytes. Ignored after close() and after the channel has ended.
  virtual void send(std::string_view frame) = 0;
  /// Returns the number of bytes from send() that have not left this machine: in this queue and the kernel's.
  virtual std::size_t unsentBytes() const = 0;
  /// Sends the queued frames for at most a second, then ends the connection.
  virtual void close() = 0;
  /// Returns the peer's address for logs, for example "127.0.0.1:40000".
  virtual std::string peerAddress() const = 0;
  /// Sets the largest frame that is accepted from the peer from now on, in bytes.
  virtual void setReceiveLimit(std::size_t bytes) = 0;
  /// Returns a secret of `bytes` bytes that only the two ends of this connection know, equal at both. Other
  /// labels, contexts, lengths and connections give other secrets (TLS exporter, RFC 8446 7.5). Empty if the
  /// channel has ended, or has no TLS connection to the other end on this thread.
  virtual std::string exportSecret(std::string_view label, std::string_view context, std::size_t bytes) const;
};

class DatagramChannel {
 public:
  virtual ~DatagramChannel() = default;

  /// Begins to receive. `on_packet` is called once per packet; the view is valid only during the call.
  virtual void start(std::function<void(std::string_view packet)> on_packet) = 0;
  /// Sends one packet of at most payloadBudget() bytes; it may be lost. Drops it if the budget is nullopt.
  virtual void send(std::string_view packet) = 0;
  /// Returns the size of the largest packet that may be sent now; nullopt if none may, for example while the
  /// other end's address is unknown.
  virtual std::optional<std::size_t> payloadBudget() const { return 1200; }
  /// Returns the peer's address for logs, for example "127.0.0.1:40000".
  virtual std::string peerAddress() const = 0;
};

}  // namespace naiad

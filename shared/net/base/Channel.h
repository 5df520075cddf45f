// The two transports of a session, as the protocol code sees them.
//
// A ReliableChannel carries frames in order, each complete or not at all; a DatagramChannel carries packets
// that may be lost, duplicated or reordered. The implementations are TCP, UDP and a lossy in-process link in
// virtual time. Neither interface blocks or is thread-safe: callbacks run on the thread of the channel's
// event loop.
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
  kProtocol,  ///< The other end sent an invalid frame, or one over the limit.
  kOverflow,  ///< More bytes were queued for sending than the channel's limit allows.
};

/// Returns a phrase for logs: "the other end closed".
std::string_view describe(CloseReason reason);

class ReliableChannel {
 public:
  struct Callbacks {
    /// One whole frame arrived. The view is valid only during the call. The callee may close the channel.
    std::function<void(std::string_view frame)> on_frame;
    /// The channel ended. Called once, never from inside send() or close().
    std::function<void(CloseReason)> on_closed;
  };

  virtual ~ReliableChannel() = default;

  /// Begins to receive. Call once.
  virtual void start(Callbacks callbacks) = 0;
  /// Queues one frame (<= the channel's send limit). Ignored after close().
  virtual void send(std::string_view frame) = 0;
  /// Returns the number of bytes accepted by send() that have not left this machine: those in this queue and
  /// in the kernel's.
  virtual std::size_t unsentBytes() const = 0;
  /// Sends the queued frames for at most a second, then ends the connection.
  virtual void close() = 0;
  /// Returns the peer's address for logs, for example "127.0.0.1:40000".
  virtual std::string peerAddress() const = 0;
  /// Sets the largest frame that is accepted from the peer from now on, in bytes.
  virtual void setReceiveLimit(std::size_t bytes) = 0;
  /// Returns a secret of `bytes` bytes that only the two ends of this connection know, equal at both. Other
  /// labels, contexts, lengths and connections give other secrets (TLS exporter, RFC 8446 7.5). Empty if the
  /// channel is not encrypted or has ended.
  virtual std::string exportSecret(std::string_view label, std::string_view context, std::size_t bytes) const;
};

class DatagramChannel {
 public:
  virtual ~DatagramChannel() = default;

  /// Begins to receive. `on_packet` is called once per packet; the view is valid only during the call.
  virtual void start(std::function<void(std::string_view packet)> on_packet) = 0;
  /// Sends one packet (<= 1200 bytes); it may be lost.
  virtual void send(std::string_view packet) = 0;
  /// Returns the size of the largest packet that may be sent now; nullopt while the other end's address is
  /// unknown.
  virtual std::optional<std::size_t> payloadBudget() const { return 1200; }
  /// Returns the peer's address for logs, for example "127.0.0.1:40000".
  virtual std::string peerAddress() const = 0;
};

}  // namespace naiad

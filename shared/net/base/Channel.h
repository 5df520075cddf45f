// The two transports a session is built on, as the protocol code sees them.
//
// A ReliableChannel carries frames in order, each whole or not at all; a DatagramChannel carries packets
// that may be lost, doubled or reordered. TCP and a lossy in-process link in virtual time stand behind
// them; the protocol code is the same for both. Neither interface blocks, and neither is thread-safe:
// callbacks come on the thread that runs the channel's event loop.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace naiad {

/// Why a channel ended.
enum class CloseReason {
  kLocal,     ///< close() was called here.
  kPeer,      ///< The other end closed in order.
  kError,     ///< The transport failed (reset, unreachable).
  kProtocol,  ///< The other end sent bytes that are no frame, or a frame over the limit.
  kOverflow,  ///< More was queued for sending than the channel's cap allows.
};

/// A phrase for logs: "the other end closed", …
std::string_view describe(CloseReason reason);

class ReliableChannel {
 public:
  struct Callbacks {
    /// One whole frame arrived. The view is valid during the call only. The callee may close the channel.
    std::function<void(std::string_view frame)> on_frame;
    /// The channel is finished; called once, never from inside send() or close().
    std::function<void(CloseReason)> on_closed;
  };

  virtual ~ReliableChannel() = default;

  /// Begin to receive. Call once.
  virtual void start(Callbacks callbacks) = 0;
  /// Queue one frame (<= the sending limit of the channel). Ignored after close.
  virtual void send(std::string_view frame) = 0;
  /// Bytes accepted by send() that have not left this machine yet: the queue here and the kernel's.
  virtual std::size_t unsentBytes() const = 0;
  /// Finish: what is queued is still sent (for at most a second), then the connection ends.
  virtual void close() = 0;
  /// "127.0.0.1:40000", for logs.
  virtual std::string peerAddress() const = 0;
  /// The largest frame accepted from the peer from now on, in bytes.
  virtual void setReceiveLimit(std::size_t bytes) = 0;
  /// `bytes` secret bytes for `label` and `context` that only the two ends of this connection know: the same
  /// at both, others for any other label, context, length or connection (the TLS exporter, RFC 8446 7.5).
  /// Empty where the channel is not encrypted, and after it ended.
  virtual std::string exportSecret(std::string_view label, std::string_view context, std::size_t bytes) const;
};

class DatagramChannel {
 public:
  virtual ~DatagramChannel() = default;

  /// Begin to receive: `on_packet` is called once per packet; the view is valid during the call only.
  virtual void start(std::function<void(std::string_view packet)> on_packet) = 0;
  /// Send one packet (<= 1200 bytes); it may never arrive.
  virtual void send(std::string_view packet) = 0;
  /// The largest packet that may be sent now; nothing if none may (the other end's address is not known).
  virtual std::optional<std::size_t> room() const { return 1200; }
  /// "127.0.0.1:40000", for logs.
  virtual std::string peerAddress() const = 0;
};

}  // namespace naiad

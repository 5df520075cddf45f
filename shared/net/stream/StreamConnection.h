// Frames (StreamFraming.h) over a stream of bytes: the one state machine behind every channel on a TCP
// socket, encrypted or not. TcpChannel.h says what it promises.
#pragma once

#include <asio/steady_timer.hpp>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

#include "shared/net/base/Channel.h"
#include "shared/net/stream/ByteStream.h"
#include "shared/net/stream/StreamFraming.h"
#include "shared/net/stream/TcpOptions.h"

namespace naiad {

/// Handlers under way share it, so the channel that started them may go first.
class StreamConnection : public std::enable_shared_from_this<StreamConnection> {
 public:
  /// `stream`: ready for bytes both ways (a handshake is over). `framing`: may have been fed bytes already.
  StreamConnection(std::unique_ptr<ByteStream> stream, std::unique_ptr<StreamFraming> framing,
                   const TcpOptions& options);

  void start(ReliableChannel::Callbacks callbacks);
  void send(std::string_view frame);
  std::size_t unsentBytes();
  void close();
  /// The channel is being destroyed.
  void abandon();

  const std::string& peer() const { return peer_; }
  void setReceiveLimit(std::size_t bytes) { framing_->setLimit(bytes); }
  std::string exportSecret(std::string_view label, std::string_view context, std::size_t bytes) const;

 private:
  enum class Phase { kOpen, kClosing, kClosed };

  using Outcome = ByteStream::Outcome;

  void awaitInput(Outcome wish = Outcome::kWantsRead);
  void onInput();
  void dispatch(std::string_view bytes);
  void sendReplies();
  void onInputEnded(Outcome outcome);
  void pump();
  void postPump();
  void awaitRoom(Outcome wish);
  void dropWritten();
  void onWriteFailed();
  void endStream();
  void sendEnd();
  void finish(CloseReason reason, bool cut);
  void report();
  std::size_t queuedBytes() const { return queue_.size() - written_; }
  std::size_t bytesInKernel();

  std::unique_ptr<ByteStream> stream_;
  asio::steady_timer deadline_;
  TcpOptions options_;
  std::string peer_;
  std::unique_ptr<StreamFraming> framing_;
  std::shared_ptr<ReliableChannel::Callbacks> callbacks_;  // shared with the call that is running
  std::string queue_;
  std::size_t written_ = 0;  // bytes at the front of the queue that the kernel took
  Phase phase_ = Phase::kOpen;
  CloseReason reason_ = CloseReason::kLocal;
  bool pump_posted_ = false;
  bool reading_ = false;
  bool awaiting_room_ = false;
  bool write_failed_ = false;
  bool counts_unread_ = false;  // the kernel does not know what is unsent, only what is unread
};

}  // namespace naiad

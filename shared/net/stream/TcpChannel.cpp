#include "shared/net/stream/TcpChannel.h"

#include <linux/sockios.h>
#include <sys/ioctl.h>

#include <array>
#include <asio/post.hpp>
#include <asio/steady_timer.hpp>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "shared/net/base/AddressPrefix.h"

namespace naiad {
namespace {

/// Frames (StreamFraming) over a stream of bytes: the state machine of all channels on a TCP socket,
/// encrypted or not. Pending handlers share it, so the channel may be destroyed before them.
class StreamConnection : public std::enable_shared_from_this<StreamConnection> {
 public:
  /// `stream`: its handshake is over. `framing`: may have been fed bytes already.
  StreamConnection(std::unique_ptr<ByteStream> stream, std::unique_ptr<StreamFraming> framing,
                   const TcpOptions& options);

  void start(ReliableChannel::Callbacks callbacks);
  void send(std::string_view frame);
  std::size_t unsentBytes();
  void close();
  /// Called by the channel's destructor.
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
  std::shared_ptr<ReliableChannel::Callbacks> callbacks_;  // shared with the running call
  std::string queue_;
  std::size_t written_ = 0;  // bytes at the front of the queue that the kernel accepted
  Phase phase_ = Phase::kOpen;
  CloseReason reason_ = CloseReason::kLocal;
  bool pump_posted_ = false;
  bool reading_ = false;
  bool awaiting_room_ = false;
  bool write_failed_ = false;
  bool counts_unread_ = false;  // true if the kernel reports the peer's unread bytes, not unsent ones
};

using asio::ip::tcp;

constexpr std::size_t kReadSize = 16'384;      // bytes read per turn, for fairness: one TLS record
constexpr std::size_t kKeptCapacity = 65'536;  // a queue that grew beyond this frees its memory

tcp::socket::wait_type waitFor(ByteStream::Outcome wish) {
  return wish == ByteStream::Outcome::kWantsWrite ? tcp::socket::wait_write : tcp::socket::wait_read;
}

StreamConnection::StreamConnection(std::unique_ptr<ByteStream> stream, std::unique_ptr<StreamFraming> framing,
                                   const TcpOptions& options)
    : stream_(std::move(stream)),
      deadline_(stream_->socket().get_executor()),
      options_(options),
      peer_(stream_->peer()),
      framing_(std::move(framing)) {}

void StreamConnection::start(ReliableChannel::Callbacks callbacks) {
  if (callbacks_) throw std::logic_error("the channel has already been started");
  callbacks_ = std::make_shared<ReliableChannel::Callbacks>(std::move(callbacks));
  if (phase_ == Phase::kClosed) return report();
  if (framing_->midFrame()) {
    asio::post(stream_->socket().get_executor(), [self = shared_from_this()] {
      if (self->phase_ == Phase::kOpen) self->dispatch({});
    });
  }
  awaitInput();
}

// Input. Waits for readiness instead of reading into its own buffer, so an idle connection needs no memory
// except for a partial frame.

void StreamConnection::awaitInput(Outcome wish) {
  if (reading_) return;
  reading_ = true;
  auto go_on = [self = shared_from_this()](const std::error_code&) {
    self->reading_ = false;
    if (self->phase_ != Phase::kClosed) self->onInput();
  };
  if (stream_->hasBufferedInput() && wish == Outcome::kWantsRead) {
    asio::post(stream_->socket().get_executor(), [go_on = std::move(go_on)] { go_on({}); });
  } else {
    stream_->socket().async_wait(waitFor(wish), std::move(go_on));
  }
}

void StreamConnection::onInput() {
  std::array<char, kReadSize> buffer;
  const auto [outcome, size] = stream_->read(buffer);
  if (outcome == Outcome::kWantsRead || outcome == Outcome::kWantsWrite) {
    awaitInput(outcome);
  } else if (outcome != Outcome::kDone) {
    onInputEnded(outcome);
  } else {
    if (phase_ == Phase::kOpen) dispatch({buffer.data(), size});
    if (phase_ != Phase::kClosed) awaitInput();
  }
}

void StreamConnection::dispatch(std::string_view bytes) {
  const auto callbacks = callbacks_;  // a frame's handler may destroy the channel
  framing_->feed(bytes);
  while (phase_ == Phase::kOpen) {
    const auto frame = framing_->next();
    if (!frame) break;
    if (callbacks->on_frame) callbacks->on_frame(*frame);
  }
  if (phase_ != Phase::kOpen) return;
  if (framing_->isBroken()) return finish(CloseReason::kProtocol, false);
  if (const auto reason = framing_->peerClosed()) {
    sendEnd();
    return finish(*reason, false);
  }
  sendReplies();
}

void StreamConnection::sendReplies() {
  const std::size_t before = queue_.size();
  framing_->appendReplies(queue_);
  if (queue_.size() == before) return;
  queuedBytes() > options_.send_cap ? finish(CloseReason::kOverflow, true) : postPump();
}

void StreamConnection::onInputEnded(Outcome outcome) {
  const bool ended = outcome == Outcome::kEnd || outcome == Outcome::kTruncated;
  if (phase_ == Phase::kClosing) {
    finish(CloseReason::kLocal, false);
  } else if (outcome == Outcome::kGarbage || (ended && framing_->midFrame() && !write_failed_)) {
    finish(CloseReason::kProtocol, false);
  } else {
    finish(outcome == Outcome::kEnd && !write_failed_ ? CloseReason::kPeer : CloseReason::kError, false);
  }
}

// Output. send() only queues; one posted call writes everything that was queued in this turn.

void StreamConnection::send(std::string_view frame) {
  if (phase_ != Phase::kOpen || write_failed_) return;
  const std::size_t before = queuedBytes();
  if (before + kFrameHeaderSize + frame.size() > options_.send_cap && frame.size() <= kMaxFramePayload) {
    finish(CloseReason::kOverflow, true);
    return;
  }
  framing_->append(queue_, frame);
  postPump();
}

void StreamConnection::postPump() {
  if (pump_posted_) return;
  pump_posted_ = true;
  asio::post(stream_->socket().get_executor(), [self = shared_from_this()] {
    self->pump_posted_ = false;
    self->pump();
  });
}

std::size_t StreamConnection::unsentBytes() {
  if (phase_ == Phase::kClosed || write_failed_) return 0;
  return queuedBytes() + bytesInKernel();
}

// Unix domain sockets support only SIOCOUTQ, which returns the memory that unread bytes take at the other
// program: more than their number.
std::size_t StreamConnection::bytesInKernel() {
  const int socket = stream_->socket().native_handle();
  int bytes = 0;
  if (!counts_unread_ && ioctl(socket, SIOCOUTQNSD, &bytes) != 0) counts_unread_ = true;
  if (counts_unread_ && ioctl(socket, SIOCOUTQ, &bytes) != 0) return 0;
  return bytes > 0 ? static_cast<std::size_t>(bytes) : 0;
}

std::string StreamConnection::exportSecret(std::string_view label, std::string_view context,
                                           std::size_t bytes) const {
  return phase_ == Phase::kClosed ? std::string() : stream_->exportSecret(label, context, bytes);
}

void StreamConnection::pump() {
  if (phase_ == Phase::kClosed || write_failed_ || awaiting_room_) return;
  while (queuedBytes() > 0) {
    const auto [outcome, size] = stream_->write(std::string_view(queue_).substr(written_));
    if (outcome == Outcome::kWantsWrite || outcome == Outcome::kWantsRead) {
      if (written_ > queue_.size() / 2) dropWritten();
      awaitRoom(outcome);
      return;
    }
    if (outcome != Outcome::kDone) {
      onWriteFailed();
      return;
    }
    written_ += size;
  }
  dropWritten();
  if (phase_ == Phase::kClosing) endStream();
}

void StreamConnection::awaitRoom(Outcome wish) {
  awaiting_room_ = true;
  stream_->socket().async_wait(waitFor(wish), [self = shared_from_this()](const std::error_code&) {
    self->awaiting_room_ = false;
    self->pump();
  });
}

void StreamConnection::dropWritten() {
  queue_.erase(0, written_);
  written_ = 0;
  if (queue_.empty() && queue_.capacity() > kKeptCapacity) std::string().swap(queue_);
}

/// Continues to read, because frames received before the failure may still wait in the kernel. The stream's
/// end follows them.
void StreamConnection::onWriteFailed() {
  write_failed_ = true;
  if (phase_ == Phase::kClosing) finish(CloseReason::kLocal, false);
}

// The end.

void StreamConnection::close() {
  if (phase_ != Phase::kOpen) return;
  phase_ = Phase::kClosing;
  deadline_.expires_after(options_.close_timeout);
  deadline_.async_wait([self = shared_from_this()](const std::error_code& error) {
    if (!error && self->phase_ == Phase::kClosing) self->finish(CloseReason::kLocal, self->queuedBytes() > 0);
  });
  if (write_failed_) return finish(CloseReason::kLocal, false);
  framing_->appendEnd(queue_);
  awaitInput();
  pump();
}

/// Ends the stream after everything was sent. Closing now would reset the connection if the peer's last bytes
/// are unread, and the reset could overtake our bytes. So announce the end, and read until the peer closes.
void StreamConnection::endStream() {
  const Outcome outcome = stream_->end();
  if (outcome == Outcome::kWantsWrite || outcome == Outcome::kWantsRead) {
    awaitRoom(outcome);
  } else if (outcome != Outcome::kDone) {
    finish(CloseReason::kLocal, false);
  }
}

void StreamConnection::abandon() {
  callbacks_.reset();
  if (phase_ == Phase::kOpen) finish(CloseReason::kLocal, false);
}

/// `cut`: reset the connection, which discards the kernel's queue, because the peer does not read it.
void StreamConnection::finish(CloseReason reason, bool cut) {
  phase_ = Phase::kClosed;
  reason_ = reason;
  std::error_code ignored;
  if (cut) {
    stream_->socket().set_option(tcp::socket::linger(true, 0), ignored);
  } else if (reason != CloseReason::kError && !write_failed_) {
    sendEnd();
    stream_->end();  // sends the end without waiting
  }
  stream_->socket().close(ignored);
  deadline_.cancel();
  std::string().swap(queue_);
  written_ = 0;
  report();
}

/// Sends the framing's end frame as far as possible without waiting.
void StreamConnection::sendEnd() {
  const std::size_t before = queue_.size();
  framing_->appendEnd(queue_);
  if (queue_.size() == before) return;
  while (queuedBytes() > 0) {
    const auto [outcome, size] = stream_->write(std::string_view(queue_).substr(written_));
    if (outcome != Outcome::kDone) return;
    written_ += size;
  }
}

void StreamConnection::report() {
  if (!callbacks_) return;
  asio::post(stream_->socket().get_executor(), [self = shared_from_this()] {
    const auto callbacks = std::move(self->callbacks_);  // null if the channel was destroyed
    if (callbacks && callbacks->on_closed) callbacks->on_closed(self->reason_);
  });
}

class FramedChannel : public ReliableChannel {
 public:
  FramedChannel(std::unique_ptr<ByteStream> stream, std::unique_ptr<StreamFraming> framing,
                const TcpOptions& options)
      : connection_(std::make_shared<StreamConnection>(std::move(stream), std::move(framing), options)) {}
  ~FramedChannel() override { connection_->abandon(); }

  void start(Callbacks callbacks) override { connection_->start(std::move(callbacks)); }
  void send(std::string_view frame) override { connection_->send(frame); }
  std::size_t unsentBytes() const override { return connection_->unsentBytes(); }
  void close() override { connection_->close(); }
  std::string peerAddress() const override { return connection_->peer(); }
  void setReceiveLimit(std::size_t bytes) override { connection_->setReceiveLimit(bytes); }

 protected:
  std::shared_ptr<StreamConnection> connection_;
};

class TcpChannel : public FramedChannel {
 public:
  using FramedChannel::FramedChannel;

  std::string exportSecret(std::string_view label, std::string_view context,
                           std::size_t bytes) const override {
    return connection_->exportSecret(label, context, bytes);
  }
};

}  // namespace

std::unique_ptr<ReliableChannel> makeTcpChannel(asio::ip::tcp::socket socket, TcpOptions options) {
  return makeTcpChannel(std::make_unique<PlainStream>(std::move(socket)), options);
}

std::unique_ptr<ReliableChannel> makeTcpChannel(std::unique_ptr<ByteStream> stream, TcpOptions options) {
  return std::make_unique<TcpChannel>(std::move(stream),
                                      std::make_unique<LengthFraming>(options.receive_limit), options);
}

std::unique_ptr<ReliableChannel> makeFramedChannel(std::unique_ptr<ByteStream> stream,
                                                   std::unique_ptr<StreamFraming> framing,
                                                   TcpOptions options) {
  return std::make_unique<FramedChannel>(std::move(stream), std::move(framing), options);
}

bool isLoopback(const asio::ip::address& address) {
  return unmapped(address).is_loopback();
}

}  // namespace naiad

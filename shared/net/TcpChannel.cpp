#include "TcpChannel.h"

#include <linux/sockios.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <array>
#include <asio/buffer.hpp>
#include <asio/post.hpp>
#include <asio/steady_timer.hpp>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "Framing.h"

namespace naiad {
namespace {

using asio::ip::tcp;

constexpr int kNotSentLowWater = 4096;         // bytes the kernel takes beyond what it could send
constexpr std::size_t kReadSize = 16'384;      // one read per turn of the loop, for fairness
constexpr std::size_t kKeptCapacity = 65'536;  // a queue that grew beyond this is given back

/// The connection itself. Handlers under way share it, so the channel that started them may go first.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(tcp::socket socket, const TcpOptions& options);

  void start(ReliableChannel::Callbacks callbacks);
  void send(std::string_view frame);
  std::size_t unsentBytes();
  void close();
  /// The channel is being destroyed.
  void abandon();

  const std::string& peer() const { return peer_; }
  void setReceiveLimit(std::size_t bytes) { reader_.setLimit(bytes); }

 private:
  enum class Phase { kOpen, kClosing, kClosed };

  void awaitInput();
  void onReadable();
  void dispatch(std::string_view bytes);
  void onInputEnded(CloseReason reason);
  void pump();
  void awaitRoom();
  void dropWritten();
  void onWriteFailed();
  void endStream();
  void finish(CloseReason reason, bool cut);
  void report();
  std::size_t queuedBytes() const { return queue_.size() - written_; }

  tcp::socket socket_;
  asio::steady_timer deadline_;
  TcpOptions options_;
  std::string peer_;
  FrameReader reader_;
  std::shared_ptr<ReliableChannel::Callbacks> callbacks_;  // shared with the call that is running
  std::string queue_;
  std::size_t written_ = 0;  // bytes at the front of the queue that the kernel took
  Phase phase_ = Phase::kOpen;
  CloseReason reason_ = CloseReason::kLocal;
  bool pump_posted_ = false;
  bool reading_ = false;
  bool awaiting_room_ = false;
  bool write_failed_ = false;
};

std::string nameOf(const tcp::socket& socket) {
  std::error_code error;
  const tcp::endpoint endpoint = socket.remote_endpoint(error);
  if (error) return "unknown";
  std::ostringstream text;
  text << endpoint;
  return text.str();
}

Connection::Connection(tcp::socket socket, const TcpOptions& options)
    : socket_(std::move(socket)),
      deadline_(socket_.get_executor()),
      options_(options),
      peer_(nameOf(socket_)),
      reader_(options.receive_limit) {
  // A socket that is broken already fails here and again, visibly, on the first read.
  std::error_code ignored;
  socket_.non_blocking(true, ignored);
  socket_.set_option(tcp::no_delay(true), ignored);
  setsockopt(socket_.native_handle(), IPPROTO_TCP, TCP_NOTSENT_LOWAT, &kNotSentLowWater,
             sizeof kNotSentLowWater);
}

void Connection::start(ReliableChannel::Callbacks callbacks) {
  if (callbacks_) throw std::logic_error("a channel can be started once");
  callbacks_ = std::make_shared<ReliableChannel::Callbacks>(std::move(callbacks));
  if (phase_ == Phase::kClosed) return report();
  awaitInput();
}

// Input. Waiting for readiness instead of reading into a buffer of its own: an idle connection then holds
// no memory but a partial frame.

void Connection::awaitInput() {
  if (reading_) return;
  reading_ = true;
  socket_.async_wait(tcp::socket::wait_read, [self = shared_from_this()](const std::error_code&) {
    self->reading_ = false;
    if (self->phase_ != Phase::kClosed) self->onReadable();
  });
}

void Connection::onReadable() {
  std::array<char, kReadSize> buffer;
  std::error_code error;
  const std::size_t size = socket_.read_some(asio::buffer(buffer), error);
  if (error == asio::error::would_block || error == asio::error::interrupted) {
    awaitInput();
  } else if (error) {
    onInputEnded(error == asio::error::eof && !write_failed_ ? CloseReason::kPeer : CloseReason::kError);
  } else {
    if (phase_ == Phase::kOpen) dispatch({buffer.data(), size});
    if (phase_ != Phase::kClosed) awaitInput();
  }
}

void Connection::dispatch(std::string_view bytes) {
  const auto callbacks = callbacks_;  // a frame's handler may destroy the channel
  reader_.feed(bytes);
  while (phase_ == Phase::kOpen) {
    const auto frame = reader_.next();
    if (!frame) break;
    if (callbacks->on_frame) callbacks->on_frame(*frame);
  }
  if (phase_ == Phase::kOpen && reader_.error() != FrameError::kNone) finish(CloseReason::kProtocol, false);
}

void Connection::onInputEnded(CloseReason reason) {
  if (phase_ == Phase::kClosing) {
    finish(CloseReason::kLocal, false);
  } else if (reason == CloseReason::kPeer && reader_.midFrame()) {
    finish(CloseReason::kProtocol, false);
  } else {
    finish(reason, false);
  }
}

// Output. send() only queues; one posted call hands everything queued in this turn to one write.

void Connection::send(std::string_view frame) {
  if (phase_ != Phase::kOpen || write_failed_) return;
  const std::size_t before = queuedBytes();
  if (before + kFrameHeaderSize + frame.size() > options_.send_cap && frame.size() <= kMaxFramePayload) {
    finish(CloseReason::kOverflow, true);
    return;
  }
  appendFrame(queue_, frame);
  if (pump_posted_) return;
  pump_posted_ = true;
  asio::post(socket_.get_executor(), [self = shared_from_this()] {
    self->pump_posted_ = false;
    self->pump();
  });
}

std::size_t Connection::unsentBytes() {
  if (phase_ == Phase::kClosed || write_failed_) return 0;
  int in_kernel = 0;
  if (ioctl(socket_.native_handle(), SIOCOUTQNSD, &in_kernel) != 0 || in_kernel < 0) in_kernel = 0;
  return queuedBytes() + static_cast<std::size_t>(in_kernel);
}

void Connection::pump() {
  if (phase_ == Phase::kClosed || write_failed_ || awaiting_room_) return;
  while (queuedBytes() > 0) {
    std::error_code error;
    written_ += socket_.write_some(asio::buffer(queue_) + written_, error);
    if (error == asio::error::would_block) {
      if (written_ > queue_.size() / 2) dropWritten();
      awaitRoom();
      return;
    }
    if (error && error != asio::error::interrupted) {
      onWriteFailed();
      return;
    }
  }
  dropWritten();
  if (phase_ == Phase::kClosing) endStream();
}

void Connection::awaitRoom() {
  awaiting_room_ = true;
  socket_.async_wait(tcp::socket::wait_write, [self = shared_from_this()](const std::error_code&) {
    self->awaiting_room_ = false;
    self->pump();
  });
}

void Connection::dropWritten() {
  queue_.erase(0, written_);
  written_ = 0;
  if (queue_.empty() && queue_.capacity() > kKeptCapacity) std::string().swap(queue_);
}

/// Frames that came before the failure may still wait in the kernel; reading finds the end after them.
void Connection::onWriteFailed() {
  write_failed_ = true;
  if (phase_ == Phase::kClosing) finish(CloseReason::kLocal, false);
}

// The end.

void Connection::close() {
  if (phase_ != Phase::kOpen) return;
  phase_ = Phase::kClosing;
  deadline_.expires_after(options_.close_timeout);
  deadline_.async_wait([self = shared_from_this()](const std::error_code& error) {
    if (!error && self->phase_ == Phase::kClosing) self->finish(CloseReason::kLocal, self->queuedBytes() > 0);
  });
  if (write_failed_) return finish(CloseReason::kLocal, false);
  awaitInput();
  pump();
}

/// Everything is sent. Closing now would reset the connection if the peer's last bytes are unread, and the
/// reset could overtake ours; so say that this was all, and read until the peer closes as well.
void Connection::endStream() {
  std::error_code error;
  socket_.shutdown(tcp::socket::shutdown_send, error);
  if (error) finish(CloseReason::kLocal, false);
}

void Connection::abandon() {
  callbacks_.reset();
  if (phase_ == Phase::kOpen) finish(CloseReason::kLocal, false);
}

/// `cut`: throw away what the kernel still holds, instead of leaving it there for a peer that does not read.
void Connection::finish(CloseReason reason, bool cut) {
  phase_ = Phase::kClosed;
  reason_ = reason;
  std::error_code ignored;
  if (cut) socket_.set_option(tcp::socket::linger(true, 0), ignored);
  socket_.close(ignored);
  deadline_.cancel();
  std::string().swap(queue_);
  written_ = 0;
  report();
}

void Connection::report() {
  if (!callbacks_) return;
  asio::post(socket_.get_executor(), [self = shared_from_this()] {
    const auto callbacks = std::move(self->callbacks_);  // none if the channel was destroyed meanwhile
    if (callbacks && callbacks->on_closed) callbacks->on_closed(self->reason_);
  });
}

class TcpChannel : public ReliableChannel {
 public:
  TcpChannel(tcp::socket socket, const TcpOptions& options)
      : connection_(std::make_shared<Connection>(std::move(socket), options)) {}
  ~TcpChannel() override { connection_->abandon(); }

  void start(Callbacks callbacks) override { connection_->start(std::move(callbacks)); }
  void send(std::string_view frame) override { connection_->send(frame); }
  std::size_t unsentBytes() const override { return connection_->unsentBytes(); }
  void close() override { connection_->close(); }
  std::string peerAddress() const override { return connection_->peer(); }
  void setReceiveLimit(std::size_t bytes) override { connection_->setReceiveLimit(bytes); }

 private:
  std::shared_ptr<Connection> connection_;
};

}  // namespace

std::unique_ptr<ReliableChannel> makeTcpChannel(tcp::socket socket, TcpOptions options) {
  return std::make_unique<TcpChannel>(std::move(socket), options);
}

bool isLoopback(const asio::ip::address& address) {
  if (address.is_v6() && address.to_v6().is_v4_mapped()) {
    return asio::ip::make_address_v4(asio::ip::v4_mapped, address.to_v6()).is_loopback();
  }
  return address.is_loopback();
}

}  // namespace naiad

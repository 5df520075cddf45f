#include "shared/net/stream/TlsHandshake.h"

#include <utility>

namespace naiad {

using asio::ip::tcp;

TlsHandshake::TlsHandshake(std::unique_ptr<TlsStream> stream)
    : stream_(std::move(stream)), timer_(stream_->socket().get_executor()) {}

void TlsHandshake::run(std::chrono::milliseconds timeout, Done done) {
  done_ = std::move(done);
  timer_.start(timeout, [self = shared_from_this()] { self->finish(End::kTimedOut); });
  // OpenSSL takes memory for a handshake when it is called first: not before an idle client has said
  // something.
  await(stream_->speaksFirst() ? tcp::socket::wait_write : tcp::socket::wait_read);
}

void TlsHandshake::step() {
  if (!done_) return;
  const auto outcome = stream_->handshake();
  if (outcome == ByteStream::Outcome::kDone) return finish(End::kDone);
  if (outcome != ByteStream::Outcome::kWantsRead && outcome != ByteStream::Outcome::kWantsWrite) {
    return finish(End::kFailed);
  }
  await(outcome == ByteStream::Outcome::kWantsWrite ? tcp::socket::wait_write : tcp::socket::wait_read);
}

void TlsHandshake::await(tcp::socket::wait_type readiness) {
  stream_->socket().async_wait(readiness,
                               [self = shared_from_this()](const std::error_code&) { self->step(); });
}

void TlsHandshake::finish(End end) {
  if (!done_) return;
  const Done call = std::exchange(done_, nullptr);
  timer_.cancel();
  const std::string problem = stream_->problem();
  auto stream = std::move(stream_);
  if (end != End::kDone) stream.reset();  // hangs up
  call(end, std::move(stream), problem);
}

void TlsHandshake::cancel() {
  if (!std::exchange(done_, nullptr)) return;
  timer_.cancel();
  std::error_code ignored;
  stream_->socket().close(ignored);
}

}  // namespace naiad

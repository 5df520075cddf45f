#include "shared/net/stream/TlsHandshake.h"

#include <utility>

namespace naiad {

using asio::ip::tcp;

TlsHandshake::TlsHandshake(std::unique_ptr<TlsStream> stream)
    : stream_(std::move(stream)), timer_(stream_->socket().get_executor()) {}

void TlsHandshake::run(std::chrono::milliseconds timeout, Done done, std::function<void()> on_hello) {
  done_ = std::move(done);
  on_hello_ = std::move(on_hello);
  setTimeout(timeout);
  // OpenSSL takes memory for a handshake when it is called first: not before an idle client has said
  // something.
  await(stream_->speaksFirst() ? tcp::socket::wait_write : tcp::socket::wait_read);
}

void TlsHandshake::setTimeout(std::chrono::milliseconds timeout) {
  timer_.start(timeout, [self = shared_from_this()] { self->finish(End::kTimedOut); });
}

void TlsHandshake::readAhead() {
  std::error_code error;
  if (!done_ || stream_->socket().available(error) == 0) return;
  ++waits_;  // the one under way is over: step() begins another one
  stream_->socket().cancel(error);
  step();
}

void TlsHandshake::step() {
  if (!done_) return;
  const auto self = shared_from_this();  // a callback may let go of it
  auto outcome = stream_->handshake();
  if (outcome == ByteStream::Outcome::kWantsJudgement) {
    if (on_hello_) std::exchange(on_hello_, nullptr)();
    if (!done_) return;
    outcome = stream_->handshake();
  }
  if (outcome == ByteStream::Outcome::kDone) return finish(End::kDone);
  if (outcome != ByteStream::Outcome::kWantsRead && outcome != ByteStream::Outcome::kWantsWrite) {
    return finish(stream_->isHungUp() ? End::kHungUp : End::kFailed);
  }
  await(outcome == ByteStream::Outcome::kWantsWrite ? tcp::socket::wait_write : tcp::socket::wait_read);
}

void TlsHandshake::await(tcp::socket::wait_type readiness) {
  stream_->socket().async_wait(readiness,
                               [self = shared_from_this(), number = ++waits_](const std::error_code&) {
                                 if (number == self->waits_) self->step();
                               });
}

void TlsHandshake::finish(End end) {
  if (!done_) return;
  const Done call = std::exchange(done_, nullptr);
  on_hello_ = nullptr;
  timer_.cancel();
  const std::string problem = stream_->problem();
  auto stream = std::move(stream_);
  if (end != End::kDone) stream.reset();  // hangs up
  call(end, std::move(stream), problem);
}

void TlsHandshake::cancel() {
  if (!std::exchange(done_, nullptr)) return;
  on_hello_ = nullptr;
  timer_.cancel();
  std::error_code ignored;
  stream_->socket().close(ignored);
}

}  // namespace naiad

#include "shared/net/http/HttpExchange.h"

#include <array>
#include <asio/io_context.hpp>
#include <asio/ip/address.hpp>
#include <asio/post.hpp>

namespace naiad {
namespace {

using asio::ip::tcp;

constexpr std::size_t kReadSize = 16'384;  // bytes read per turn of the event loop: one TLS record
constexpr unsigned kSwitchingProtocols = 101;
constexpr unsigned kOk = 200;

HttpExchange::End endOf(StreamResult::End end) {
  using End = HttpExchange::End;
  switch (end) {
    case StreamResult::End::kNotFound:
      return End::kNotFound;
    case StreamResult::End::kOtherMachine:
    case StreamResult::End::kNotAllowed:
      return End::kOtherMachine;
    case StreamResult::End::kHandshake:
    case StreamResult::End::kUnusable:
      return End::kUntrusted;
    case StreamResult::End::kTimedOut:
      return End::kTimedOut;
    default:
      return End::kUnreachable;
  }
}

const char* inWords(HttpError error) {
  switch (error) {
    case HttpError::kHeadTooLong:
      return "the header is too long";
    case HttpError::kTruncated:
      return "the answer is incomplete";
    default:
      return "not HTTP/1.1";
  }
}

}  // namespace

std::string HttpRequest::text() const {
  std::string text = method + " " + target + " HTTP/1.1\r\nHost: " + host + "\r\n";
  for (const auto& [name, value] : fields) text.append(name).append(": ").append(value).append("\r\n");
  if (!body.empty()) text += "Content-Length: " + std::to_string(body.size()) + "\r\n";
  return text + "\r\n" + body;
}

HttpExchange::HttpExchange(asio::io_context& context, const HttpLimits& limits)
    : m_context(context), m_reader(limits), m_timer(context) {}

void HttpExchange::run(const StreamTarget& server, const HttpRequest& request,
                       std::chrono::milliseconds timeout, Done done, BodyHandler on_body) {
  m_done = std::move(done);
  m_on_body = std::move(on_body);
  m_request = request.text();
  m_timer.start(timeout, [self = shared_from_this()] { self->finish(End::kTimedOut); });
  // The timer keeps this alive while the attempt runs; a reference in the attempt would be a cycle.
  m_attempt = std::make_shared<StreamAttempt>(m_context, server, timeout,
                                              [this](StreamResult result) { onStream(std::move(result)); });
  std::error_code is_name;
  const auto address = asio::ip::make_address(server.host, is_name);
  is_name ? m_attempt->resolve() : m_attempt->connect({{address, server.port}});
}

void HttpExchange::onStream(StreamResult result) {
  const auto self = shared_from_this();
  if (!result.stream) return finish(endOf(result.end), result.detail);
  m_stream = std::move(result.stream);
  write();
}

void HttpExchange::write() {
  while (m_written < m_request.size()) {
    const auto [outcome, size] = m_stream->write(std::string_view(m_request).substr(m_written));
    if (outcome == Outcome::kWantsRead || outcome == Outcome::kWantsWrite)
      return await(outcome, &HttpExchange::write);
    if (outcome != Outcome::kDone) return finish(End::kConnectionLost);
    m_written += size;
  }
  if (m_on_body) m_timer.cancel();
  await(Outcome::kWantsRead, &HttpExchange::read);
}

void HttpExchange::read() {
  std::array<char, kReadSize> buffer;
  const auto [outcome, size] = m_stream->read(buffer);
  if (outcome == Outcome::kWantsRead || outcome == Outcome::kWantsWrite)
    return await(outcome, &HttpExchange::read);
  if (outcome == Outcome::kDone) return handleBytes({buffer.data(), size});
  m_reader.feedEnd(outcome == Outcome::kEnd);
  checkProgress();
}

void HttpExchange::handleBytes(std::string_view bytes) {
  m_reader.feed(bytes);
  if (m_reader.isDone()) m_behind = bytes;
  if (m_on_body && m_reader.hasHead()) {
    const unsigned status = m_reader.status();
    if (status != kOk) return finish(End::kBadAnswer, "status " + std::to_string(status));
    if (!m_on_body(m_reader.popBody())) return finish(End::kStopped);
  }
  checkProgress();
}

/// Continues to read, unless the answer is complete or refused.
void HttpExchange::checkProgress() {
  const HttpError error = m_reader.error();
  if (error == HttpError::kBodyTooLong) return finish(End::kTooLong);
  if (error != HttpError::kNone) return finish(End::kBadAnswer, inWords(error));
  if (m_reader.isDone()) return finish(End::kAnswered);
  await(Outcome::kWantsRead, &HttpExchange::read);
}

void HttpExchange::await(Outcome wish, void (HttpExchange::*step)()) {
  if (!m_done) return;  // a handler of the body has called cancel()
  auto resume = [self = shared_from_this(), step](const std::error_code&) {
    if (self->m_done) (*self.*step)();
  };
  if (wish == Outcome::kWantsRead && m_stream->hasBufferedInput()) {
    asio::post(m_context, [resume = std::move(resume)] { resume({}); });
  } else {
    m_stream->socket().async_wait(
        wish == Outcome::kWantsWrite ? tcp::socket::wait_write : tcp::socket::wait_read, std::move(resume));
  }
}

void HttpExchange::finish(End end, const std::string& detail) {
  const Done call = std::exchange(m_done, nullptr);
  if (!call) return;
  const bool switches = end == End::kAnswered && m_reader.status() == kSwitchingProtocols;
  if (!switches) stop();
  m_timer.cancel();
  call({end, detail});
}

void HttpExchange::stop() {
  m_timer.cancel();
  if (m_attempt) m_attempt->cancel();
  if (!m_stream) return;
  m_stream->end();  // sends the end without waiting
  std::error_code ignored;
  m_stream->socket().close(ignored);
}

void HttpExchange::cancel() {
  m_done = nullptr;
  stop();
}

}  // namespace naiad

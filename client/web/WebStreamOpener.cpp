#include "client/web/WebStreamOpener.h"

#include <utility>

#include "shared/net/base/Limits.h"
#include "shared/net/base/SafeText.h"
#include "shared/net/base/WebSocketProtocol.h"

namespace naiad {

class WebStreamOpener::Channel : public ReliableChannel {
 public:
  Channel(WebStreamOpener& streams, int stream) : m_streams(streams), m_stream(stream) {
    m_streams.m_channels[stream] = this;
  }
  ~Channel() override { close(); }

  void start(Callbacks callbacks) override { m_callbacks = std::move(callbacks); }
  void send(std::string_view frame) override {
    if (m_open) m_streams.m_port.send(m_stream, frame);
  }
  std::size_t unsentBytes() const override { return m_open ? m_streams.m_port.unsentBytes(m_stream) : 0; }
  void close() override {
    if (!forget()) return;
    m_streams.m_port.close(m_stream);
  }
  std::string peerAddress() const override { return "gateway"; }
  void setReceiveLimit(std::size_t bytes) override { m_limit = bytes; }

  void receive(std::string_view message) {
    if (message.empty() || message.size() > m_limit) return end(CloseReason::kProtocol);
    // The callee may destroy this channel.
    const auto on_frame = m_callbacks.on_frame;
    if (on_frame) on_frame(message);
  }
  /// Reports the end of the stream. The callee may destroy this channel.
  void end(CloseReason reason) {
    if (reason == CloseReason::kProtocol) m_streams.m_port.close(m_stream);
    forget();
    const auto on_closed = std::exchange(m_callbacks, {}).on_closed;
    if (on_closed) on_closed(reason);
  }

 private:
  bool forget() {
    if (!std::exchange(m_open, false)) return false;
    m_streams.m_channels.erase(m_stream);
    return true;
  }

  WebStreamOpener& m_streams;
  int m_stream;
  bool m_open = true;
  std::size_t m_limit = kMaxServerFrame;
  Callbacks m_callbacks;
};

void WebStreamOpener::begin(Attempt& attempt, Done done) {
  drop(attempt);
  attempt.stream = ++m_newest;
  attempt.done = std::move(done);
  m_port.open(attempt.stream);
}

void WebStreamOpener::drop(Attempt& attempt) {
  if (attempt.stream != 0) m_port.close(attempt.stream);
  attempt = {};
}

void WebStreamOpener::cancel() {
  drop(m_first);
  drop(m_second);
}

WebStreamOpener::Attempt* WebStreamOpener::find(int stream) {
  if (stream != 0 && stream == m_first.stream) return &m_first;
  return stream != 0 && stream == m_second.stream ? &m_second : nullptr;
}

void WebStreamOpener::fail(Attempt& attempt, const std::string& message) {
  const Done done = std::exchange(attempt, {}).done;
  done(nullptr, message);
}

void WebStreamOpener::opened(int stream) {
  Attempt* p_attempt = find(stream);
  if (p_attempt == nullptr) return;
  const Done done = std::exchange(*p_attempt, {}).done;
  done(std::make_unique<Channel>(*this, stream), "");
}

void WebStreamOpener::received(int stream, std::string_view message) {
  const auto channel = m_channels.find(stream);
  if (channel == m_channels.end()) return;
  m_refusal.clear();
  m_crowded = false;
  channel->second->receive(message);
}

void WebStreamOpener::closed(int stream, int code, std::string_view reason) {
  Attempt* p_attempt = find(stream);
  const auto channel = m_channels.find(stream);
  if (p_attempt == nullptr && channel == m_channels.end()) return;
  if (code >= static_cast<int>(GatewayCloseCode::kUnreachable) &&
      code <= static_cast<int>(GatewayCloseCode::kFull))
    m_refusal = safeText(std::string(reason), kMaxMessageLength);
  m_crowded = code == static_cast<int>(GatewayCloseCode::kFull);
  m_final = m_final || code == static_cast<int>(GatewayCloseCode::kWrongKey);
  if (p_attempt != nullptr)
    return fail(*p_attempt, m_refusal.empty() ? "The game's gateway does not answer." : m_refusal);
  channel->second->end(code == static_cast<int>(GatewayCloseCode::kEnded) ? CloseReason::kPeer
                                                                          : CloseReason::kError);
}

void WebStreamOpener::update(Time now) {
  for (Attempt* p_attempt : {&m_first, &m_second}) {
    if (p_attempt->stream == 0) continue;
    if (!p_attempt->until) p_attempt->until = now + kOpenTimeout;
    if (now < *p_attempt->until) continue;
    m_port.close(p_attempt->stream);
    fail(*p_attempt, "The game's gateway does not answer.");
  }
}

}  // namespace naiad

#include "client/session/GatewayStreams.h"

#include <asio/io_context.hpp>
#include <asio/post.hpp>
#include <utility>

namespace naiad {

/// What is heard from a socket, on the bots' thread.
class GatewayStreams::Line : public std::enable_shared_from_this<Line> {
 public:
  void open(asio::io_context& context, WebSocketThread& thread, const GatewayAddress& address, Done done) {
    m_done = std::move(done);
    const auto post = [&context, line = shared_from_this()](auto call) {
      asio::post(context, [line, call = std::move(call)] { call(*line); });
    };
    socket = WebSocket::open(thread, address,
                             {[post](std::string error) { post([error](Line& line) { line.take(error); }); },
                              [post](std::string frame) {
                                post([frame = std::move(frame)](Line& line) {
                                  if (const auto call = line.callbacks.on_frame) call(frame);
                                });
                              },
                              [post](bool in_order) {
                                post([in_order](Line& line) {
                                  const auto call = std::exchange(line.callbacks, {}).on_closed;
                                  if (call) call(in_order ? CloseReason::kPeer : CloseReason::kError);
                                });
                              }});
  }
  /// Close it; no callback is called any more.
  void drop() {
    m_done = nullptr;
    callbacks = {};
    socket->close();
  }

  std::shared_ptr<WebSocket> socket;
  ReliableChannel::Callbacks callbacks;

 private:
  void take(const std::string& error);

  Done m_done;
};

class GatewayStreams::Channel : public ReliableChannel {
 public:
  explicit Channel(std::shared_ptr<Line> line) : m_line(std::move(line)) {}
  ~Channel() override { close(); }

  void start(Callbacks callbacks) override { m_line->callbacks = std::move(callbacks); }
  void send(std::string_view frame) override {
    if (!m_closed) m_line->socket->send(std::string(frame));
  }
  std::size_t unsentBytes() const override { return m_line->socket->unsentBytes(); }
  void close() override {
    if (!std::exchange(m_closed, true)) m_line->drop();
  }
  std::string peerAddress() const override { return "gateway"; }
  void setReceiveLimit(std::size_t) override {}  // the WebSocket's is that of the protocol

 private:
  std::shared_ptr<Line> m_line;
  bool m_closed = false;
};

void GatewayStreams::Line::take(const std::string& error) {
  const Done done = std::exchange(m_done, nullptr);
  if (!done) return;
  if (!error.empty()) return done(nullptr, error);
  done(std::make_unique<Channel>(shared_from_this()), "");
}

GatewayStreams::GatewayStreams(asio::io_context& context, GatewayAddress address)
    : m_context(context), m_address(std::move(address)) {}

GatewayStreams::~GatewayStreams() {
  cancel();
}

void GatewayStreams::begin(std::shared_ptr<Line>& attempt, Done done) {
  if (attempt) attempt->drop();
  attempt = std::make_shared<Line>();
  attempt->open(
      m_context, *m_thread, m_address,
      [&attempt, done = std::move(done)](std::unique_ptr<ReliableChannel> channel, const std::string& error) {
        attempt.reset();
        done(std::move(channel), error);
      });
}

void GatewayStreams::cancel() {
  for (std::shared_ptr<Line>* attempt : {&m_first, &m_second}) {
    if (*attempt) std::exchange(*attempt, nullptr)->drop();
  }
}

}  // namespace naiad

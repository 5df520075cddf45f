// Opens streams through a gateway for browsers (server/gateway) as its page does, so that bots can take the
// page's place: each stream is a WebSocket on a connection of its own.
#pragma once

#include <asio/ts/netfwd.hpp>
#include <memory>
#include <optional>
#include <string>

#include "client/session/StreamOpener.h"
#include "client/session/WebSocket.h"

namespace naiad {

/// Thread: the one that runs `context`, which must outlive it, and the channels that it made.
class GatewayStreams : public StreamOpener {
 public:
  GatewayStreams(asio::io_context& context, GatewayAddress address);
  ~GatewayStreams() override;

  void open(Done done) override { begin(m_first, std::move(done)); }
  void openSecond(Done done) override { begin(m_second, std::move(done)); }
  void cancel() override;
  /// The gateway stands for its server, as in a page; the system's trust store judges it.
  std::optional<Fingerprint> key() const override { return keyBehindGateway(); }
  std::optional<Fingerprint> secondKey() const override { return key(); }
  std::string whyUntrusted() const override { return {}; }
  bool wasHungUpOn() const override { return false; }

 private:
  class Line;
  class Channel;
  void begin(std::shared_ptr<Line>& attempt, Done done);

  asio::io_context& m_context;
  std::shared_ptr<WebSocketThread> m_thread = WebSocketThread::common();
  GatewayAddress m_address;
  std::shared_ptr<Line> m_first;
  std::shared_ptr<Line> m_second;
};

}  // namespace naiad

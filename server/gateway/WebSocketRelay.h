// A WebSocket (RFC 6455) that carries one stream of a player. Each binary message is the payload of one frame
// (Framing.h), in both directions.
//
// The gateway connects to the server when the browser has sent its first message, a hello. Until then the
// WebSocket counts as one of the PendingConnections. Then data flows like this:
//
//   down   Read at most 4 KiB from dfserver, write the complete messages at once, and wait until at most
//          4 KiB are unsent to the browser before the next read. So the server notices a slow browser and
//          skips snapshots, instead of old snapshots queueing here. After stall_timeout of waiting, the
//          WebSocket is closed (4002).
//   up     Read all available messages of the browser, and write them to dfserver as frames, at once.
//
// Data is never held back to wait for more. The buffers hold at most one frame and 4 KiB down, and one frame
// and 2 KiB up, in addition to the sockets' own buffers.
//
// Beast reads, and writes the responses to pings and the close. Messages to the browser are written here,
// because Beast would write each of them separately. They have a simple header (RFC 6455 5.2).
#pragma once

#include <array>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <memory>
#include <string>
#include <string_view>

#include "server/gateway/GatewayState.h"
#include "server/gateway/SecureSocket.h"
#include "server/gateway/UpstreamLink.h"
#include "shared/net/base/TokenBucket.h"
#include "shared/net/base/WebSocketProtocol.h"
#include "shared/net/stream/Framing.h"

namespace naiad {

/// Use on the gateway's thread.
class WebSocketRelay : public GatewayConnection {
 public:
  WebSocketRelay(GatewayState& gateway, SecureSocket socket, ProxiedPeer visitor,
                 PendingConnections::Slot slot);

  /// Accepts an upgrade request that has passed validateUpgrade(), and begins to relay.
  void accept(const WebRequest& request);

  void onSweep(Time now) override;
  void onDeadline() override;
  void shutDown() override;
  void disconnect() override;

 private:
  using WebSocket = boost::beast::websocket::stream<SecureSocket, false>;
  enum class Phase { kHello, kOpening, kPlaying, kClosing, kOver };

  void prepareSocket();
  void onControl(boost::beast::websocket::frame_type kind);
  void onActivity();
  void ping();
  void readUp();
  void onUp(error_code error, std::size_t size);
  void openLink();
  void onLinkAttemptEnd(UpstreamLink::End end, const std::string& problem);
  void queueUp();
  void batchUp();
  void flushBatch();
  bool flushUp();

  void readDown();
  void onDown(error_code error, std::size_t size);
  void writeDown();
  void awaitWritable();

  void close(GatewayCloseCode code, std::string_view reason);
  void sendClose();
  void closeWithoutServer(std::string_view reason = "The game's server cannot be reached.");
  bool isOver() const { return m_phase == Phase::kOver; }

  static constexpr std::size_t kReadSize = 4096;

  GatewayState& m_gateway;
  WebSocket m_socket;
  ProxiedPeer m_visitor;
  PendingConnections::Slot m_pending_slot;
  VisitorSlots::Slot m_slot;
  std::shared_ptr<UpstreamLink> m_link;
  Phase m_phase = Phase::kHello;
  boost::beast::flat_buffer m_up;  // a message from the browser
  bool m_is_reading_up = false;
  bool m_server_blocked = false;       // the server accepts no more data, so the browser is not read
  bool m_is_batching = false;          // a call of flushBatch() is posted
  bool m_batch_grew = false;           // a message has arrived since flushBatch() was posted
  std::array<char, kReadSize> m_down;  // data from the server
  FrameReader m_frames;                // splits the data from the server into frames
  boost::beast::websocket::close_reason m_close;
  bool m_close_sent = false;
  Time m_ping_at = Time::max();  // time of the next ping; Time::max() while no data is read from the browser
  bool m_is_pinged = false;      // a ping was sent since the browser last sent anything
  bool m_ping_waits = false;     // a ping is still being sent
  TokenBucket m_controls;        // limit of the browser's pings and pongs
};

}  // namespace naiad

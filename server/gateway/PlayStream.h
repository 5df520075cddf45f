// One WebSocket (RFC 6455), which carries one stream of a player: each binary message is the payload of one
// frame (Framing.h), in both directions.
//
// The server is connected when the browser has sent its first message, a hello; until then the WebSocket is
// one of the newcomers. Then
//
//   down   dfserver -> at most 4 KiB read -> messages, in one write -> wait until at most 4 KiB are unsent
//          towards the browser -> the next. So the server notices a slow browser, and skips snapshots,
//          instead of old ones waiting here.
//   up     those of the browser's messages that are there -> frames, in one write -> dfserver -> the next.
//
// Nothing waits for more to come. Down at most one frame and 4 KiB are held, up one frame and 2 KiB, beside
// what the sockets hold.
//
// Beast reads, and writes what is about the WebSocket itself: answers to pings, and the close. Messages to
// the browser are written here, for Beast would write each for itself: their form is one header (RFC
// 6455 5.2).
#pragma once

#include <array>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <memory>
#include <string>
#include <string_view>

#include "server/gateway/GameLink.h"
#include "server/gateway/GatewayState.h"
#include "server/gateway/SecureSocket.h"
#include "shared/net/base/TokenBucket.h"
#include "shared/net/base/WebDoor.h"
#include "shared/net/stream/Framing.h"

namespace naiad {

/// Thread: the gateway's.
class PlayStream : public Guest {
 public:
  PlayStream(GatewayState& gateway, SecureSocket socket, VisitorFacts visitor, Newcomers::Place place);

  /// Answer the upgrade, which was judged, and go on.
  void accept(const WebRequest& request);

  void onSweep(Time now) override;
  void onDeadline() override;
  void endService() override;
  void hangUp() override;

 private:
  using WebSocket = boost::beast::websocket::stream<SecureSocket, false>;
  enum class Phase { kHello, kOpening, kPlaying, kClosing, kOver };

  void prepareSocket();
  void onControl(boost::beast::websocket::frame_type kind);
  void noteLife();
  void ping();
  void readUp();
  void onUp(error_code error, std::size_t size);
  void openLink();
  void onLink(GameLink::End end, const std::string& problem);
  void putUp();
  void gatherUp();
  void onGathered();
  bool flushUp();

  void readDown();
  void onDown(error_code error, std::size_t size);
  void writeDown();
  void awaitRoom();

  void close(PlayClose code, std::string_view reason);
  void sendClose();
  void closeWithoutServer();
  bool isOver() const { return m_phase == Phase::kOver; }

  static constexpr std::size_t kReadSize = 4096;

  GatewayState& m_gateway;
  WebSocket m_socket;
  VisitorFacts m_visitor;
  Newcomers::Place m_newcomer;
  VisitorPlaces::Place m_place;
  std::shared_ptr<GameLink> m_link;
  Phase m_phase = Phase::kHello;
  boost::beast::flat_buffer m_up;  // one message
  bool m_is_reading_up = false;
  bool m_server_waits = false;         // it takes no more: nothing is read meanwhile
  bool m_is_gathering = false;         // onGathered() is about to come,
  bool m_has_gathered = false;         // and there was a message since it was asked for
  std::array<char, kReadSize> m_down;  // pieces of the server's stream
  FrameReader m_frames;                // cuts them
  boost::beast::websocket::close_reason m_close;
  bool m_close_sent = false;
  Time m_ping_at = Time::max();  // while the browser is read and silent
  bool m_is_pinged = false;      // since it was heard last
  bool m_ping_waits = false;     // to be sent
  TokenBucket m_controls;        // pings and pongs of the browser
};

}  // namespace naiad

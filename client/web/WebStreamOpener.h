// Opens streams through WebSockets (RFC 6455) to a gateway (server/gateway): each binary message is a frame.
//
// The browser checks the gateway's certificate; the gateway checks the server's key. So the server's key is
// not known here; a constant stands for "the server behind the gateway".
#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "client/session/ServerMessages.h"
#include "client/session/StreamOpener.h"

namespace naiad {

/// Interface of the client in a browser to its JavaScript page (page/page.js). Tests implement it, too.
///
/// The client numbers streams from 1; no number is reused. The page reports the events of streams to
/// WebStreamOpener, but never during a call of this interface.
class PageBridge {
 public:
  virtual ~PageBridge() = default;

  /// Opens a WebSocket to the gateway.
  virtual void open(int stream) = 0;
  /// Sends one frame as one binary message.
  virtual void send(int stream, std::string_view frame) = 0;
  /// Returns the number of bytes passed to send() that have not been sent yet.
  virtual std::size_t unsentBytes(int stream) = 0;
  /// Closes the stream after everything queued is sent. The page must not report further events of it.
  virtual void close(int stream) = 0;
  /// Stores the token as long as the tab exists, reloads included; empty: removes it.
  virtual void saveToken(std::string_view token) = 0;
  /// Called when the game played, paused or stopped a sound. `own`: this player caused it, or no player did.
  virtual void sound(const SoundLine& sound, bool own) = 0;
};

class WebStreamOpener : public StreamOpener {
 public:
  using Time = std::chrono::steady_clock::time_point;

  static constexpr std::chrono::seconds kOpenTimeout{5};

  /// `port` must outlive this.
  explicit WebStreamOpener(PageBridge& port) : m_port(port) {}

  void open(Done done) override { begin(m_first, std::move(done)); }
  void openSecond(Done done) override { begin(m_second, std::move(done)); }
  void cancel() override;
  std::optional<Fingerprint> key() const override { return keyBehindGateway(); }
  std::optional<Fingerprint> keyOfSecond() const override { return keyBehindGateway(); }
  std::string trustError() const override { return {}; }
  bool closedDuringHandshake() const override { return m_crowded; }

  // Events of a stream, reported by the page.
  void opened(int stream);
  void received(int stream, std::string_view message);
  /// `code`: from the close frame; 1006 if there was none. `reason`: a message of the gateway, or empty.
  void closed(int stream, int code, std::string_view reason);

  /// Handles timeouts. Call about ten times a second.
  void update(Time now);
  /// Returns a sentence why the gateway last refused a stream; empty once a stream has received a message.
  const std::string& refusal() const { return m_refusal; }
  /// True if the refusal is final: a retry would fail in this way, too.
  bool isRefusalFinal() const { return m_final; }

 private:
  class Channel;
  struct Attempt {
    int stream = 0;  ///< 0: no attempt
    Done done;
    std::optional<Time> until;  ///< deadline of the attempt, set by the first update()
  };
  void begin(Attempt& attempt, Done done);
  void drop(Attempt& attempt);
  Attempt* find(int stream);
  void fail(Attempt& attempt, const std::string& message);

  PageBridge& m_port;
  int m_newest = 0;
  Attempt m_first;
  Attempt m_second;
  std::map<int, Channel*> m_channels;  ///< open channels by stream number
  std::string m_refusal;
  bool m_crowded = false;
  bool m_final = false;
};

}  // namespace naiad

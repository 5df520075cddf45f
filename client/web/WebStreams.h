// Streams through WebSockets (RFC 6455) to a gateway (server/gateway): each binary message is a frame.
//
// The gateway is trusted with everything, by its certificate, which the browser checks; it checks the
// server's key. So there is no key to be seen here: one that stands for "the server behind the gateway" takes
// its place.
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

/// What the client in a browser needs from the page around it. The page is JavaScript (page/page.js); tests
/// stand in for it.
///
/// Streams are numbered by the client, from 1 on, each number once. The page reports to WebStreams what
/// becomes of them, never from inside a call of this interface.
class WebPort {
 public:
  virtual ~WebPort() = default;

  /// Open a WebSocket to the gateway.
  virtual void open(int stream) = 0;
  /// Send one frame as one binary message.
  virtual void send(int stream, std::string_view frame) = 0;
  /// Bytes that send() was given and that have not left yet.
  virtual std::size_t unsentBytes(int stream) = 0;
  /// Close it after what was sent; nothing more is reported of it.
  virtual void close(int stream) = 0;
  /// Keep this for as long as the tab lives, a reload included; empty: forget it.
  virtual void keepToken(std::string_view token) = 0;
  /// The game played a sound. `own`: this player caused it, or no player did.
  virtual void sound(const SoundLine& sound, bool own) = 0;
};

class WebStreams : public StreamOpener {
 public:
  using Time = std::chrono::steady_clock::time_point;

  static constexpr std::chrono::seconds kOpenTimeout{5};

  /// `port` must outlive it.
  explicit WebStreams(WebPort& port) : m_port(port) {}

  void open(Done done) override { begin(m_first, std::move(done)); }
  void openSecond(Done done) override { begin(m_second, std::move(done)); }
  void cancel() override;
  std::optional<Fingerprint> key() const override { return keyBehindGateway(); }
  std::optional<Fingerprint> secondKey() const override { return keyBehindGateway(); }
  std::string whyUntrusted() const override { return {}; }
  bool wasHungUpOn() const override { return m_crowded; }

  // What the page says of a stream.
  void opened(int stream);
  void received(int stream, std::string_view message);
  /// `code`: of the close frame; 1006 if there was none. `reason`: a sentence of the gateway, or empty.
  void closed(int stream, int code, std::string_view reason);

  /// Time-outs. Call about ten times a second.
  void update(Time now);
  /// Why the gateway turned the newest stream away, for people; empty once a stream works.
  const std::string& refusal() const { return m_refusal; }
  /// The refusal is final: another attempt would end like this one.
  bool isRefusalFinal() const { return m_final; }

 private:
  class Channel;
  struct Attempt {
    int stream = 0;  ///< 0: none is under way
    Done done;
    std::optional<Time> until;  ///< set with the first update()
  };
  void begin(Attempt& attempt, Done done);
  void drop(Attempt& attempt);
  Attempt* find(int stream);
  void fail(Attempt& attempt, const std::string& sentence);

  WebPort& m_port;
  int m_newest = 0;
  Attempt m_first;
  Attempt m_second;
  std::map<int, Channel*> m_channels;  ///< those that are open here
  std::string m_refusal;
  bool m_crowded = false;
  bool m_final = false;
};

}  // namespace naiad

// What the client in a browser needs from the page around it. The page is JavaScript (page/page.js); tests
// stand in for it.
#pragma once

#include <cstddef>
#include <string_view>

#include "client/session/ServerMessages.h"

namespace naiad {

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

}  // namespace naiad

// Interface that opens a Connection's streams and checks whether the server behind them is trusted.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "client/trust/ServerAddress.h"
#include "shared/net/base/Channel.h"
#include "shared/net/stream/Fingerprint.h"

namespace naiad {

struct ServerTrust {
  bool insecure = false;                   ///< use plain TCP, loopback only, without datagrams; for tests
  std::optional<Fingerprint> fingerprint;  ///< the server's key, if given by the player
  std::optional<ShortKey> link_key;        ///< the key in the link, if the player followed one
  std::filesystem::path known_servers;     ///< file of known servers; empty: KnownServers::defaultPath()
  bool pin_new_keys = true;                ///< store the keys of trusted servers in that file
  bool ignore_redirects = false;
  /// Maximum of the random wait before a redirect is followed. It spreads out the arrivals when many clients
  /// are redirected at once, as after the end of a server.
  std::chrono::milliseconds max_redirect_wait{1000};
  /// Gateway to the server, trusted in the server's place; if set, the other members are not used.
  std::optional<GatewayAddress> gateway;
};

/// Not thread-safe. May be destroyed at any time, even in its own callback; this cancels all attempts.
class StreamOpener {
 public:
  /// Called with either an unstarted channel and an empty `error`, or no channel and one sentence for people.
  using Done = std::function<void(std::unique_ptr<ReliableChannel> channel, const std::string& error)>;

  virtual ~StreamOpener() = default;

  /// Opens a stream for a session. `done` is called once, from the event loop, unless cancelled. Cancels an
  /// earlier attempt that has not ended.
  virtual void open(Done done) = 0;
  /// Like open(), for the session's second stream (SecondStream); independent of open().
  virtual void openSecond(Done done) = 0;
  /// Cancels all attempts; no `done` will be called.
  virtual void cancel() = 0;

  /// Returns the key of the server behind the newest stream of open(), so that no other server gets a token:
  /// nullopt if the stream is not encrypted, keyBehindGateway() if it uses a gateway.
  virtual std::optional<Fingerprint> key() const = 0;
  /// Like key(), for openSecond().
  virtual std::optional<Fingerprint> keyOfSecond() const = 0;
  /// Returns why the server behind the newest stream of open() is not trusted, for people; empty if it is.
  /// Nothing may be sent to an untrusted server.
  virtual std::string trustError() const = 0;
  struct RedirectTarget {
    std::unique_ptr<StreamOpener> opener;  ///< null: the redirect is not followed
    ServerAddress address;
    std::chrono::milliseconds wait{0};  ///< wait before the first attempt
  };
  /// Returns how to reach the server of `link` (JoinLink.h; untrusted text), to which the newest stream's
  /// server has redirected the client. A redirect from that server to a third one is not followed.
  virtual RedirectTarget follow(const std::string& /*link*/) { return {}; }

  /// True if the newest attempt of open() was dropped in the handshake, e.g. at a per-address limit; a retry
  /// may succeed.
  virtual bool closedDuringHandshake() const = 0;

 protected:
  /// Returns the constant that key() returns if a gateway is trusted in the server's place.
  static std::optional<Fingerprint> keyBehindGateway() { return Fingerprint::parse(std::string(64, '0')); }
};

}  // namespace naiad

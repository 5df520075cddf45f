// How a Connection reaches its server: opens the streams of a session, and says whether the server behind
// them may be trusted.
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

/// How a client makes sure that it talks to the right server.
struct ServerTrust {
  bool insecure = false;                   ///< plain TCP, loopback only, no datagrams: for tests
  std::optional<Fingerprint> fingerprint;  ///< the server's key, if the player gave it
  std::optional<ShortKey> link_key;        ///< the key of the link that the player followed
  std::filesystem::path known_servers;     ///< pins; empty: the user's file
  bool pins = true;                        ///< a server that is trusted is pinned
  bool stays = false;                      ///< does not go to another server, where this one sends the client
  /// Before it goes there, it waits for a random time up to this: a server that is sent many clients at once,
  /// as after another one's end, meets them one by one.
  std::chrono::milliseconds max_redirect_wait{1000};
  /// The server is reached through this gateway, which is trusted in its place; the rest is not used.
  std::optional<GatewayAddress> gateway;
};

/// Not thread-safe. May be destroyed at any time, in its own callback too; that cancels.
class StreamOpener {
 public:
  /// Either a channel, not started yet, and an empty `error`; or no channel and one sentence for people.
  using Done = std::function<void(std::unique_ptr<ReliableChannel> channel, const std::string& error)>;

  virtual ~StreamOpener() = default;

  /// Open a stream for a session. `done` is called once, from the event loop, unless cancelled. One at a
  /// time: an attempt under way is cancelled.
  virtual void open(Done done) = 0;
  /// The same for a second stream beside it (SecondStream), independent of the first.
  virtual void openSecond(Done done) = 0;
  /// Give up; no `done` will be called.
  virtual void cancel() = 0;

  /// The key of the server behind the newest stream of open(): a session's token is sent to no other. Nothing
  /// where there is no encryption.
  virtual std::optional<Fingerprint> key() const = 0;
  /// The same of openSecond().
  virtual std::optional<Fingerprint> secondKey() const = 0;
  /// Why the server behind the newest stream of open() is not trusted, for people; empty if it is. Nothing
  /// may be sent to one that is not.
  virtual std::string whyUntrusted() const = 0;
  /// How a client goes on to another server.
  struct Next {
    std::unique_ptr<StreamOpener> opener;  ///< null: it does not
    ServerAddress address;
    std::chrono::milliseconds wait{0};  ///< before its first attempt
  };
  /// To the server of the link (JoinLink.h; a stranger's text), where that of the newest stream has sent the
  /// client. Not from there to a third one.
  virtual Next follow(const std::string& /*link*/) { return {}; }

  /// The newest attempt of open() was hung up on before the server could speak, as where too many come from
  /// one place: another one may do.
  virtual bool wasHungUpOn() const = 0;

 protected:
  /// In place of a key where a gateway is trusted in the server's place: always the same.
  static std::optional<Fingerprint> keyBehindGateway() { return Fingerprint::parse(std::string(64, '0')); }
};

}  // namespace naiad

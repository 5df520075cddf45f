// How a client makes sure that it talks to the right server.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>

#include "client/trust/GatewayAddress.h"
#include "shared/net/stream/Fingerprint.h"
#include "shared/net/stream/ShortKey.h"

namespace naiad {

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

}  // namespace naiad

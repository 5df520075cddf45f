// The lobby of a fleet: a server without a game. It answers a client's hello with a redirect to a server that
// has a free place.
//
// Its limits are those of a dfserver: half-open connections, handshakes per address, and connections without
// a hello.
#pragma once

#include <asio/ts/netfwd.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "server/directory/FleetRegistry.h"
#include "shared/net/stream/TcpListener.h"
#include "shared/net/stream/TlsContext.h"

namespace naiad {

/// The lobby's answer to a client.
struct LobbyReply {
  enum class Kind { kRedirected, kNoPlace, kNoGame };
  Kind kind;
  std::string frame;  ///< the message to the client
};

/// Answers a hello and reserves a place on the chosen server. Returns nullopt if the frame is not a hello.
std::optional<LobbyReply> replyToHello(std::string_view frame, FleetRegistry& servers);

struct LobbySettings {
  std::string address = "::";                      ///< numeric address to listen on
  std::uint16_t port = 0;                          ///< 0: any free port
  std::chrono::milliseconds hello_timeout{5'000};  ///< timeout of a connection without a hello
  int max_per_address = 64;  ///< simultaneous new players from one IPv4 address or IPv6 /64
};

struct LobbyCounters {
  std::uint64_t hellos = 0;
  std::uint64_t redirected = 0;       ///< answered with a redirect to a server
  std::uint64_t no_slot = 0;          ///< asked to retry: no free place
  std::uint64_t no_game = 0;          ///< refused: no server fits the hello
  std::uint64_t malformed = 0;        ///< dropped: the first frame is not a hello
  std::uint64_t timeouts = 0;         ///< dropped: no hello in time
  std::uint64_t pending_evicted = 0;  ///< dropped: too many connections without a hello
};

/// Use on the thread that runs the context. `context` and `servers` must outlive the Lobby.
class Lobby {
 public:
  static constexpr std::size_t kMaxPending = 1024;  ///< maximum connections without a hello

  /// Begins to listen. Throws ListenError.
  Lobby(asio::io_context& context, const LobbySettings& settings, std::shared_ptr<const TlsContext> tls,
        FleetRegistry& servers);
  ~Lobby();
  Lobby(const Lobby&) = delete;
  Lobby& operator=(const Lobby&) = delete;

  std::uint16_t port() const;
  /// Sets the TLS context for new connections.
  void setTls(std::shared_ptr<const TlsContext> tls);
  const LobbyCounters& counters() const;
  const TcpListener::Counters& streams() const;

 private:
  struct State;
  std::shared_ptr<State> m_state;
};

}  // namespace naiad

// The lobby of a fleet: a server on which there is nothing to play. It hears a client's hello, and answers
// with the server that has a place for the player.
//
// Strangers cost as little as at a dfserver: half-open connections, handshakes of an address, and connections
// without a hello are limited in the same way.
#pragma once

#include <asio/ts/netfwd.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "server/directory/FleetList.h"
#include "shared/net/stream/TcpListener.h"
#include "shared/net/stream/TlsContext.h"

namespace naiad {

/// What the lobby of a fleet says to a client: where to go.
struct LobbyAnswer {
  enum class Kind { kSentOn, kNoPlace, kNoGame };
  Kind kind;
  std::string frame;  ///< for the client
};

/// To the first frame of a client; nothing if that is no hello. A place is taken on the server to which it is
/// sent.
std::optional<LobbyAnswer> answerHello(std::string_view frame, FleetList& servers);

struct LobbySettings {
  std::string address = "::";                   ///< numeric
  std::uint16_t port = 0;                       ///< 0: any free one
  std::chrono::milliseconds hello_time{5'000};  ///< after which a connection without a hello is ended
  int max_per_address = 64;  ///< players who come at once from one IPv4 address or IPv6 /64
};

struct LobbyCounters {
  std::uint64_t hellos = 0;
  std::uint64_t sent_on = 0;    ///< to a server
  std::uint64_t no_place = 0;   ///< to none: asked to come again
  std::uint64_t no_game = 0;    ///< no server plays what they want
  std::uint64_t malformed = 0;  ///< what is no hello
  std::uint64_t late = 0;       ///< no hello in time
  std::uint64_t crowded = 0;    ///< hung up on: too many connections without a hello
};

/// Thread: the one that runs the context, which must outlive it, as `servers` must.
class Lobby {
 public:
  static constexpr std::size_t kMaxGuests = 1024;  ///< connections without a hello

  /// Listens from now on. Throws ListenError.
  Lobby(asio::io_context& context, const LobbySettings& settings, std::shared_ptr<const TlsContext> tls,
        FleetList& servers);
  ~Lobby();
  Lobby(const Lobby&) = delete;
  Lobby& operator=(const Lobby&) = delete;

  std::uint16_t port() const;
  /// For connections from now on.
  void setTls(std::shared_ptr<const TlsContext> tls);
  const LobbyCounters& counters() const;
  const TcpListener::Counters& streams() const;

 private:
  struct State;
  std::shared_ptr<State> m_state;
};

}  // namespace naiad

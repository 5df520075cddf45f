#include "server/directory/Lobby.h"

#include <algorithm>
#include <asio/io_context.hpp>
#include <asio/post.hpp>
#include <asio/steady_timer.hpp>
#include <map>
#include <utility>

#include "naiad.pb.h"
#include "proto/ParseErrors.h"
#include "shared/net/base/Limits.h"
#include "shared/net/base/PrefixRateLimiter.h"
#include "shared/net/base/SafeText.h"
#include "shared/net/stream/HalfOpenLimit.h"

namespace naiad {
namespace {

LobbyReply makeReply(LobbyReply::Kind kind, wire::Refused::Reason reason, const std::string& sentence,
                     const std::string& redirect = "", const std::string& room = "") {
  wire::ServerMessage message;
  wire::Refused& refused = *message.mutable_refused();
  refused.set_reason(reason);
  refused.set_message(safeText(sentence, kMaxMessageLength));
  refused.set_redirect(redirect);
  refused.set_redirect_room(room);
  return {kind, message.SerializeAsString()};
}

std::string describe(const FleetRegistry::PlayerRequest& request) {
  return (request.game.empty() ? "" : " for \"" + request.game + "\"") +
         (request.room.empty() ? "" : " with a room \"" + request.room + "\"");
}

using Clock = std::chrono::steady_clock;

}  // namespace

std::optional<LobbyReply> replyToHello(std::string_view frame, FleetRegistry& servers) {
  silenceParseErrors();
  wire::ClientMessage message;
  if (!message.ParseFromArray(frame.data(), static_cast<int>(frame.size())) || !message.has_hello() ||
      message.hello().magic() != kHelloMagic)
    return std::nullopt;
  const wire::Hello& hello = message.hello();
  const FleetRegistry::PlayerRequest request{safeText(hello.game(), Presence::kMaxName), hello.protocol(), "",
                                             safeText(hello.room(), kMaxRoomName)};
  if (const FleetRegistry::Assignment place = servers.choose(request)) {
    return makeReply(LobbyReply::Kind::kRedirected, wire::Refused::REDIRECT,
                     "This lobby runs no game. Free places: " + linkOf(*place.p_server, place.room),
                     linkOf(*place.p_server), place.room);
  }
  if (!servers.hasMatch(request)) {
    return makeReply(LobbyReply::Kind::kNoGame, wire::Refused::GAME,
                     "No server of this fleet" + describe(request) + " supports protocol version " +
                         std::to_string(request.protocol) + ", which your client needs.");
  }
  return makeReply(LobbyReply::Kind::kNoPlace, wire::Refused::BUSY,
                   "No server" + describe(request) + " has a free place now. Try again later.");
}

struct Lobby::State : std::enable_shared_from_this<State> {
  /// A connection that has not sent its hello, or whose answer is being sent.
  struct PendingClient {
    PendingClient(asio::io_context& context, std::unique_ptr<ReliableChannel> stream)
        : channel(std::move(stream)), deadline(context) {}
    std::unique_ptr<ReliableChannel> channel;
    asio::steady_timer deadline;
    bool is_limited = true;  ///< is counted in `limit`, because its hello has not arrived yet
  };
  using Id = HalfOpenLimit::Id;

  State(asio::io_context& io, const LobbySettings& settings, FleetRegistry& list)
      : context(io),
        hello_timeout(settings.hello_timeout),
        servers(list),
        handshakes(RateLimits::handshakes(settings.max_per_address)),
        limit({kMaxPending, std::clamp<std::size_t>(static_cast<std::size_t>(settings.max_per_address), 1,
                                                    kMaxPending / 2)}) {}

  TlsListenerOptions listening(const LobbySettings& settings, std::shared_ptr<const TlsContext> tls);
  void onConnection(std::unique_ptr<ReliableChannel> channel);
  bool evictFor(const AddressPrefix& prefix);
  void handleFrame(Id id, std::string_view frame);
  void disconnect(Id id);
  void release(Id id, PendingClient& client);

  asio::io_context& context;
  const std::chrono::milliseconds hello_timeout;
  FleetRegistry& servers;
  PrefixRateLimiter handshakes;
  HalfOpenLimit limit;
  std::map<Id, PendingClient> clients;
  Id next = 1;
  LobbyCounters counters;
  std::unique_ptr<TcpListener> listener;
};

TlsListenerOptions Lobby::State::listening(const LobbySettings& settings,
                                           std::shared_ptr<const TlsContext> tls) {
  TlsListenerOptions listening;
  listening.context = std::move(tls);
  const auto crowd = static_cast<std::size_t>(settings.max_per_address);
  listening.max_half_open = std::clamp<std::size_t>(2 * crowd, 256, 2048);
  listening.max_half_open_per_prefix = std::clamp<std::size_t>(crowd, 64, listening.max_half_open / 2);
  listening.try_handshake = [this](const AddressPrefix& prefix) {
    return handshakes.tryConsume(prefix, Clock::now());
  };
  listening.can_handshake = [this](const AddressPrefix& prefix) {
    return handshakes.canConsume(prefix, Clock::now());
  };
  return listening;
}

void Lobby::State::onConnection(std::unique_ptr<ReliableChannel> channel) {
  const AddressPrefix prefix = AddressPrefix::ofEndpoint(channel->peerAddress()).value_or(AddressPrefix());
  if (!evictFor(prefix)) {
    ++counters.pending_evicted;
    return;
  }
  const Id id = next++;
  limit.admit(id, prefix);
  PendingClient& client = clients.try_emplace(id, context, std::move(channel)).first->second;
  client.deadline.expires_after(hello_timeout);
  client.deadline.async_wait([self = shared_from_this(), id](const std::error_code& error) {
    if (error) return;
    ++self->counters.timeouts;
    self->disconnect(id);
  });
  client.channel->start({[this, id](std::string_view frame) { handleFrame(id, frame); },
                         [this, id](CloseReason) { disconnect(id); }});
}

/// Makes room for a new connection from `prefix` if necessary: evicts the oldest connection without a hello
/// of the most crowded prefix. Returns false if the new one must be dropped.
bool Lobby::State::evictFor(const AddressPrefix& prefix) {
  for (auto verdict = limit.check(prefix); verdict.kind != HalfOpenLimit::Result::Kind::kFits;
       verdict = limit.check(prefix)) {
    if (verdict.kind != HalfOpenLimit::Result::Kind::kEvictFirst) return false;
    ++counters.pending_evicted;
    disconnect(verdict.id);
  }
  return true;
}

void Lobby::State::handleFrame(Id id, std::string_view frame) {
  const auto found = clients.find(id);
  if (found == clients.end() || !found->second.is_limited) return;  // ignore frames after the hello
  PendingClient& client = found->second;
  release(id, client);
  const auto answer = replyToHello(frame, servers);
  if (answer) {
    ++counters.hellos;
    using Kind = LobbyReply::Kind;
    ++(answer->kind == Kind::kRedirected ? counters.redirected
       : answer->kind == Kind::kNoPlace  ? counters.no_slot
                                         : counters.no_game);
    client.channel->send(answer->frame);
  } else {
    ++counters.malformed;
  }
  client.channel->close();
}

void Lobby::State::release(Id id, PendingClient& client) {
  if (std::exchange(client.is_limited, false)) limit.release(id);
  client.deadline.cancel();
}

// The caller may be the channel itself, so the channel is destroyed later.
void Lobby::State::disconnect(Id id) {
  const auto found = clients.find(id);
  if (found == clients.end()) return;
  release(id, found->second);
  asio::post(context, [channel = std::shared_ptr<ReliableChannel>(std::move(found->second.channel))] {});
  clients.erase(found);
}

Lobby::Lobby(asio::io_context& context, const LobbySettings& settings, std::shared_ptr<const TlsContext> tls,
             FleetRegistry& servers)
    : m_state(std::make_shared<State>(context, settings, servers)) {
  m_state->listener = std::make_unique<TcpListener>(
      context, settings.address, settings.port,
      [p_state = m_state.get()](std::unique_ptr<ReliableChannel> channel) {
        p_state->onConnection(std::move(channel));
      },
      TcpOptions(), m_state->listening(settings, std::move(tls)));
}

Lobby::~Lobby() {
  m_state->listener.reset();
  m_state->clients.clear();
}

std::uint16_t Lobby::port() const {
  return m_state->listener->port();
}

void Lobby::setTls(std::shared_ptr<const TlsContext> tls) {
  m_state->listener->setTls(std::move(tls));
}

const LobbyCounters& Lobby::counters() const {
  return m_state->counters;
}

const TcpListener::Counters& Lobby::streams() const {
  return m_state->listener->counters();
}

}  // namespace naiad

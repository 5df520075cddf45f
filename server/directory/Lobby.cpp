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
#include "shared/net/base/PrefixAllowance.h"
#include "shared/net/base/SafeText.h"
#include "shared/net/stream/HalfOpenLimit.h"

namespace naiad {
namespace {

LobbyAnswer answerOf(LobbyAnswer::Kind kind, wire::Refused::Reason reason, const std::string& sentence,
                     const std::string& redirect = "", const std::string& room = "") {
  wire::ServerMessage message;
  wire::Refused& refused = *message.mutable_refused();
  refused.set_reason(reason);
  refused.set_sentence(safeText(sentence, kMaxSentenceLength));
  refused.set_redirect(redirect);
  refused.set_redirect_room(room);
  return {kind, message.SerializeAsString()};
}

std::string wished(const FleetList::Wish& wish) {
  return (wish.game.empty() ? "" : " for \"" + wish.game + "\"") +
         (wish.room.empty() ? "" : " with a room \"" + wish.room + "\"");
}

using Clock = std::chrono::steady_clock;

}  // namespace

std::optional<LobbyAnswer> answerHello(std::string_view frame, FleetList& servers) {
  silenceParseErrors();
  wire::ClientMessage message;
  if (!message.ParseFromArray(frame.data(), static_cast<int>(frame.size())) || !message.has_hello() ||
      message.hello().magic() != kHelloMagic)
    return std::nullopt;
  const wire::Hello& hello = message.hello();
  const FleetList::Wish wish{safeText(hello.game(), Presence::kMaxName), hello.protocol(), "",
                             safeText(hello.room(), kMaxRoomName)};
  if (const FleetList::Place place = servers.choose(wish)) {
    return answerOf(LobbyAnswer::Kind::kSentOn, wire::Refused::REDIRECT,
                    "This lobby runs no game. Free places: " + linkOf(*place.p_server, place.room),
                    linkOf(*place.p_server), place.room);
  }
  if (!servers.plays(wish)) {
    return answerOf(LobbyAnswer::Kind::kNoGame, wire::Refused::GAME,
                    "No server of this fleet" + wished(wish) + " supports version " +
                        std::to_string(wish.protocol) + " of the protocol, as your client does.");
  }
  return answerOf(LobbyAnswer::Kind::kNoPlace, wire::Refused::BUSY,
                  "No server" + wished(wish) + " has a free place now. Try again later.");
}

struct Lobby::State : std::enable_shared_from_this<State> {
  /// A connection that has not sent its hello, or whose answer is being sent.
  struct Guest {
    Guest(asio::io_context& context, std::unique_ptr<ReliableChannel> stream)
        : channel(std::move(stream)), deadline(context) {}
    std::unique_ptr<ReliableChannel> channel;
    asio::steady_timer deadline;
    bool is_limited = true;  ///< counts in `limit`: no hello yet
  };
  using Id = HalfOpenLimit::Id;

  State(asio::io_context& io, const LobbySettings& settings, FleetList& list)
      : context(io),
        hello_time(settings.hello_time),
        servers(list),
        handshakes(PrefixRates::handshakes(settings.max_per_address)),
        limit({kMaxGuests, std::clamp<std::size_t>(static_cast<std::size_t>(settings.max_per_address), 1,
                                                   kMaxGuests / 2)}) {}

  TlsListening listening(const LobbySettings& settings, std::shared_ptr<const TlsContext> tls);
  void meet(std::unique_ptr<ReliableChannel> channel);
  bool makeRoom(const AddressPrefix& prefix);
  void hear(Id id, std::string_view frame);
  void dismiss(Id id);
  void release(Id id, Guest& guest);

  asio::io_context& context;
  const std::chrono::milliseconds hello_time;
  FleetList& servers;
  PrefixAllowance handshakes;
  HalfOpenLimit limit;
  std::map<Id, Guest> guests;
  Id next = 1;
  LobbyCounters counters;
  std::unique_ptr<TcpListener> listener;
};

TlsListening Lobby::State::listening(const LobbySettings& settings, std::shared_ptr<const TlsContext> tls) {
  TlsListening listening;
  listening.context = std::move(tls);
  const auto crowd = static_cast<std::size_t>(settings.max_per_address);
  listening.max_half_open = std::clamp<std::size_t>(2 * crowd, 256, 2048);
  listening.max_half_open_per_prefix = std::clamp<std::size_t>(crowd, 64, listening.max_half_open / 2);
  listening.take_handshake = [this](const AddressPrefix& prefix) {
    return handshakes.take(prefix, Clock::now());
  };
  listening.has_handshake = [this](const AddressPrefix& prefix) {
    return handshakes.has(prefix, Clock::now());
  };
  return listening;
}

void Lobby::State::meet(std::unique_ptr<ReliableChannel> channel) {
  const AddressPrefix prefix = AddressPrefix::ofEndpoint(channel->peerAddress()).value_or(AddressPrefix());
  if (!makeRoom(prefix)) {
    ++counters.crowded;
    return;
  }
  const Id id = next++;
  limit.admit(id, prefix);
  Guest& guest = guests.try_emplace(id, context, std::move(channel)).first->second;
  guest.deadline.expires_after(hello_time);
  guest.deadline.async_wait([self = shared_from_this(), id](const std::error_code& error) {
    if (error) return;
    ++self->counters.late;
    self->dismiss(id);
  });
  guest.channel->start(
      {[this, id](std::string_view frame) { hear(id, frame); }, [this, id](CloseReason) { dismiss(id); }});
}

/// Evicts the oldest connection without a hello of the most crowded prefix, if a new one needs its place.
bool Lobby::State::makeRoom(const AddressPrefix& prefix) {
  for (auto verdict = limit.judge(prefix); verdict.kind != HalfOpenLimit::Verdict::Kind::kFits;
       verdict = limit.judge(prefix)) {
    if (verdict.kind != HalfOpenLimit::Verdict::Kind::kEndFirst) return false;
    ++counters.crowded;
    dismiss(verdict.id);
  }
  return true;
}

void Lobby::State::hear(Id id, std::string_view frame) {
  const auto found = guests.find(id);
  if (found == guests.end() || !found->second.is_limited) return;  // ignore frames after the hello
  Guest& guest = found->second;
  release(id, guest);
  const auto answer = answerHello(frame, servers);
  if (answer) {
    ++counters.hellos;
    using Kind = LobbyAnswer::Kind;
    ++(answer->kind == Kind::kSentOn    ? counters.sent_on
       : answer->kind == Kind::kNoPlace ? counters.no_place
                                        : counters.no_game);
    guest.channel->send(answer->frame);
  } else {
    ++counters.malformed;
  }
  guest.channel->close();
}

void Lobby::State::release(Id id, Guest& guest) {
  if (std::exchange(guest.is_limited, false)) limit.release(id);
  guest.deadline.cancel();
}

// The caller may be the channel itself, so it is destroyed later.
void Lobby::State::dismiss(Id id) {
  const auto found = guests.find(id);
  if (found == guests.end()) return;
  release(id, found->second);
  asio::post(context, [channel = std::shared_ptr<ReliableChannel>(std::move(found->second.channel))] {});
  guests.erase(found);
}

Lobby::Lobby(asio::io_context& context, const LobbySettings& settings, std::shared_ptr<const TlsContext> tls,
             FleetList& servers)
    : m_state(std::make_shared<State>(context, settings, servers)) {
  m_state->listener = std::make_unique<TcpListener>(
      context, settings.address, settings.port,
      [p_state = m_state.get()](std::unique_ptr<ReliableChannel> channel) {
        p_state->meet(std::move(channel));
      },
      TcpOptions(), m_state->listening(settings, std::move(tls)));
}

Lobby::~Lobby() {
  m_state->listener.reset();
  m_state->guests.clear();
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

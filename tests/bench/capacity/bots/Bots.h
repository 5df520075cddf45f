// Players: thousands without a picture, and some whose screens are compared with the server's.
#pragma once

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <asio/io_context.hpp>
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "../Common.h"
#include "client/session/Connection.h"
#include "naiad.pb.h"
#include "shared/net/base/Limits.h"
#include "shared/net/datagram/DatagramKeys.h"
#include "shared/net/datagram/SealedLink.h"
#include "shared/net/datagram/UdpSocket.h"
#include "shared/net/stream/TcpConnector.h"
#include "shared/replica/Acks.h"
#include "shared/replica/SnapshotCodec.h"
#include "shared/replica/UpdateCodec.h"
#include "shared/values/Keyboard.h"
#include "shared/values/SplitMix64.h"

namespace bench::capacity {

using namespace naiad;
using namespace std::chrono_literals;

/// Address of the server, and objects that all bots share.
struct Harbour {
  asio::io_context& context;
  std::shared_ptr<const TlsContext> tls;
  std::string host;
  std::uint16_t port = 0;
};

/// Returns "127.x.y.z", different for each bot.
inline std::string addressOf(int index) {
  const int n = index + 2;  // 127.0.0.1 is the server's address
  return "127." + std::to_string(n >> 16 & 255) + "." + std::to_string(n >> 8 & 255) + "." +
         std::to_string(n & 255);
}

/// A player without a picture: logs in, acknowledges every snapshot and presses keys. This is so little work
/// that one core can run thousands of them.
class LightBot {
 public:
  using Time = std::chrono::steady_clock::time_point;

  static constexpr std::chrono::milliseconds kInputEvery{200};
  static constexpr int kTurnsOneIn = 16;  ///< one in this number of inputs changes the direction

  LightBot(const Harbour& harbour, int index)
      : m_harbour(harbour), m_index(index), m_random(static_cast<std::uint64_t>(index)) {}

  ~LightBot() {
    if (m_descriptor >= 0) close(m_descriptor);
  }

  /// Begins to log in.
  void start() {
    m_connector.emplace(m_harbour.context, TcpOptions{.receive_limit = kMaxServerFrame}, m_harbour.tls);
    m_connector->connect(m_harbour.host, m_harbour.port, 30s,
                         [this](std::unique_ptr<ReliableChannel> channel, const std::string&) {
                           if (!channel) {
                             m_over = true;
                             return;
                           }
                           m_channel = std::move(channel);
                           m_channel->start({[this](std::string_view frame) { onFrame(frame); },
                                             [this](CloseReason) { m_over = true; }});
                           wire::ClientMessage message;
                           wire::Hello& hello = *message.mutable_hello();
                           hello.set_magic(kHelloMagic);
                           hello.set_protocol(kProtocolVersion);
                           hello.set_player_name("bot" + std::to_string(m_index));
                           hello.set_program("naiad_capacity_bots");
                           hello.add_aeads(static_cast<std::uint32_t>(AeadId::kAes128Gcm));
                           m_channel->send(message.SerializeAsString());
                         });
  }
  /// True if the bot receives snapshots as datagrams.
  bool isReady() const { return m_ready; }
  /// True if the bot was refused or disconnected.
  bool isOver() const { return m_over; }
  /// Returns the descriptor of the bot's UDP socket; -1 before it has joined.
  int descriptor() const { return m_descriptor; }
  /// Returns the bot's address and port, for example "127.0.0.2:40000".
  std::string endpoint() const {
    sockaddr_in own{};
    socklen_t size = sizeof own;
    getsockname(m_descriptor, reinterpret_cast<sockaddr*>(&own), &size);
    return addressOf(m_index) + ":" + std::to_string(ntohs(own.sin_port));
  }
  /// Receives a datagram if one has arrived. Returns its size; 0 if none has.
  std::size_t receive(Time now) {
    std::array<char, 2048> buffer;
    const ssize_t size = recv(m_descriptor, buffer.data(), buffer.size(), MSG_DONTWAIT);
    if (size <= 0) return 0;
    ++received;
    bytes += static_cast<std::size_t>(size);
    if (m_sinking) return static_cast<std::size_t>(size);
    const auto payload = m_link->open({}, {buffer.data(), static_cast<std::size_t>(size)}, now);
    if (!payload) return static_cast<std::size_t>(size);
    m_ready = true;
    if (!payload->empty()) takeSnapshot(*payload, now);
    answer(now);
    return static_cast<std::size_t>(size);
  }
  /// Receives datagrams from now on without answering.
  void sink() { m_sinking = true; }
  /// Sends a probe while no datagram has arrived. Call from time to time.
  void update(Time now) {
    if (!m_link || m_ready || m_sinking || now - m_probed < 100ms) return;
    m_probed = now;
    answer(now);
  }

  /// Numbers of datagrams and bytes received since resetFigures().
  std::uint64_t received = 0;
  std::uint64_t bytes = 0;
  /// Returns the number of snapshots that were sent but did not arrive.
  std::uint64_t missing() const {
    if (m_first == 0) return 0;
    const std::uint64_t sent = m_context.number - m_first + 1;
    return sent > m_snapshots ? sent - m_snapshots : 0;
  }
  void resetFigures() {
    received = bytes = m_snapshots = 0;
    m_first = 0;
  }

 private:
  void onFrame(std::string_view frame) {
    wire::ServerMessage message;
    if (!message.ParseFromArray(frame.data(), static_cast<int>(frame.size()))) return;
    if (message.has_refused() || message.has_goodbye()) m_over = true;
    if (message.has_snapshot() && m_link) {
      const Time now = std::chrono::steady_clock::now();
      takeSnapshot(message.snapshot(), now);
      answer(now);
    }
    if (!message.has_welcome() || m_link) return;
    const wire::Welcome& welcome = message.welcome();
    const auto aead = aeadFromWire(welcome.aead());
    if (!aead) {
      m_over = true;
      return;
    }
    const Time now = std::chrono::steady_clock::now();
    m_context.tick = welcome.tick();
    m_link = std::make_unique<SealedLink>(
        SealedLink::Options{SealedLink::Role::kClient, ConnectionId{welcome.connection_id()}, {}, {}});
    m_link->setServerPath({Endpoint{}, *makeEndpoint(m_harbour.host, m_harbour.port)});
    const KeyExporter exporter = [this](std::string_view label, std::string_view context, std::size_t size) {
      return m_channel->exportSecret(label, context, size);
    };
    m_link->startEpoch(welcome.epoch(), deriveDatagramKeys(exporter, *aead, m_link->id(), welcome.epoch()),
                       now);
    openSocket();
    m_next_input = now + std::chrono::milliseconds(m_random.below(kInputEvery.count()));
    update(now);
  }
  void openSocket() {
    m_descriptor = socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    sockaddr_in own{};
    own.sin_family = AF_INET;
    inet_pton(AF_INET, addressOf(m_index).c_str(), &own.sin_addr);
    sockaddr_in server = own;
    server.sin_port = htons(m_harbour.port);
    inet_pton(AF_INET, m_harbour.host.c_str(), &server.sin_addr);
    if (m_descriptor < 0 || bind(m_descriptor, reinterpret_cast<const sockaddr*>(&own), sizeof own) != 0 ||
        connect(m_descriptor, reinterpret_cast<const sockaddr*>(&server), sizeof server) != 0) {
      throw std::runtime_error("a socket of a bot's own cannot be made");
    }
  }
  void takeSnapshot(std::string_view snapshot, Time now) {
    const auto header = peekHeader(snapshot, m_context);
    if (!header) return;
    m_acks.addReceived(header->number);
    ++m_snapshots;
    if (m_first == 0) m_first = header->number;
    if (isNewer(header->number, m_context.number)) m_context.number = header->number;
    if (isNewer(header->tick, m_context.tick)) m_context.tick = header->tick;
    if (header->has_input) {
      if (isNewer(header->input, m_context.input)) m_context.input = header->input;
      std::erase_if(m_inputs, [&](const Input& input) { return !isNewer(input.id, m_context.input); });
    }
    if (now >= m_next_input) press(now);
  }
  void press(Time now) {
    m_next_input = std::max(m_next_input + kInputEvery, now);
    if (m_random.below(kTurnsOneIn) == 0) m_left = !m_left;
    Input input;
    input.id = ++m_newest_input;
    input.tick = m_context.tick + 1;
    input.snapshot = m_context.number;
    input.action = static_cast<std::uint8_t>(df::KEY_PRESSED);
    input.key = static_cast<std::uint8_t>(m_left ? df::Keyboard::LEFTARROW : df::Keyboard::RIGHTARROW);
    m_inputs.push_back(input);
  }
  void answer(Time now) {
    ClientUpdate update;
    update.acks = m_acks;
    update.inputs = m_inputs;
    if (const auto outgoing = m_link->seal(writeUpdate(update), now)) {
      ::send(m_descriptor, outgoing->packet.data(), outgoing->packet.size(), MSG_DONTWAIT);
    }
  }

  Harbour m_harbour;
  int m_index;
  std::optional<TcpConnector> m_connector;
  std::unique_ptr<ReliableChannel> m_channel;
  std::unique_ptr<SealedLink> m_link;
  int m_descriptor = -1;
  bool m_ready = false;
  bool m_over = false;
  bool m_sinking = false;
  AckWindow m_acks;
  SnapshotContext m_context;
  std::vector<Input> m_inputs;  ///< inputs that the server has not confirmed
  std::uint32_t m_newest_input = 0;
  Time m_next_input{};
  Time m_probed{};
  SplitMix64 m_random;
  bool m_left = false;
  std::uint32_t m_first = 0;  ///< number of the first snapshot since resetFigures()
  std::uint64_t m_snapshots = 0;
};

/// A player with a complete session like dfclient's, whose screen is compared with the server's.
class Checker {
 public:
  using Time = std::chrono::steady_clock::time_point;

  struct Picture {
    std::uint32_t tick;
    std::uint64_t sum;
  };

  /// Joins from `address`, a numeric address.
  Checker(asio::io_context& context, const naiad::ServerAddress& server,
          const naiad::Fingerprint& fingerprint, const std::string& address, int index,
          const std::string& known_servers)
      : m_connection(context, server, optionsOf(context, address, index), false,
                     trustIn(fingerprint, known_servers)),
        m_random(static_cast<std::uint64_t>(index)) {
    m_connection.onSession([this](naiad::ClientSession& session) {
      session.onBeforeSnapshot([this, &session](std::uint32_t tick) { record(session, tick); });
    });
    m_connection.start();
  }

  void update(Time now) {
    m_connection.update(now);
    naiad::ClientSession* session = m_connection.session();
    if (session == nullptr || m_connection.isOver() || now < m_next_key) return;
    m_next_key = now + LightBot::kInputEvery;
    if (m_random.below(LightBot::kTurnsOneIn) == 0) m_left = !m_left;
    session->sendKey(m_left ? df::Keyboard::LEFTARROW : df::Keyboard::RIGHTARROW, df::KEY_PRESSED, now);
  }
  bool isReady(Time now) {
    naiad::ClientSession* session = m_connection.session();
    return session != nullptr && session->hasPicture(now) && session->hasDatagrams(now);
  }
  bool isOver() const { return m_connection.isOver(); }
  std::uint32_t player() { return m_connection.session()->welcome().player; }
  /// Returns the pictures of checked ticks (Common.h), recorded when they could no longer change.
  const std::vector<Picture>& pictures() const { return m_pictures; }
  void forget() { m_pictures.clear(); }

 private:
  static naiad::ServerTrust trustIn(const naiad::Fingerprint& fingerprint, const std::string& known_servers) {
    naiad::ServerTrust trust;
    trust.fingerprint = fingerprint;
    trust.known_servers = known_servers;
    return trust;
  }
  static naiad::SessionOptions optionsOf(asio::io_context& context, const std::string& address, int index) {
    naiad::SessionOptions options;
    options.name = kCheckedName + std::to_string(index);
    options.program = "naiad_capacity_bots";
    options.open_socket = [&context,
                           address](const naiad::Endpoint&) -> std::unique_ptr<naiad::DatagramSocket> {
      naiad::UdpOptions udp;
      udp.address = address;
      return std::make_unique<naiad::UdpSocket>(context, udp);
    };
    return options;
  }

  // Before a snapshot of a new tick is applied, all ticks since the last one are final.
  void record(naiad::ClientSession& session, std::uint32_t tick) {
    const std::uint32_t known = session.clock().newestTick();
    if (known == 0 || tick == known) return;
    for (std::uint32_t t = std::max(m_recorded + 1, known); t < tick; ++t) {
      if (isChecked(session.welcome().player, t)) {
        m_pictures.push_back({t, pictureSum(session.replica().render(t))});
      }
    }
    m_recorded = tick - 1;
  }

  naiad::Connection m_connection;
  std::vector<Picture> m_pictures;
  std::uint32_t m_recorded = 0;  ///< newest tick whose picture was considered
  Time m_next_key{};
  naiad::SplitMix64 m_random;
  bool m_left = false;
};

}  // namespace bench::capacity

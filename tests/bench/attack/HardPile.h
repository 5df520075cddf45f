// hard_pile: a hostile server shows dfclient 48,000 moving HARD Objects in one place. Measures the time until
// dfclient handles SIGTERM and Ctrl-C.
#pragma once

#include <signal.h>

#include <algorithm>
#include <asio/executor_work_guard.hpp>
#include <asio/io_context.hpp>
#include <asio/steady_timer.hpp>
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include "Attack.h"
#include "host/auth/ServerIdentity.h"
#include "naiad.pb.h"
#include "shared/net/base/Channel.h"
#include "shared/net/base/Limits.h"
#include "shared/net/stream/TcpListener.h"
#include "shared/replica/Limits.h"
#include "shared/replica/SnapshotCodec.h"
#include "shared/values/Color.h"
#include "tests/support/TempFolder.h"
#include "tests/terminal/PtyTerminal.h"

namespace bench::attack {
using namespace naiad;
using Clock = std::chrono::steady_clock;
using naiad::test::PtyTerminal;
using namespace std::chrono_literals;

constexpr std::uint32_t kFirstTick = 100;
constexpr std::chrono::microseconds kTick{33'333};
constexpr int kSnapshotsPerTick = 8;  // until all objects are sent
constexpr std::size_t kSendCap = std::size_t{16} << 20;

// The objects are small boxes on a fine grid with equal velocities. They never touch, but all their paths
// cross, so a client that predicts collisions has to compare each with each other.
constexpr std::uint32_t kRow = 220;
constexpr df::Fixed kSpacing = df::kFixedOne >> 11;
constexpr df::Fixed kBox = df::kFixedOne >> 14;

inline ObjectState objectOf(std::uint32_t n, std::uint32_t tick) {
  ObjectState object;
  object.order = n;
  object.motion.tick = tick;
  object.motion.position = {
      df::fromCells(4) + (tick - kFirstTick) * (df::kFixedOne >> 4) + (n % kRow) * kSpacing,
      df::fromCells(2) + (tick - kFirstTick) * (df::kFixedOne >> 6) + (n / kRow) * kSpacing};
  object.motion.velocity = {df::kFixedOne >> 4, df::kFixedOne >> 6};
  object.look.sequence = {Appearance{{0, 0, U'#', df::GREEN}}};
  object.body.box = {{0, 0}, {kBox, kBox}};
  return object;
}

/// A server without a game. It welcomes a client and sends it a pile of objects.
class PileServer {
 public:
  static constexpr std::uint32_t kObjects = 48'000;

  /// Creates a server with its own key in `folder` and its own thread.
  explicit PileServer(const std::string& folder) {
    const ServerIdentity identity = ServerIdentity::loadOrMake(folder, std::chrono::system_clock::now());
    m_fingerprint = identity.fingerprint().text();
    TcpOptions options;
    options.send_cap = kSendCap;
    options.receive_limit = kMaxClientFrame;
    TlsListenerOptions tls;
    tls.context = identity.tls();
    m_listener = std::make_unique<TcpListener>(
        m_context, "127.0.0.1", 0,
        [this](std::unique_ptr<ReliableChannel> channel) {
          m_channel = std::move(channel);
          m_channel->start({[this](std::string_view frame) { receive(frame); },
                            [this](CloseReason) { m_timer.cancel(); }});
        },
        options, tls);
    m_thread = std::thread([this] {
      const auto work = asio::make_work_guard(m_context);
      m_context.run();
    });
  }
  ~PileServer() {
    m_context.stop();
    m_thread.join();
  }

  std::uint16_t port() const { return m_listener->port(); }
  const std::string& fingerprint() const { return m_fingerprint; }
  /// Returns the number of objects sent so far to the present client.
  std::uint32_t sent() const { return m_sent; }

 private:
  void receive(std::string_view frame) {
    wire::ClientMessage message;
    if (!message.ParseFromArray(frame.data(), static_cast<int>(frame.size()))) return;
    if (message.has_hello()) welcome();
    if (!message.has_ping()) return;
    wire::ServerMessage answer;
    answer.mutable_pong()->set_token(message.ping().token());
    m_channel->send(answer.SerializeAsString());
  }
  void welcome() {
    m_sent = 0;
    m_number = 0;
    m_tick = kFirstTick;
    wire::ServerMessage message;
    wire::Welcome& welcome = *message.mutable_welcome();
    welcome.set_player(1);
    welcome.set_name("victim");
    welcome.set_game("pile");
    welcome.set_tick_micros(static_cast<std::uint32_t>(kTick.count()));
    welcome.set_tick(m_tick);
    welcome.set_view_width(80);
    welcome.set_view_height(24);
    welcome.set_color(df::CYAN);
    m_channel->send(message.SerializeAsString());
    tick();
  }
  void tick() {
    ++m_tick;
    sendSnapshot();
    for (int i = 1; i < kSnapshotsPerTick && m_sent < kObjects; ++i) sendSnapshot();
    m_timer.expires_after(kTick);
    m_timer.async_wait([this](const asio::error_code& stopped) {
      if (!stopped) tick();
    });
  }
  // Sends a snapshot with as many objects as fit, or with none if all have been sent.
  void sendSnapshot() {
    SnapshotHeader header;
    header.number = ++m_number;
    header.tick = m_tick;
    SnapshotWriter out;
    out.beginSnapshot(header, 0, {});
    if (m_number == 1) {
      WorldRecord world;
      world.boundary = {{}, {df::fromCells(80), df::fromCells(24)}};
      out.write(world);
    }
    for (; m_sent < kObjects; ++m_sent) {
      const std::uint32_t id = m_sent + 1;
      const ObjectState object = objectOf(id, m_tick);
      const std::size_t bits = out.stage(kAllGroups, 1, object, shareMotion(object.motion));
      if (!out.hasSpace(bits, kObjects, kMaxSnapshot)) {
        out.drop();
        break;
      }
      out.commit(id);
    }
    out.setComplete(m_sent == kObjects);
    wire::ServerMessage message;
    message.set_snapshot(out.finish());
    m_channel->send(message.SerializeAsString());
  }

  asio::io_context m_context{1};
  asio::steady_timer m_timer{m_context};
  std::string m_fingerprint;
  std::unique_ptr<TcpListener> m_listener;
  std::unique_ptr<ReliableChannel> m_channel;
  std::atomic<std::uint32_t> m_sent{0};
  std::uint32_t m_number = 0;
  std::uint32_t m_tick = 0;
  std::thread m_thread;
};

constexpr auto kSendTime = 60s;  // timeout for sending all objects

/// Lets dfclient show the pile for this time, then calls `interrupt`. Returns the milliseconds until dfclient
/// ends, at most ten seconds. Sets `ended` if it ended before.
inline double endAfter(const std::string& folder, std::chrono::milliseconds shown, bool& ended,
                       const std::function<void(PtyTerminal&)>& interrupt) {
  PileServer server(folder + "/identity");
  PtyTerminal terminal({.command = {clientProgram(), "127.0.0.1:" + std::to_string(server.port()),
                                    "--fingerprint", server.fingerprint(), "--known-servers",
                                    folder + "/known", "--no-resume", "--name", "victim"},
                        .environment = {{"HOME", folder}, {"XDG_STATE_HOME", folder}},
                        .columns = 80,
                        .rows = 24});
  for (const auto end = Clock::now() + kSendTime;
       server.sent() < PileServer::kObjects && !terminal.hasExited();) {
    if (Clock::now() > end) throw std::runtime_error("dfclient does not take in the pile");
    terminal.read(20ms);
  }
  for (const auto end = Clock::now() + shown; Clock::now() < end && !terminal.hasExited();)
    terminal.read(20ms);
  ended = ended || terminal.hasExited();
  const Clock::time_point asked = Clock::now();
  interrupt(terminal);
  while (!terminal.hasExited() && Clock::now() - asked < 10s) terminal.read(5ms);
  return std::chrono::duration<double, std::milli>(Clock::now() - asked).count();
}

/// Tests SIGTERM and Ctrl-C, each after half of this time, at least 2 s. Throws std::runtime_error on
/// failure. Times above `most_ms` are faults.
inline Figures runHardPile(std::chrono::seconds duration, double most_ms) {
  const naiad::test::TempFolder folder;
  const auto shown = std::max<std::chrono::milliseconds>(duration / 2, 2s);
  bool ended = false;
  const double sigterm_ms =
      endAfter(folder.string(), shown, ended, [](auto& client) { client.signal(SIGTERM); });
  const double ctrl_c_ms = endAfter(folder.string(), shown, ended, [](auto& client) { client.type("\x03"); });
  return {{"seconds", static_cast<double>(duration.count())},
          {"sigterm_ms", sigterm_ms, sigterm_ms > most_ms},
          {"ctrl_c_ms", ctrl_c_ms, ctrl_c_ms > most_ms},
          {"client_ended", ended ? 1.0 : 0.0}};
}

}  // namespace bench::attack

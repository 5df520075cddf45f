// A server with a fixed picture, for tests of the client's terminal: sends Welcome and one object, and
// records the messages that it receives. Runs in its own thread.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <asio/post.hpp>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "ProgramEnd.h"
#include "PtyTerminal.h"
#include "naiad.pb.h"
#include "shared/net/base/Channel.h"
#include "shared/net/base/Limits.h"
#include "shared/net/stream/TcpChannel.h"
#include "shared/replica/Records.h"
#include "shared/replica/SnapshotCodec.h"
#include "shared/replica/UpdateCodec.h"
#include "shared/values/Color.h"

namespace naiad::test {

class FakeServer {
 public:
  FakeServer()
      : m_acceptor(m_context, asio::ip::tcp::endpoint(asio::ip::address_v4::loopback(), 0)),
        m_port(m_acceptor.local_endpoint().port()) {
    accept();
    m_thread = std::thread([this] { m_context.run(); });
  }
  ~FakeServer() {
    m_context.stop();
    m_thread.join();
  }

  std::uint16_t port() const { return m_port; }
  std::string address() const { return "127.0.0.1:" + std::to_string(m_port); }

  /// Waits until the client has sent a message that satisfies the predicate; false after 10 s.
  bool hasReceived(const std::function<bool(const wire::ClientMessage&)>& wanted) {
    std::unique_lock lock(m_mutex);
    return m_changed.wait_for(lock, std::chrono::seconds(10), [this, &wanted] {
      for (const wire::ClientMessage& message : m_messages) {
        if (wanted(message)) return true;
      }
      return false;
    });
  }
  /// Waits until an input has arrived that satisfies the predicate.
  bool heardInput(const std::function<bool(const Input&)>& wanted) {
    return heardUpdate(
        [&](const ClientUpdate& update) { return std::ranges::any_of(update.inputs, wanted); });
  }
  /// Waits until this key action arrived.
  bool heardKey(int key, int action) {
    return heardInput(
        [=](const Input& input) { return !input.is_mouse && input.key == key && input.action == action; });
  }
  /// Sets a function that changes each welcome before it is sent, from the next client on.
  void onWelcome(std::function<void(wire::ServerMessage&)> change) {
    const std::lock_guard lock(m_mutex);
    m_change = std::move(change);
  }
  /// Sends the client a message.
  void send(const wire::ServerMessage& message) {
    asio::post(m_context, [this, bytes = message.SerializeAsString()] { m_channel->send(bytes); });
  }
  /// Sends the client these objects, numbered from 100 and all with the look of the first, and the records,
  /// in as many snapshots as needed. Returns the last snapshot's number.
  std::uint32_t sendWorld(const std::vector<ObjectState>& objects, const df::ControlTable* p_table = nullptr,
                          const ControlRecord* p_control = nullptr) {
    constexpr std::size_t kAtOnce = 200;  // objects that fit into a snapshot
    // All objects use the first one's look, which is sent once.
    constexpr std::uint32_t kName = 1;
    std::vector<std::string> frames;
    SnapshotHeader header;
    header.number = 1;
    header.tick = 100;
    for (std::size_t first = 0; first < objects.size(); first += kAtOnce) {
      ++header.number;
      SnapshotWriter out;
      out.beginSnapshot(header, 0, {});
      std::string table;
      if (p_table != nullptr) writeControlTable(table, *p_table);
      if (first == 0 && p_table != nullptr) out.writeTable(table);
      if (first == 0 && p_control != nullptr) out.write(*p_control);
      for (std::size_t i = first; i < std::min(first + kAtOnce, objects.size()); ++i) {
        const LookForm form{i == 0 ? LookForm::kDefined : LookForm::kNamed, kName};
        BitWriter bits;
        out.encode(bits, kAllGroups, 1, objects[i], objects[i].motion, form);
        out.object(static_cast<std::uint32_t>(100 + i), std::move(bits));
      }
      wire::ServerMessage snapshot;
      snapshot.set_snapshot(out.finish());
      frames.push_back(snapshot.SerializeAsString());
    }
    asio::post(m_context, [this, frames = std::move(frames)] {
      for (const std::string& frame : frames) m_channel->send(frame);
    });
    return header.number;
  }
  /// Waits until the client has acknowledged this snapshot.
  bool heardAcknowledged(std::uint32_t number) {
    return heardUpdate([number](const ClientUpdate& update) { return update.acks.newest == number; });
  }
  /// Sends no picture after the welcome, from the next client on.
  void withholdPictures() { m_withholds = true; }
  /// Returns how many clients have connected.
  int connections() const { return m_connections; }
  /// Closes the connection without a goodbye.
  void drop() {
    asio::post(m_context, [this] { m_channel.reset(); });
  }

 private:
  void accept() {
    m_acceptor.async_accept([this](const std::error_code& error, asio::ip::tcp::socket socket) {
      if (error) return;
      ++m_connections;
      m_channel = makeTcpChannel(std::move(socket),
                                 TcpOptions{.send_cap = 64u << 20, .receive_limit = kMaxClientFrame});
      m_channel->start({[this](std::string_view frame) { onFrame(frame); }, [](CloseReason) {}});
      accept();
    });
  }
  void onFrame(std::string_view frame) {
    wire::ClientMessage message;
    if (!message.ParseFromArray(frame.data(), static_cast<int>(frame.size()))) return;
    if (message.has_hello()) welcome();
    if (message.has_ping()) {
      wire::ServerMessage pong;
      pong.mutable_pong()->set_token(message.ping().token());
      m_channel->send(pong.SerializeAsString());
    }
    const std::lock_guard lock(m_mutex);
    m_messages.push_back(message);
    m_changed.notify_all();
  }
  bool heardUpdate(const std::function<bool(const ClientUpdate&)>& wanted) {
    return hasReceived([&wanted](const wire::ClientMessage& message) {
      const auto update = message.payload_case() == wire::ClientMessage::kUpdate
                              ? readUpdate(message.update(), {})
                              : std::nullopt;
      return update && wanted(*update);
    });
  }
  void welcome() {
    wire::ServerMessage message;
    wire::Welcome& welcome = *message.mutable_welcome();
    welcome.set_player(1);
    welcome.set_name("Ada");
    welcome.set_game("still life");
    welcome.set_tick_micros(33333);
    welcome.set_tick(100);
    welcome.set_view_width(80);
    welcome.set_view_height(24);
    welcome.set_color(df::CYAN);
    welcome.set_server("fake 1");
    welcome.add_help("There is nothing to do.");
    {
      const std::lock_guard lock(m_mutex);
      if (m_change) m_change(message);
    }
    m_channel->send(message.SerializeAsString());
    if (m_withholds) return;

    SnapshotHeader header;
    header.number = 1;
    header.tick = 100;
    SnapshotWriter out;
    out.beginSnapshot(header, 0, {});
    WorldRecord world;
    world.boundary = {{}, {df::fromCells(80), df::fromCells(24)}};
    out.write(world);
    ObjectState object;
    object.motion = {100, {df::fromCells(20), df::fromCells(10)}, {}, {}};
    Appearance look;
    int x = 0;
    for (const char32_t ch : std::u32string(U"NAIAD-HERE"))
      look.push_back({x++ << kGlyphUnitBits, 0, ch, df::GREEN});
    object.look.sequence = {look};
    BitWriter bits;
    out.encode(bits, kAllGroups, 1, object, object.motion);
    out.object(1, std::move(bits));
    wire::ServerMessage snapshot;
    snapshot.set_snapshot(out.finish());
    m_channel->send(snapshot.SerializeAsString());
  }

  asio::io_context m_context;
  asio::ip::tcp::acceptor m_acceptor;
  std::uint16_t m_port;
  std::unique_ptr<ReliableChannel> m_channel;
  std::mutex m_mutex;
  std::condition_variable m_changed;
  std::vector<wire::ClientMessage> m_messages;
  std::function<void(wire::ServerMessage&)> m_change;  ///< see onWelcome()
  std::atomic<bool> m_withholds = false;
  std::atomic<int> m_connections = 0;
  std::thread m_thread;
};

/// Runs the real dfclient with such a server.
class FakeServerFixture : public testing::Test {
 protected:
  PtyTerminal::Options options() const {
    PtyTerminal::Options options;
    options.command = {programPath("dfclient"), server.address(), "--insecure", "--name", "Ada"};
    return options;
  }

  FakeServer server;
};

}  // namespace naiad::test

#include "FakeServer.h"

#include <algorithm>
#include <asio/post.hpp>
#include <chrono>

#include "shared/net/base/Limits.h"
#include "shared/net/stream/TcpChannel.h"
#include "shared/replica/SnapshotCodec.h"
#include "shared/values/Color.h"

namespace naiad::test {

using asio::ip::tcp;

FakeServer::FakeServer()
    : m_acceptor(m_context, tcp::endpoint(asio::ip::address_v4::loopback(), 0)),
      m_port(m_acceptor.local_endpoint().port()) {
  accept();
  m_thread = std::thread([this] { m_context.run(); });
}

FakeServer::~FakeServer() {
  m_context.stop();
  m_thread.join();
}

void FakeServer::accept() {
  m_acceptor.async_accept([this](const std::error_code& error, tcp::socket socket) {
    if (error) return;
    ++m_connections;
    m_channel = makeTcpChannel(std::move(socket),
                               TcpOptions{.send_cap = 64u << 20, .receive_limit = kMaxClientFrame});
    m_channel->start({[this](std::string_view frame) { onFrame(frame); }, [](CloseReason) {}});
    accept();
  });
}

void FakeServer::onFrame(std::string_view frame) {
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

void FakeServer::welcome() {
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

bool FakeServer::hasReceived(const std::function<bool(const wire::ClientMessage&)>& wanted) {
  std::unique_lock lock(m_mutex);
  return m_changed.wait_for(lock, std::chrono::seconds(10), [this, &wanted] {
    for (const wire::ClientMessage& message : m_messages) {
      if (wanted(message)) return true;
    }
    return false;
  });
}

bool FakeServer::heardUpdate(const std::function<bool(const ClientUpdate&)>& wanted) {
  return hasReceived([&wanted](const wire::ClientMessage& message) {
    const auto update = message.payload_case() == wire::ClientMessage::kUpdate
                            ? readUpdate(message.update(), {})
                            : std::nullopt;
    return update && wanted(*update);
  });
}

bool FakeServer::heardInput(const std::function<bool(const Input&)>& wanted) {
  return heardUpdate([&](const ClientUpdate& update) { return std::ranges::any_of(update.inputs, wanted); });
}

bool FakeServer::heardAcknowledged(std::uint32_t number) {
  return heardUpdate([number](const ClientUpdate& update) { return update.acks.newest == number; });
}

bool FakeServer::heardKey(int key, int action) {
  return heardInput(
      [=](const Input& input) { return !input.is_mouse && input.key == key && input.action == action; });
}

void FakeServer::onWelcome(std::function<void(wire::ServerMessage&)> change) {
  const std::lock_guard lock(m_mutex);
  m_change = std::move(change);
}

void FakeServer::send(const wire::ServerMessage& message) {
  asio::post(m_context, [this, bytes = message.SerializeAsString()] { m_channel->send(bytes); });
}

std::uint32_t FakeServer::sendWorld(const std::vector<ObjectState>& objects, const df::ControlTable* p_table,
                                    const ControlRecord* p_control) {
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

void FakeServer::drop() {
  asio::post(m_context, [this] { m_channel.reset(); });
}

}  // namespace naiad::test

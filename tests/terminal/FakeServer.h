// A server with a fixed picture, for tests of the client's terminal: sends Welcome and one object, and
// records the messages that it receives. Runs in its own thread.
#pragma once

#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "naiad.pb.h"
#include "shared/net/base/Channel.h"
#include "shared/replica/Records.h"
#include "shared/replica/UpdateCodec.h"

namespace naiad::test {

class FakeServer {
 public:
  FakeServer();
  ~FakeServer();

  std::uint16_t port() const { return m_port; }
  std::string address() const { return "127.0.0.1:" + std::to_string(m_port); }

  /// Waits until the client has sent a message that satisfies the predicate; false after 10 s.
  bool hasReceived(const std::function<bool(const wire::ClientMessage&)>& wanted);
  /// Waits until an input has arrived that satisfies the predicate.
  bool heardInput(const std::function<bool(const Input&)>& wanted);
  /// Waits until this key action arrived.
  bool heardKey(int key, int action);
  /// Sets a function that changes each welcome before it is sent, from the next client on.
  void onWelcome(std::function<void(wire::ServerMessage&)> change);
  /// Sends the client a message.
  void send(const wire::ServerMessage& message);
  /// Sends the client these objects, numbered from 100 and all with the look of the first, and the records,
  /// in as many snapshots as needed. Returns the last snapshot's number.
  std::uint32_t sendWorld(const std::vector<ObjectState>& objects, const df::ControlTable* p_table = nullptr,
                          const ControlRecord* p_control = nullptr);
  /// Waits until the client has acknowledged this snapshot.
  bool heardAcknowledged(std::uint32_t number);
  /// Sends no picture after the welcome, from the next client on.
  void withholdPictures() { m_withholds = true; }
  /// Returns how many clients have connected.
  int connections() const { return m_connections; }
  /// Closes the connection without a goodbye.
  void drop();

 private:
  void accept();
  void onFrame(std::string_view frame);
  bool heardUpdate(const std::function<bool(const ClientUpdate&)>& wanted);
  void welcome();

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

}  // namespace naiad::test

// One connection to the control socket.
#pragma once

#include <array>
#include <asio/local/stream_protocol.hpp>
#include <asio/steady_timer.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "host/admin/AdminCaller.h"
#include "host/process/WatchFeed.h"
#include "shared/admin/AdminJson.h"

namespace naiad {

/// Reads a line, has it carried out, writes the answer, and only then reads on: a program that sends much and
/// reads nothing waits. On the socket's thread. Keeps itself alive while something is under way.
class ControlConnection : public std::enable_shared_from_this<ControlConnection> {
 public:
  using Socket = asio::local::stream_protocol::socket;

  struct Events {
    /// A command; `done` on this thread.
    std::function<void(AdminRequest, AdminCaller, std::function<void(AdminAnswer)>)> execute;
    std::function<void()> on_watch;
    /// Called once.
    std::function<void(ControlConnection&)> on_closed;
  };

  ControlConnection(Socket socket, AdminCaller caller, bool is_short, Events events);
  void start(std::chrono::milliseconds short_time);
  /// Write one error, and hang up.
  void turnAway(const std::string& sentence);
  /// For a watcher: written, or counted if too much waits.
  void sendEvent(const WatchEvent& event);
  void noteDropped(std::uint64_t count) { m_dropped += m_watching ? count : 0; }
  bool isWatching() const { return m_watching; }
  /// Hang up once what waits is written.
  void finish();
  void close();

 private:
  bool isWriting() const { return !m_writing.empty() || !m_out.empty(); }
  void read();
  void onRead(const std::error_code& error, std::size_t size);
  void serveLines();
  void serveLine(std::string_view line);
  void onAnswer(const AdminAnswer& given, bool watches);
  void answer(const AdminAnswer& given);
  void send(const std::string& bytes);
  void write();
  void onWritten(const std::error_code& error);

  Socket m_socket;
  asio::steady_timer m_timer;
  AdminCaller m_caller;
  bool m_short;
  Events m_events;
  std::array<char, kMaxControlLine> m_piece{};
  std::string m_in;         ///< read, not served
  bool m_too_long = false;  ///< the rest of a line is skipped
  std::string m_out;        ///< to be written
  std::string m_writing;
  bool m_busy = false;  ///< a command is being carried out
  bool m_reading = false;
  bool m_ended = false;  ///< nothing more comes from there
  bool m_finishing = false;
  bool m_closed = false;
  bool m_watching = false;
  std::uint64_t m_dropped = 0;
};

}  // namespace naiad

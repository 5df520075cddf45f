// The Agones sidecar as a server sees it: HTTP on loopback, as in its published description. It answers as
// the test says and records the requests.
#pragma once

#include <algorithm>
#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <asio/read.hpp>
#include <asio/read_until.hpp>
#include <asio/streambuf.hpp>
#include <asio/write.hpp>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <istream>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace naiad::test {

class FakeSidecar {
 public:
  /// Returns status and body for a request such as "POST /ready {}".
  using Answer = std::function<std::pair<int, std::string>(const std::string& request)>;

  /// Binds a port, which refuses connections until start().
  FakeSidecar() {
    m_acceptor.open(asio::ip::tcp::v4());
    m_acceptor.bind({asio::ip::address_v4::loopback(), 0});
  }
  ~FakeSidecar() { stop(); }

  std::uint16_t port() const { return m_acceptor.local_endpoint().port(); }
  void start(Answer answer) {
    m_answer = std::move(answer);
    m_acceptor.listen();
    m_thread = std::thread([this] { run(); });
  }
  void stop() {
    if (!m_thread.joinable()) return;
    m_stopping = true;
    asio::io_context context;
    asio::ip::tcp::socket knock(context);
    asio::error_code error;
    knock.connect({asio::ip::address_v4::loopback(), port()}, error);  // NOLINT(bugprone-unused-return-value)
    m_thread.join();
    m_acceptor.close();
    const std::lock_guard lock(m_mutex);
    m_watchers.clear();
  }

  /// Waits until `holds` is true for all requests so far; false after a minute.
  bool wait(const std::function<bool(const std::vector<std::string>& requests)>& holds) {
    std::unique_lock lock(m_mutex);
    return m_asked.wait_for(lock, std::chrono::minutes(1), [&] { return holds(m_requests); });
  }
  bool waitFor(const std::string& request, std::size_t times = 1) {
    return wait([&](const auto& requests) {
      return static_cast<std::size_t>(std::ranges::count(requests, request)) >= times;
    });
  }
  std::vector<std::string> requests() {
    const std::lock_guard lock(m_mutex);
    return m_requests;
  }
  /// Sends `line` to all watchers, in pieces of this size.
  void push(const std::string& line, std::size_t piece = 1000) {
    const std::lock_guard lock(m_mutex);
    for (const auto& socket : m_watchers) {
      for (std::size_t i = 0; i < line.size(); i += piece) {
        const std::string part = line.substr(i, piece);
        char size[20];
        std::snprintf(size, sizeof size, "%zx\r\n", part.size());
        asio::error_code error;
        asio::write(*socket, asio::buffer(size + part + "\r\n"), error);
      }
    }
  }
  void endWatches() {
    const std::lock_guard lock(m_mutex);
    m_watchers.clear();
  }

 private:
  using Socket = asio::ip::tcp::socket;

  void run() {
    while (!m_stopping) {
      auto socket = std::make_shared<Socket>(m_context);
      asio::error_code error;
      m_acceptor.accept(*socket, error);
      if (error || m_stopping) continue;
      serve(socket);
    }
  }
  void serve(const std::shared_ptr<Socket>& socket) {
    asio::streambuf buffer;
    asio::error_code error;
    asio::read_until(*socket, buffer, "\r\n\r\n", error);
    if (error) return;
    std::istream in(&buffer);
    std::string method;
    std::string path;
    std::string line;
    in >> method >> path;
    std::size_t length = 0;
    while (std::getline(in, line) && line != "\r") {
      if (line.rfind("Content-Length: ", 0) == 0) length = std::stoul(line.substr(16));
    }
    if (buffer.size() < length)
      asio::read(*socket, buffer, asio::transfer_exactly(length - buffer.size()), error);
    std::string request = method + " " + path;
    if (length > 0)
      request += " " + std::string(asio::buffers_begin(buffer.data()), asio::buffers_end(buffer.data()));
    const auto [status, body] = m_answer(request);
    if (path == "/watch/gameserver" && status == 200) {
      asio::write(*socket, asio::buffer(std::string("HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\n")),
                  error);
      const std::lock_guard lock(m_mutex);
      m_watchers.push_back(socket);
      note(request);
    } else {
      {  // before the answer, after which the test may ask for the requests
        const std::lock_guard lock(m_mutex);
        note(request);
      }
      asio::write(*socket,
                  asio::buffer("HTTP/1.1 " + std::to_string(status) +
                               " X\r\nContent-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body),
                  error);
    }
  }
  void note(const std::string& request) {
    m_requests.push_back(request);
    m_asked.notify_all();
  }

  asio::io_context m_context;
  asio::ip::tcp::acceptor m_acceptor{m_context};
  Answer m_answer;
  std::atomic<bool> m_stopping = false;
  std::mutex m_mutex;
  std::condition_variable m_asked;
  std::vector<std::string> m_requests;
  std::vector<std::shared_ptr<Socket>> m_watchers;
  std::thread m_thread;
};

}  // namespace naiad::test

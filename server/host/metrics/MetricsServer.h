// A small HTTP server for metrics and health: GET of a few paths, on a thread of its own.
//
// It serves a scraper and health checks on this machine or a private network. Hostile clients cannot burden
// the host: there are few connections, each for one request with a small head, and all have deadlines.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>

#include "host/settings/MetricsAddress.h"

namespace naiad {

/// Thrown if the server cannot listen. what() is a one-sentence message.
class MetricsError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class MetricsServer {
 public:
  static constexpr std::size_t kMaxHead = std::size_t{4} * 1024;  ///< maximum bytes of a request
  /// Maximum number of connections. A new one replaces the oldest that is not being answered; if all are
  /// being answered, the new one is closed.
  static constexpr std::size_t kMaxConnections = 4;
  /// Timeout of receiving a request, and of sending its answer.
  static constexpr std::chrono::seconds kRequestTimeout{5};

  struct Response {
    int status = 200;
    std::string body;
    std::string_view type = "text/plain; charset=utf-8";  ///< a constant
  };
  /// Returns the answer for a path, with status 404 for unknown paths. Called on the server's thread.
  using Respond = std::function<Response(std::string_view path)>;

  /// Begins to listen. Throws MetricsError.
  MetricsServer(const MetricsAddress& address, MetricsHosts hosts, Respond respond);
  /// Ends the thread and closes all connections.
  ~MetricsServer();

  std::uint16_t port() const;
  /// CPU time used by the server's thread. Any thread.
  std::chrono::nanoseconds cpuTime() const;

 private:
  struct Loop;
  class Connection;
  std::unique_ptr<Loop> m_loop;
};

}  // namespace naiad

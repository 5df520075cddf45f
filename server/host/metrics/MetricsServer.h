// A small HTTP server for metrics and health: GET of a few paths, on a thread of its own.
//
// It is for a scraper and a health check of this machine or a private network, and is built to cost a host
// nothing whoever reaches it: few connections, each for one request with a small head, all with deadlines.
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

/// It cannot listen there; what() is a sentence.
class MetricsError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class MetricsServer {
 public:
  static constexpr std::size_t kMaxHead = std::size_t{4} * 1024;  ///< bytes of a request
  /// Connections at a time. The oldest that is not being answered ends for a new one; where all are, the new
  /// one ends.
  static constexpr std::size_t kMaxConnections = 4;
  /// For a request to come, and for its answer to go.
  static constexpr std::chrono::seconds kPatience{5};

  struct Answer {
    int status = 200;
    std::string body;
    std::string_view type = "text/plain; charset=utf-8";  ///< a constant
  };
  /// What a path has to say; nothing with status 404. Called on the server's thread.
  using Respond = std::function<Answer(std::string_view path)>;

  /// Listens and answers from now on. Throws MetricsError.
  MetricsServer(const MetricsAddress& address, MetricsHosts hosts, Respond respond);
  /// Ends the thread, and hangs up.
  ~MetricsServer();

  std::uint16_t port() const;
  /// That the thread has used so far. Any thread.
  std::chrono::nanoseconds cpuTime() const;

 private:
  struct Loop;
  class Connection;
  std::unique_ptr<Loop> m_loop;
};

}  // namespace naiad

// Handles SIGINT, SIGTERM and SIGHUP before the terminal is taken.
#pragma once

#include <signal.h>

#include <asio/io_context.hpp>
#include <asio/signal_set.hpp>
#include <functional>
#include <memory>
#include <system_error>
#include <utility>

namespace naiad {

/// Reports the first signal; the next one ends the process at once. The destructor restores the handling of
/// signals, but one that arrived earlier is still reported: `on_signal` must be valid while `context` runs.
/// Use from the thread that runs `context`.
class EarlySignalWatcher {
 public:
  EarlySignalWatcher(asio::io_context& context, std::function<void(int signal)> on_signal)
      : m_signals(std::make_shared<asio::signal_set>(context, SIGINT, SIGTERM, SIGHUP)) {
    // The handler owns the signal set, because it may still be queued when this is destroyed.
    m_signals->async_wait(
        [signals = m_signals, report = std::move(on_signal)](const std::error_code& error, int signal) {
          if (error) return;
          report(signal);
          std::error_code ignored;
          signals->clear(ignored);
        });
  }
  ~EarlySignalWatcher() {
    std::error_code ignored;
    m_signals->clear(ignored);
    m_signals->cancel(ignored);
  }
  EarlySignalWatcher(const EarlySignalWatcher&) = delete;
  EarlySignalWatcher& operator=(const EarlySignalWatcher&) = delete;

 private:
  std::shared_ptr<asio::signal_set> m_signals;
};

}  // namespace naiad

// SIGINT, SIGTERM and SIGHUP while the terminal is not taken over yet.
#pragma once

#include <signal.h>

#include <asio/io_context.hpp>
#include <asio/signal_set.hpp>
#include <functional>
#include <memory>
#include <system_error>
#include <utility>

namespace naiad {

/// Reports the first one; the next one ends the process at once. When this is destroyed, signals are as they
/// were. One that had come before is reported all the same: `on_signal` must live as long as `context` runs.
/// Thread: the one that runs `context`.
class EndSignals {
 public:
  EndSignals(asio::io_context& context, std::function<void(int signal)> on_signal)
      : m_signals(std::make_shared<asio::signal_set>(context, SIGINT, SIGTERM, SIGHUP)) {
    // Its completion may be queued already when this is destroyed: so it owns what it uses.
    m_signals->async_wait(
        [signals = m_signals, report = std::move(on_signal)](const std::error_code& error, int signal) {
          if (error) return;
          report(signal);
          std::error_code ignored;
          signals->clear(ignored);
        });
  }
  ~EndSignals() {
    std::error_code ignored;
    m_signals->clear(ignored);
    m_signals->cancel(ignored);
  }
  EndSignals(const EndSignals&) = delete;
  EndSignals& operator=(const EndSignals&) = delete;

 private:
  std::shared_ptr<asio::signal_set> m_signals;
};

}  // namespace naiad

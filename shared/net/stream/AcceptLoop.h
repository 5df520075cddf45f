// The accept loop that listeners share.
#pragma once

#include <asio/io_context.hpp>
#include <asio/steady_timer.hpp>
#include <chrono>
#include <memory>
#include <system_error>
#include <utility>

namespace naiad {

/// Time for which a listener pauses after a failed accept.
inline constexpr std::chrono::milliseconds kAcceptRetryDelay{100};

/// Base of a listener's state. Accepts until its acceptor is closed. If an accept fails, usually without free
/// descriptors or memory, it retries after kAcceptRetryDelay; the connections wait in the kernel's backlog.
///
/// `State` is owned by std::shared_ptr; pending operations keep it alive. It has
///
///   void onConnection(Socket socket);         called for each connection; may close the acceptor
///   … counters.failed_accepts         counts attempts that will be retried
///
/// Thread: the one that runs `context`, which must outlive it.
template <class State, class Protocol>
class AcceptLoop : public std::enable_shared_from_this<State> {
 public:
  using Socket = typename Protocol::socket;

  /// Begins to accept. Call it when `acceptor` listens.
  void accept() {
    acceptor.async_accept([self = this->shared_from_this()](const std::error_code& error, Socket socket) {
      self->onAccepted(error, std::move(socket));
    });
  }
  void stopAccepting() {
    std::error_code ignored;
    acceptor.close(ignored);
    m_retry.cancel();
  }

  typename Protocol::acceptor acceptor;

 protected:
  explicit AcceptLoop(asio::io_context& context) : acceptor(context), m_retry(context) {}

 private:
  void onAccepted(const std::error_code& error, Socket socket) {
    if (!acceptor.is_open()) return;
    State& state = static_cast<State&>(*this);
    if (!error) {
      state.onConnection(std::move(socket));
      if (acceptor.is_open()) accept();
      return;
    }
    ++state.counters.failed_accepts;
    m_retry.expires_after(kAcceptRetryDelay);
    m_retry.async_wait([self = this->shared_from_this()](const std::error_code&) {
      if (self->acceptor.is_open()) self->accept();
    });
  }

  asio::steady_timer m_retry;
};

}  // namespace naiad

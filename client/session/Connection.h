// Joins a server and stays joined: connects, makes a ClientSession, and rejoins when that is lost.
//
//   kJoining --picture--> kJoined --lost--> kReconnecting --picture--> kJoined
//   kJoining --no answer, or connections closed without one for 4 s--> kUnreachable
//   kJoining --Refused (BUSY)--> kJoining --60 s of such refusals--> kRefused
//   kJoining --Refused with a redirect--> kJoining the redirect target (StreamOpener::follow()), once
//   kJoining the target --Refused (FULL), or no answer for 4 s--> kJoining the original server, once
//   kReconnecting the target --no answer for 10 s--> kReconnecting, both servers in turn
//   any --any other Refused, or a server that is not trusted--> kRefused
//   any --Goodbye--> kEnded
//   kJoined --Goodbye of a server that restarts--> kReconnecting
//   kReconnecting --60 s without success (longer if a restarting server announced it)--> kLost
//   kJoined --lost, without `rejoin`--> kLost; any --leave()--> kLeft
//
// While both servers are asked, the original server may redirect again; any other Refused from it counts as
// no answer. Otherwise, a BUSY server restarts the time limit of kReconnecting.
//
// While reconnecting, session() is still the lost session, so that its last picture can stay on the screen
// under a banner. A session that outlives its stream (ClientSession::isDetached) continues: another stream is
// opened, and if the server still knows the session, the player notices nothing. The pause between attempts
// doubles from 0.25 s to 2 s, also after BUSY refusals.
//
// A StreamOpener opens the streams: by TCP, or by WebSocket to a gateway, as in a browser.
//
// Use from the thread that calls the opener's callbacks.
#pragma once

#include <asio/ts/netfwd.hpp>
#include <chrono>
#include <functional>
#include <memory>
#include <string>

#include "client/session/ClientSession.h"
#include "client/session/StreamOpener.h"
#include "client/trust/ServerAddress.h"
#include "client/trust/TokenStore.h"

namespace naiad {

class Connection {
 public:
  using Clock = std::chrono::steady_clock;
  using Time = Clock::time_point;
  enum class State { kJoining, kJoined, kReconnecting, kUnreachable, kRefused, kEnded, kLost, kLeft };

  static constexpr std::chrono::milliseconds kFirstBackoff{250};
  static constexpr std::chrono::milliseconds kMaxBackoff{2000};
  static constexpr std::chrono::seconds kReconnectTimeout{60};
  /// Retry time while joining, if the server closes the connections without an answer: because of too many
  /// handshakes from the client's address, or because it restarts.
  static constexpr std::chrono::seconds kHandshakeRetryTimeout{4};
  /// Time for which only a lost redirect target is retried; then the original server is asked, too, for
  /// another target. A server restarts with its round in less time.
  static constexpr std::chrono::milliseconds kOriginalRetryDelay{10'000};

  /// `rejoin`: reconnect if the server is lost. `address`: the server to which `opener` opens streams.
  /// Nothing happens before start().
  Connection(std::unique_ptr<StreamOpener> opener, ServerAddress address, SessionOptions options,
             bool rejoin);
  /// Connects by TCP (TcpStreamOpener.h), with datagrams where these pass, or through a gateway
  /// (GatewayStreamOpener.h). The context must outlive the Connection.
  Connection(asio::io_context& context, const ServerAddress& address, const SessionOptions& options,
             bool rejoin, const ServerTrust& trust = {});

  /// Saves the session's token in `tokens`, which must outlive the Connection, and resumes the session saved
  /// there. After a redirect, `tokens` is not used. Call before start().
  void setTokenStore(TokenStore& tokens) { m_p_tokens = &tokens; }
  /// Before start(): replaces kOriginalRetryDelay, and a longer kHandshakeRetryTimeout for redirect targets.
  void setOriginalRetryDelay(std::chrono::milliseconds time) { m_original_retry_delay = time; }
  void start();
  /// Handles timeouts, pings and the next attempt. Call about ten times a second, and after every event.
  void update(Time now);
  /// Leaves on purpose. Run the event loop for a moment afterwards to send the message.
  void leave();
  /// Sends the terminal's size, now and when rejoining.
  void resize(int columns, int rows);
  /// Sets a function to be called for each new session, before it receives anything. For recorders.
  void onSession(std::function<void(ClientSession&)> observer) { m_observer = std::move(observer); }

  State state() const { return m_state; }
  /// True in all states but kJoining, kJoined and kReconnecting.
  bool isOver() const;
  /// Reason for the state, for people: set in all final states but kLeft; while reconnecting, why the server
  /// was lost; while isDeferred(), the server's message.
  const std::string& message() const { return m_message; }
  /// True after a BUSY refusal; a retry is scheduled.
  bool isDeferred() const { return m_deferred; }
  /// True if the server refused for a missing or wrong password. False for the target of a redirect.
  bool isPasswordRefused() const { return m_password_refused; }
  /// The newest stream's key (StreamOpener::key()); nullopt without TLS or before this server's first stream.
  const std::optional<Fingerprint>& key() const { return m_key; }
  /// The session to show; null before the first picture.
  ClientSession* session() { return m_session.get(); }
  /// Returns how long the client has waited for a first picture since the welcome; zero if it does not wait.
  Clock::duration pictureWait(Time now) const {
    return m_pending ? m_pending->pictureWait(now) : Clock::duration::zero();
  }
  /// Counts changes of the state, of message() and of session(). They change only in update(), in leave(),
  /// and in callbacks of the opener and its channels.
  std::uint64_t revision() const { return m_revision; }
  /// Address of the server that is asked or joined: the original one, or the target of a redirect.
  const ServerAddress& address() const { return m_address; }
  bool isRedirected() const { return m_redirected; }

 private:
  void attempt();
  void openSecond();
  void attach(std::unique_ptr<ReliableChannel> channel);
  void chooseToken(SessionOptions& options) const;
  void saveToken(const ClientSession& session);
  void onAttemptFailed(const std::string& message, Time now, bool was_closed = false);
  bool shouldRetryHandshake(Time now, bool was_closed);
  void retryLater(Time now);
  void scheduleAttempt(Time now);
  /// Starts to search for the server of a lost session.
  void search(const std::string& why, std::chrono::seconds reconnect_timeout, Time now, Time first_attempt);
  void onJoined();
  void checkPending(Time now);
  void checkRefusal(const ClientSession& refused, Time now);
  bool followRedirect(const std::string& link, const std::string& room);
  bool retryOriginal();
  void swapServers();
  bool isOriginalRetryDue(Time now) const;
  void waitForServer(const std::string& message);
  void finish(State state, const std::string& message);

  std::unique_ptr<StreamOpener> m_opener;
  ServerAddress m_address;
  SessionOptions m_options;
  bool m_rejoin;
  TokenStore* m_p_tokens = nullptr;
  std::optional<Fingerprint> m_key;        ///< the server's key on the newest stream
  std::optional<Fingerprint> m_token_key;  ///< key of the server that gave m_token
  std::string m_token;                     ///< newest token of the session
  bool m_resized = false;                  ///< the terminal's size changed after m_pending sent it
  State m_state = State::kJoining;
  std::string m_message;
  std::unique_ptr<ClientSession> m_session;  ///< the session to show; null before the first picture
  std::unique_ptr<ClientSession> m_pending;  ///< new session: greeting, or waiting for its first picture
  std::function<void(ClientSession&)> m_observer;
  std::chrono::milliseconds m_backoff{kFirstBackoff};
  Time m_next_attempt = Time::max();
  Time m_handshake_closed_at = Time::max();  ///< while joining: time of the first failure that was retried
  Time m_lost_at{};                          ///< start of m_reconnect_timeout: the loss, or a BUSY refusal
  bool m_busy = false;                       ///< while joining: the server has refused with BUSY
  std::chrono::seconds m_reconnect_timeout{kReconnectTimeout};
  bool m_deferred = false;
  bool m_password_refused = false;
  bool m_redirected = false;
  /// Data for joining the other server: the original one or, while that one is asked, the redirect target.
  struct ServerTarget {
    std::unique_ptr<StreamOpener> opener;
    ServerAddress address;
    std::string password;
    std::string room;
  };
  std::unique_ptr<ServerTarget> m_other;  ///< null without a redirect
  ServerAddress m_joined;                 ///< server of session()
  bool m_trying_original = false;         ///< after a redirect, the original server is asked again
  bool m_original_retried = false;        ///< the original server was asked again since the last join
  std::chrono::milliseconds m_original_retry_delay{kOriginalRetryDelay};
  Time m_original_retry_at{};  ///< while reconnecting: earliest time to ask the original server
  std::uint64_t m_revision = 0;
};

}  // namespace naiad

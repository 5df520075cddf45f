// Joins a server and stays joined: connects, makes a ClientSession, and joins again when it was lost.
//
//   kJoining --picture--> kJoined --lost--> kSearching --picture--> kJoined
//   kJoining --no answer; hung up on for 4 s--> kUnreachable
//   kJoining --Refused (BUSY)--> kJoining --60 s of that--> kRefused
//   kJoining --Refused, and sent to another server--> kJoining, there (StreamOpener::follow(): once)
//   kJoining, there --Refused (FULL), no answer for 4 s--> kJoining, at the first one again: once
//   kSearching, there --no answer for 10 s--> kSearching, at both in turn; the first one may send it on
//   any --Refused--> kRefused
//   any --Goodbye--> kEnded
//   kJoined --Goodbye of a server that restarts--> kSearching
//   kSearching --60 s without success, or as long as a server that restarts has asked for--> kLost; a server
//     that says that it is busy is there, so the time begins again
//
// While searching, session() is still the lost one, so that its last picture can stay on the screen under a
// banner. A session that outlives its stream (ClientSession::isDetached) goes on meanwhile: another
// stream is opened, and if the server still knows the session, the player notices nothing. The waiting time
// between attempts doubles from 0.25 s to 2 s. A server that refuses only for now is asked again in the same
// way. After any other refusal it does not try again.
//
// It opens no streams itself: a StreamOpener does, by TCP in the terminal, by WebSocket in a browser.
//
// Thread: the one that calls the opener's callbacks.
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
  enum class State { kJoining, kJoined, kSearching, kUnreachable, kRefused, kEnded, kLost, kLeft };

  static constexpr std::chrono::milliseconds kFirstBackoff{250};
  static constexpr std::chrono::milliseconds kLastBackoff{2000};
  static constexpr std::chrono::seconds kGiveUp{60};
  /// A server hangs up on handshakes when too many come from one address: a newcomer tries for so long.
  static constexpr std::chrono::seconds kHungUpPatience{4};
  /// A server to which the client was sent, and which it has lost, is looked for so long before the one that
  /// sent it there is asked for another, too: longer than a server takes that begins again with its round.
  static constexpr std::chrono::milliseconds kAskAgainAfter{10'000};

  /// `rejoin`: look for a lost server again. `address`: for people. Nothing happens before start().
  Connection(std::unique_ptr<StreamOpener> opener, ServerAddress address, SessionOptions options,
             bool rejoin);
  /// By TCP (TcpStreamOpener.h), with datagrams where these pass, or through a gateway (GatewayStreams.h).
  /// The context must outlive the Connection.
  Connection(asio::io_context& context, const ServerAddress& address, const SessionOptions& options,
             bool rejoin, const ServerTrust& trust = {});

  /// Keep the session's token there, which must outlive the Connection, and go on with the session that is in
  /// it. Before start().
  void keepIn(TokenStore& tokens) { m_p_tokens = &tokens; }
  /// Instead of kAskAgainAfter, and of kHungUpPatience there. Before start().
  void askAgainAfter(std::chrono::milliseconds time) { m_ask_again_after = time; }
  void start();
  /// Time-outs, pings, the next attempt. Call about ten times a second, and after every event.
  void update(Time now);
  /// Leave on purpose. Run the event loop for a moment so that the message is sent.
  void leave();
  /// Send the terminal's size, now and when joining again.
  void resize(int columns, int rows);
  /// Called for each session as it is made, before it receives anything. For recorders.
  void onSession(std::function<void(ClientSession&)> observer) { m_observer = std::move(observer); }

  State state() const { return m_state; }
  /// Nothing will happen any more.
  bool isOver() const;
  /// Why, for people: set in all states that are over but kLeft; while searching, why the server was lost;
  /// while isPutOff(), what the server says.
  const std::string& sentence() const { return m_sentence; }
  /// The server has refused the last attempt for now. The next one comes by itself.
  bool isPutOff() const { return m_put_off; }
  /// Refused, for the server's password was missing or wrong.
  bool isPasswordRefused() const { return m_password_refused; }
  /// The server's key, as of the newest stream; nothing without TLS.
  const std::optional<Fingerprint>& key() const { return m_key; }
  /// The session to show; null before the first picture.
  ClientSession* session() { return m_session.get(); }
  /// How long a server that let the client in has not sent a first picture; zero while there is no such one.
  Clock::duration pictureWait(Time now) const {
    return m_pending ? m_pending->pictureWait(now) : Clock::duration::zero();
  }
  /// The state can change, or a new session can replace session(), only in update() and in the opener's
  /// callbacks; this counts both.
  std::uint64_t revision() const { return m_revision; }
  /// Of the server: where the first one has sent the client, from then on.
  const ServerAddress& address() const { return m_address; }
  /// It was sent there by the server that was asked for.
  bool isRedirected() const { return m_redirected; }

 private:
  void attempt();
  void openSecond();
  void attach(std::unique_ptr<ReliableChannel> channel);
  void chooseToken(SessionOptions& options) const;
  void saveToken(const ClientSession& session);
  void attemptFailed(const std::string& sentence);
  bool isHungUpOn(Time now);
  void retryLater(Time now);
  void tryLater(Time now);
  /// The session was lost: look for its server.
  void search(const std::string& why, std::chrono::seconds give_up, Time now, Time first_attempt);
  void noteJoined();
  void checkPending();
  void checkRefusal(const ClientSession& refused);
  bool followRedirect(const std::string& link, const std::string& room);
  bool askFirstAgain();
  void swapServers();
  bool isTimeToAskFirst(Time now) const;
  void waitForServer(const std::string& sentence);
  void finish(State state, const std::string& sentence);

  std::unique_ptr<StreamOpener> m_opener;
  ServerAddress m_address;
  SessionOptions m_options;
  bool m_rejoin;
  TokenStore* m_p_tokens = nullptr;
  std::optional<Fingerprint> m_key;        ///< of the server on the newest stream
  std::optional<Fingerprint> m_token_key;  ///< of the server that gave m_token
  std::string m_token;                     ///< newest of the session
  bool m_resized = false;                  ///< since the pending session said how large the terminal is
  State m_state = State::kJoining;
  std::string m_sentence;
  std::unique_ptr<ClientSession> m_session;  ///< shown
  std::unique_ptr<ClientSession> m_pending;  ///< greeting, or waiting for its first picture
  std::function<void(ClientSession&)> m_observer;
  std::chrono::milliseconds m_backoff{kFirstBackoff};
  Time m_next_attempt = Time::max();
  Time m_hung_up_at = Time::max();  ///< while joining, when the server first hung up on a handshake
  Time m_lost_at{};                 ///< while searching; while joining, when the server first refused for now
  bool m_busy = false;              ///< while joining: it has refused for now
  std::chrono::seconds m_give_up{kGiveUp};
  bool m_put_off = false;
  bool m_password_refused = false;
  bool m_redirected = false;
  /// Of the server that sent the client on: what it is joined with; while that one is asked again, the same
  /// of the server to which the client was sent. Null: it was sent nowhere.
  struct Place {
    std::unique_ptr<StreamOpener> opener;
    ServerAddress address;
    std::string password;
    std::string room;
  };
  std::unique_ptr<Place> m_other;
  ServerAddress m_joined;     ///< where session() plays
  bool m_asks_first = false;  ///< the first server is asked again
  bool m_has_asked = false;   ///< … since the last picture
  std::chrono::milliseconds m_ask_again_after{kAskAgainAfter};
  Time m_ask_first_at{};  ///< while searching: not before
  std::uint64_t m_revision = 0;
};

}  // namespace naiad

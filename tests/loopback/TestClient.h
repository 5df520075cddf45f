// A client without a screen, driven by the test's thread. Uses the client library of dfclient and dfbot.
#pragma once

#include <asio/io_context.hpp>
#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "client/bot/TruthRecorder.h"
#include "client/session/Connection.h"
#include "client/trust/SessionFile.h"
#include "tests/support/Sanitizers.h"
#include "tests/support/Text.h"

namespace naiad::test {

using Clock = std::chrono::steady_clock;

/// Timeout, long enough for a loaded machine. Only tests that fail reach it.
inline constexpr std::chrono::seconds kPatience{kSanitized ? 120 : 60};

/// A client's options, the keys it trusts, and whether it reconnects.
struct ClientSetup {
  SessionOptions options;
  ServerTrust trust;
  bool rejoin = false;
  std::filesystem::path sessions;  ///< folder of the session files; empty: none are kept
};
/// Returns a setup for plain TCP without reconnects.
ClientSetup insecurely(const std::string& name);

/// Its destructor acts, for the server, like killing the client's process.
class TestClient {
 public:
  TestClient(asio::io_context& context, std::uint16_t port, const std::string& name)
      : TestClient(context, port, insecurely(name)) {}
  TestClient(asio::io_context& context, std::uint16_t port, const ClientSetup& setup);

  Connection& connection() { return m_connection; }
  /// Returns the session being played; the client must be joined.
  ClientSession& session() { return *m_connection.session(); }
  bool joined() const { return m_connection.state() == Connection::State::kJoined; }
  std::uint32_t player() { return session().welcome().player; }
  std::uint32_t newestTick() { return session().clock().newestTick(); }
  /// Returns the pictures of ticks that can no longer change, by tick.
  const std::map<std::uint32_t, df::Canvas>& pictures() const { return m_pictures; }
  void keepPictures(bool keep) { m_keep = keep; }
  /// Keeps only later pictures.
  void forgetPictures() { m_pictures.clear(); }
  /// Keeps only complete pictures from now on, at ticks of snapshots. For networks that lose snapshots.
  void keepWholePictures() { m_only_whole = true; }

 private:
  void record(ClientSession& session, std::uint32_t tick);

  std::optional<SessionFile> m_file;
  Connection m_connection;
  std::map<std::uint32_t, df::Canvas> m_pictures;
  CompletenessTracker m_whole;
  std::uint32_t m_recorded = 0;  ///< newest tick whose picture was recorded
  bool m_keep = true;
  bool m_only_whole = false;
};

/// Presses this key for the player now.
void press(TestClient& client, df::Keyboard::Key key);

/// True if the client is in the game and receives its pictures as datagrams.
bool isOnDatagrams(TestClient& client);
/// True if the client is in the game and lists this player.
bool lists(TestClient& client, const std::string& name);
/// True if the client has received a chat line that contains `text`.
bool hasRead(TestClient& client, const std::string& text);

/// Returns the number after `label` in a row of a picture; nullopt if missing.
std::optional<int> numberAfter(const std::string& row, const std::string& label);

/// Serves the clients' sockets until `done` returns true. False after kPatience.
bool serveUntil(asio::io_context& context, const std::vector<TestClient*>& clients,
                const std::function<bool()>& done);
/// Like serveUntil(), but returns the time it took; nullopt after kPatience. Time in which this process's
/// threads wait for a processor does not count, and one iteration of the loop counts as at most 10 ms.
std::optional<std::chrono::nanoseconds> timeUntil(asio::io_context& context,
                                                  const std::vector<TestClient*>& clients,
                                                  const std::function<bool()>& done);

}  // namespace naiad::test

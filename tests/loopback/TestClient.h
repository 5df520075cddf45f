// A client without a screen, driven by the test's thread: the same library as dfclient and dfbot.
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

/// Long enough for a loaded machine; a test that needs it has failed anyway.
inline constexpr std::chrono::seconds kPatience{kSanitized ? 120 : 60};

/// A client's options, the keys it trusts, and whether it comes back.
struct ClientSetup {
  SessionOptions options;
  ServerTrust trust;
  bool rejoin = false;
  std::filesystem::path sessions;  ///< where session files lie; empty: nowhere
};
/// Plain TCP, without coming back.
ClientSetup insecurely(const std::string& name);

/// Destroying it is as if its process was killed.
class TestClient {
 public:
  TestClient(asio::io_context& context, std::uint16_t port, const std::string& name)
      : TestClient(context, port, insecurely(name)) {}
  TestClient(asio::io_context& context, std::uint16_t port, const ClientSetup& setup);

  Connection& connection() { return m_connection; }
  /// The session being played; must be joined.
  ClientSession& session() { return *m_connection.session(); }
  bool joined() const { return m_connection.state() == Connection::State::kJoined; }
  std::uint32_t player() { return session().welcome().player; }
  std::uint32_t newestTick() { return session().clock().newestTick(); }
  /// What the client's replica shows at each tick that can no longer change, by tick.
  const std::map<std::uint32_t, df::Canvas>& pictures() const { return m_pictures; }
  void keepPictures(bool keep) { m_keep = keep; }
  /// Keep those from now on only.
  void forgetPictures() { m_pictures.clear(); }
  /// Where snapshots may be lost on the way: from now on, keep only pictures of a snapshot's own tick that
  /// show all which was sent until then.
  void keepWholePictures() { m_only_whole = true; }

 private:
  void record(ClientSession& session, std::uint32_t tick);

  std::optional<SessionFile> m_file;
  Connection m_connection;
  std::map<std::uint32_t, df::Canvas> m_pictures;
  WholePicture m_whole;
  std::uint32_t m_recorded = 0;  ///< newest tick recorded
  bool m_keep = true;
  bool m_only_whole = false;
};

/// The player presses this key now.
void press(TestClient& client, df::Keyboard::Key key);

/// It is in the game, and its pictures come as datagrams.
bool isOnDatagrams(TestClient& client);
/// It is in the game, and this player is in its list.
bool lists(TestClient& client, const std::string& name);
/// It has read a line of chat with this in it.
bool hasRead(TestClient& client, const std::string& text);

/// The number behind `label` in a row of a picture; nothing if there is none.
std::optional<int> numberAfter(const std::string& row, const std::string& label);

/// Serve the clients' sockets until `done`, or give up after kPatience and return false.
bool serveUntil(asio::io_context& context, const std::vector<TestClient*>& clients,
                const std::function<bool()>& done);
/// The same; returns how long it took, nothing if it gave up. Time in which the threads of this process wait
/// for a processor does not count, and a turn of the loop counts for 10 ms at most.
std::optional<std::chrono::nanoseconds> timeUntil(asio::io_context& context,
                                                  const std::vector<TestClient*>& clients,
                                                  const std::function<bool()>& done);

}  // namespace naiad::test

// Repeated attempts of a Connection, with a scripted opener and a clock that the test advances.
#include <gtest/gtest.h>

#include <chrono>
#include <deque>
#include <memory>
#include <string>
#include <utility>

#include "client/session/Connection.h"
#include "naiad.pb.h"
#include "tests/support/MessageLine.h"

namespace naiad::test {
namespace {

using namespace std::chrono_literals;

using Line = MessageLine<wire::ClientMessage>;

/// The result of attempts to open a stream: a stream, or a failure before or in the handshake.
enum class Opening { kStream, kRefused, kClosedInHandshake };

/// Opens a stream on a new line, or fails.
class ScriptedOpener : public StreamOpener {
 public:
  ScriptedOpener(std::deque<Line>& lines, const Opening& opening) : m_lines(lines), m_opening(opening) {}
  void open(Done done) override {
    if (m_opening != Opening::kStream) return done(nullptr, "no connection");
    done(std::make_unique<FakeChannel>(m_lines.emplace_back()), "");
  }
  void openSecond(Done /*done*/) override {}
  void cancel() override {}
  std::optional<Fingerprint> key() const override { return std::nullopt; }
  std::optional<Fingerprint> keyOfSecond() const override { return std::nullopt; }
  std::string trustError() const override { return {}; }
  bool closedDuringHandshake() const override { return m_opening == Opening::kClosedInHandshake; }

 private:
  std::deque<Line>& m_lines;
  const Opening& m_opening;
};

/// A newcomer whose server closes each stream before it answers.
class HungUp : public testing::Test {
 protected:
  HungUp() {
    connection.start();
    closeNewest();
  }
  void closeNewest() { lines.back().callbacks.on_closed(CloseReason::kPeer); }
  /// Lets this time pass. Streams opened in it are closed if `closes`.
  void pass(std::chrono::milliseconds time, bool closes = true) {
    for (const auto end = now + time; now < end && !connection.isOver(); now += 50ms) {
      const std::size_t before = lines.size();
      connection.update(now);
      if (closes && lines.size() > before) closeNewest();
    }
  }

  std::deque<Line> lines;
  Opening opening = Opening::kStream;
  Connection::Time now = Connection::Clock::now();
  Connection connection{std::make_unique<ScriptedOpener>(lines, opening), ServerAddress{"127.0.0.1", 1},
                        SessionOptions(), true};
};

TEST_F(HungUp, ClosedNewcomerTriesAgain) {
  pass(1s);
  EXPECT_GE(lines.size(), 3u);
  opening = Opening::kRefused;  // as while a restarting server does not listen
  pass(1s);
  opening = Opening::kStream;
  const std::size_t before = lines.size();
  pass(2s, false);
  EXPECT_EQ(lines.size(), before + 1) << "it waits for the answer on the next stream";
  EXPECT_EQ(connection.state(), Connection::State::kJoining) << connection.message();
}

TEST_F(HungUp, ClosedNewcomerGivesUpAfterFourSeconds) {
  const auto begin = now;
  pass(1min);
  EXPECT_EQ(connection.state(), Connection::State::kUnreachable);
  EXPECT_FALSE(connection.message().empty());
  EXPECT_GE(now - begin, Connection::kHandshakeRetryTimeout);
  EXPECT_LE(now - begin, Connection::kHandshakeRetryTimeout + Connection::kMaxBackoff + 1s);
}

TEST_F(HungUp, ClosedHandshakeIsRetriedAtFirst) {
  for (const auto& [failure, state] : {std::pair{Opening::kClosedInHandshake, Connection::State::kJoining},
                                       {Opening::kRefused, Connection::State::kUnreachable}}) {
    opening = failure;
    Connection other(std::make_unique<ScriptedOpener>(lines, opening), ServerAddress{"127.0.0.1", 1},
                     SessionOptions(), true);
    other.start();
    EXPECT_EQ(other.state(), state);
  }
}

TEST_F(HungUp, LeavingEndsTheWaitForABusyServer) {
  pass(1s, false);
  wire::ServerMessage busy;
  busy.mutable_refused()->set_reason(wire::Refused::BUSY);
  lines.back().callbacks.on_frame(busy.SerializeAsString());
  connection.update(now);
  EXPECT_TRUE(connection.isDeferred());
  connection.leave();
  EXPECT_FALSE(connection.isDeferred());
}

}  // namespace
}  // namespace naiad::test

// Tests that a client resumes a session: on another stream or in another process, from the data that it
// stored.
#include "ClientSessionFixture.h"

namespace naiad::test {
namespace {

using namespace std::chrono_literals;

class ClientReturn : public ClientSessionFixture {
 protected:
  /// Starts the session in a new process that has only the token.
  void beginFresh() {
    SessionOptions options = optionsWith("0123456789abcdef");
    options.new_process = true;
    session = std::make_unique<ClientSession>(std::make_unique<FakeChannel>(log), options, now);
  }
  /// Starts a new process, and the server resumes the session.
  void restart(const std::optional<ResumeState>& from) {
    beginFresh();
    wire::ServerMessage message = welcomeMessage();
    message.mutable_welcome()->set_resumed(true);
    message.mutable_welcome()->set_resume_token("fedcba9876543210");
    if (from) {
      wire::ResumeState& wire = *message.mutable_welcome()->mutable_resume_state();
      wire.set_snapshot(from->snapshot);
      wire.set_world_epoch(from->world_epoch);
      wire.set_input(from->input);
    }
    receive(message);
  }
  static wire::ServerMessage emptySnapshot(std::uint32_t number, std::uint32_t epoch) {
    SnapshotHeader header;
    header.number = number;
    header.tick = 5;
    header.epoch = static_cast<std::uint8_t>(epoch);
    return bareSnapshot(header);
  }
  /// Returns options to resume the session with this token; empty: none.
  static SessionOptions optionsWith(const std::string& token) {
    SessionOptions options;
    options.name = "Ada";
    options.resume_token = token;
    return options;
  }
  /// Joins a session that can be resumed on another stream.
  void joinResumable() {
    welcome.mutable_welcome()->set_resume_token("token");
    receive(welcome);
  }
  /// Resumes the session on another stream `next`, which must outlive the session. The server sends
  /// `welcome`.
  void resumeOn(MessageLine<wire::ClientMessage>& next) {
    SessionOptions options = optionsWith("token");
    options.last_frame = session->receivedFrames();
    ClientSession pending(std::make_unique<FakeChannel>(next), options, now);
    welcome.mutable_welcome()->set_resumed(true);
    pending.receive(welcome.SerializeAsString(), now);
    session->adopt(pending, now);
  }
  static wire::ServerMessage line(const std::string& text, std::uint32_t number) {
    wire::ServerMessage message;
    message.mutable_chat()->set_text(text);
    message.set_number(number);
    return message;
  }
  std::vector<std::string> heard() const {
    std::vector<std::string> lines;
    for (const ChatEntry& entry : session->chat()) lines.push_back(entry.text);
    return lines;
  }
  const wire::Ping* lastPing() const {
    for (auto message = log.sent.rbegin(); message != log.sent.rend(); ++message) {
      if (message->has_ping()) return &message->ping();
    }
    return nullptr;
  }

  wire::ServerMessage welcome = welcomeMessage();
};

TEST_F(ClientReturn, HelloOfANewProcessIsMarkedFresh) {
  restart(ResumeState{});
  const auto& hello = log.sent[log.sent.size() - 2].has_hello() ? log.sent[log.sent.size() - 2] : log.sent[1];
  EXPECT_TRUE(hello.hello().new_process());
  EXPECT_EQ(hello.hello().resume_token(), "0123456789abcdef");
  EXPECT_EQ(heard(), std::vector<std::string>{"Session resumed."});
}

TEST_F(ClientReturn, DisconnectedClientStopsSchedulingAcknowledgements) {
  restart(ResumeState{});
  receive(emptySnapshot(1, 0));
  session->closed(CloseReason::kPeer);
  ASSERT_EQ(session->state(), ClientSession::State::kPlaying) << "it waits for another stream";
  ASSERT_TRUE(session->nextWake());
  session->update(now + UpdateTiming::kAckDelay);
  EXPECT_EQ(session->nextWake(), std::nullopt);
}

TEST_F(ClientReturn, NumbersContinueFromTheWelcome) {
  for (const std::uint32_t at : {70'000u, 0x80000005u, 0xFFFF0000u}) {
    restart(ResumeState{at, 2, at + 9});
    ASSERT_EQ(session->state(), ClientSession::State::kPlaying);
    receive(emptySnapshot(at + 1, 2));
    EXPECT_TRUE(session->hasPicture(now));
    EXPECT_EQ(session->replica().newest().number, at + 1);
    EXPECT_EQ(session->counters().resets, 0u) << "it is the first world that this process sees";
    acknowledge();
    EXPECT_EQ(lastUpdate().acks.newest, at + 1);
    EXPECT_EQ(lastUpdate().acks.mask, 0u) << "what came to another process did not come to this one";
    ASSERT_TRUE(session->sendKey(df::Keyboard::SPACE, df::KEY_PRESSED, now));
    const auto update = readUpdate(last().update(), {at + 1, 5, at + 9});
    ASSERT_TRUE(update && update->inputs.size() == 1);
    EXPECT_EQ(update->inputs[0].id, at + 10);
  }
}

TEST_F(ClientReturn, AWelcomeWithoutContinuationIsRejected) {
  restart(std::nullopt);
  EXPECT_EQ(session->state(), ClientSession::State::kEnded);
}

TEST_F(ClientReturn, VoidTokenJoinsAsANewPlayer) {
  beginFresh();
  join();
  EXPECT_EQ(session->state(), ClientSession::State::kPlaying);
  EXPECT_TRUE(heard().empty());
}

TEST_F(ClientReturn, ReliableFramesAreDeduplicatedAndAcknowledged) {
  join();
  receive(line("one", 1));
  receive(line("two", 2));
  receive(line("two", 2));
  receive(line("one", 1));
  receive(line("unnumbered", 0));
  EXPECT_EQ(heard(), (std::vector<std::string>{"one", "two", "unnumbered"}));
  EXPECT_EQ(session->counters().repeated_frames, 2u);
  EXPECT_EQ(session->receivedFrames(), 2u);
  now += 1s;
  session->update(now);
  ASSERT_NE(lastPing(), nullptr);
  EXPECT_EQ(lastPing()->last_frame(), 2u);
}

TEST_F(ClientReturn, LargeAmountsAreAcknowledgedImmediately) {
  join();
  const std::size_t before = log.sent.size();
  std::uint32_t number = 0;
  for (std::size_t bytes = 0; bytes < ReliableInbox::kAckThreshold;) {
    EXPECT_EQ(log.sent.size(), before);
    const wire::ServerMessage message = line(std::string(200, 'x'), ++number);
    bytes += message.ByteSizeLong();
    receive(message);
  }
  ASSERT_EQ(log.sent.size(), before + 1);
  EXPECT_EQ(lastPing()->last_frame(), session->receivedFrames());
}

TEST_F(ClientReturn, UnacknowledgedChatIsResentOnTheNextStream) {
  joinResumable();
  session->sendChat("one");
  EXPECT_EQ(last().number(), 1u);
  session->sendChat("two");
  wire::ServerMessage pong;
  pong.mutable_pong()->set_last_frame(1);
  receive(pong);
  session->closed(CloseReason::kError);
  ASSERT_TRUE(session->isDetached());
  session->sendChat("three");

  MessageLine<wire::ClientMessage> next;
  welcome.mutable_welcome()->set_last_frame(1);
  resumeOn(next);
  std::vector<std::string> said;
  for (const wire::ClientMessage& message : next.sent) {
    if (message.has_chat()) said.push_back(message.chat().text() + " " + std::to_string(message.number()));
  }
  EXPECT_EQ(said, (std::vector<std::string>{"two 2", "three 3"}));
  session.reset();
}

TEST_F(ClientReturn, AfterLongDisconnectTicksContinueFromTheWelcome) {
  joinResumable();
  snapshot(1, 100);
  session->closed(CloseReason::kError);
  MessageLine<wire::ClientMessage> next;
  welcome.mutable_welcome()->set_tick(40'000);  // after a long grace time: 22 minutes at 30 Hz
  resumeOn(next);
  snapshot(2, 40'001);
  EXPECT_EQ(session->replica().newest().tick, 40'001u);
  EXPECT_EQ(session->clock().newestTick(), 40'001u);
  session.reset();
}

TEST_F(ClientReturn, ChatBeyondTheLimitIsDropped) {
  joinResumable();
  session->closed(CloseReason::kError);
  for (int i = 0; i < 1000; ++i) session->sendChat(std::string(200, 'x'));
  EXPECT_GT(session->counters().chat_dropped, 600u);
  EXPECT_LT(session->counters().chat_dropped, 750u);
  EXPECT_EQ(session->state(), ClientSession::State::kPlaying);
}

}  // namespace
}  // namespace naiad::test

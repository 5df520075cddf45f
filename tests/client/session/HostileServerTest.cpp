// Messages with which a server might harm a client, and their effects.
#include <random>
#include <string>

#include "ClientSessionFixture.h"
#include "shared/net/base/Limits.h"
#include "shared/replica/Limits.h"
#include "shared/values/Canvas.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;
using State = ClientSession::State;

class HostileServerTest : public test::ClientSessionFixture {};

TEST_F(HostileServerTest, ChatIsTruncatedSanitizedAndLimited) {
  join();
  wire::ServerMessage players;
  auto* entry = players.mutable_players()->add_players();
  entry->set_player(9);
  entry->set_name("Bob");
  entry->set_color(df::GREEN);
  receive(players);
  for (int i = 0; i < 600; ++i) {
    wire::ServerMessage message;
    message.mutable_chat()->set_player(9);
    message.mutable_chat()->set_text("\033]0;owned\007" + std::string(500, 'x'));
    receive(message);
  }
  EXPECT_EQ(session->chat().size(), ReliableInbox::kMaxChat);
  EXPECT_EQ(session->chat().back().name, "Bob");
  EXPECT_EQ(session->chat().back().color, df::GREEN);
  EXPECT_EQ(session->chat().back().text.size(), kMaxChatLength);
  EXPECT_EQ(session->chat().back().text.substr(0, 10), "?]0;owned?");
  EXPECT_EQ(session->counters().chat_lines, 600u);
}

TEST_F(HostileServerTest, SendsOnlyDrawableChat) {
  join();
  const std::size_t before = log.sent.size();
  session->sendChat("   ");
  EXPECT_EQ(log.sent.size(), before);
  session->sendChat("a\033b" + std::string(400, 'c'));
  EXPECT_EQ(last().chat().text().substr(0, 4), "a?bc");
  EXPECT_EQ(last().chat().text().size(), kMaxChatLength);
}

TEST_F(HostileServerTest, EndsOnUnparsableBytes) {
  session->receive("\xff\xff\xff garbage", now);
  expectRejected();
  const std::size_t sent = log.sent.size();
  join();
  EXPECT_EQ(log.sent.size(), sent) << "nothing is heard after the end";
  EXPECT_EQ(session->state(), State::kEnded);
}

TEST_F(HostileServerTest, EndsOnEmptyOrUnexpectedMessages) {
  wire::ServerMessage pong, sounds;
  pong.mutable_pong()->set_token(1);
  sounds.mutable_sounds();
  const struct {
    const char* name;
    bool has_joined;
    wire::ServerMessage message;
  } rows[] = {{"an empty message", false, {}},
              {"a snapshot before the welcome", false, snapshotMessage(1, 1)},
              {"a pong before the welcome", false, pong},
              {"sounds before the welcome", false, sounds},
              {"a second welcome", true, welcomeMessage()},
              {"a snapshot without a number", true, snapshotMessage(0, 100)}};
  for (const auto& row : rows) {
    SCOPED_TRACE(row.name);
    SetUp();
    if (row.has_joined) join();
    receive(row.message);
    expectRejected();
  }
}

TEST_F(HostileServerTest, EndsOnAMalformedSnapshot) {
  join();
  wire::ServerMessage message = snapshotMessage(1, 100);
  message.mutable_snapshot()->append("\xee\xee\xee");
  receive(message);
  expectRejected();
  EXPECT_EQ(session->replica().aliveCount(), 0u) << "no record of a bad snapshot is applied";
}

/// However a message is mutated, the session continues in a valid state or ends with a reason.
TEST_F(HostileServerTest, SurvivesMutatedMessages) {
  std::mt19937 random(11);
  wire::ServerMessage players, chat, sounds, pong, refused, goodbye;
  players.mutable_players()->add_players()->set_player(9);
  players.mutable_players()->mutable_players(0)->set_name("Bob");
  chat.mutable_chat()->set_text("hello");
  sounds.mutable_sounds()->add_sounds()->set_label("fire");
  pong.mutable_pong()->set_token(1);
  refused.mutable_refused()->set_message("no");
  goodbye.mutable_goodbye()->set_message("bye");
  const wire::ServerMessage seeds[] = {
      welcomeMessage(), snapshotMessage(2, 101), players, chat, sounds, pong, refused, goodbye};
  int played_on = 0, rejected = 0, dismissed = 0, changed = 0;
  for (int i = 0; i < 6000; ++i) {
    SetUp();
    log.closed = false;
    join();
    snapshot(1, 100);
    ASSERT_EQ(session->state(), State::kPlaying);
    std::string frame = seeds[random() % std::size(seeds)].SerializeAsString();
    for (unsigned k = 0; k < 1 + random() % 4; ++k)
      frame[random() % frame.size()] = static_cast<char>(random());
    if (random() % 4 == 0) frame.resize(random() % frame.size());
    session->receive(frame, now);
    const SessionCounters& counters = session->counters();
    std::uint64_t heard = 0;
    switch (session->state()) {
      case State::kPlaying:
        ++played_on;
        EXPECT_EQ(counters.bad_messages, 0u);
        EXPECT_FALSE(log.closed);
        EXPECT_TRUE(session->message().empty());
        break;
      case State::kEnded:
        EXPECT_TRUE(log.closed);
        EXPECT_FALSE(session->message().empty());
        EXPECT_LE(df::decodeUtf8(session->message()).size(), kMaxMessageLength);
        ++(counters.bad_messages == 1 ? rejected : dismissed);
        EXPECT_LE(counters.bad_messages, 1u);
        heard = session->revision();
        session->receive(chat.SerializeAsString(), now);
        EXPECT_EQ(session->revision(), heard) << "nothing that comes now";
        break;
      default:
        ADD_FAILURE() << "state " << static_cast<int>(session->state());
    }
    EXPECT_LE(session->replica().aliveCount(), 2u) << "one object, and one that this frame may name";
    EXPECT_GE(session->replica().aliveCount(), session->counters().bad_messages == 1 ? 1u : 0u);
    EXPECT_LE(session->chat().size(), 1u);
    EXPECT_LE(session->players().size(), 1u);
    EXPECT_LE(session->popSounds().size(), 1u);
    EXPECT_EQ(session->welcome().player, 3u);
    EXPECT_EQ(session->welcome().view_width, 80);
    const df::Canvas picture = session->replica().render(session->displayTick(now + 1s));
    EXPECT_LE(picture.width(), kMaxViewWidth);
    EXPECT_LE(picture.height(), kMaxViewHeight);
    for (int y = 0; y < picture.height(); ++y) {
      for (int x = 0; x < picture.width(); ++x) EXPECT_TRUE(df::isDrawable(picture.at(x, y).ch));
    }
    changed += session->chat().empty() && session->players().empty() ? 0 : 1;
    ASSERT_FALSE(HasFailure()) << "frame " << i;
  }
  EXPECT_GT(played_on, 500);
  EXPECT_GT(rejected, 500);
  EXPECT_GT(dismissed, 50);
  EXPECT_GT(changed, 100);
}

}  // namespace
}  // namespace naiad

// The sessions of listeners while others chat at their limit for a minute.
#include <gtest/gtest.h>

#include <deque>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "host/session/Session.h"
#include "shared/net/stream/ReliableFrames.h"
#include "tests/server/host/rooms/Clients.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;
using Time = Session::Clock::time_point;

/// A client on a connection with delay. It acknowledges as real clients do, or never.
struct Listener {
  static constexpr std::size_t kMuch = std::size_t{8} * 1024;

  /// Reads all messages that have arrived and sends what is due.
  void serve(Time now, Time::duration delay, bool acknowledges) {
    for (; read < line.sent.size() && sent_at(read) + delay <= now; ++read) accept(line.sent[read]);
    if (now - last_ping >= 1s || unacknowledged >= kMuch) {
      last_ping = now;
      unacknowledged = 0;
      under_way.emplace_back(now + delay, acknowledges ? heard.newest() : 0);
    }
    for (; !under_way.empty() && under_way.front().first <= now; under_way.pop_front())
      line.ping(under_way.front().second);
  }
  void accept(const wire::ServerMessage& message) {
    if (!message.has_chat() || !heard.accept(message.number())) return;
    unacknowledged += message.ByteSizeLong();
    if (message.chat().player() == 0) {
      left_out += std::stoull(message.chat().text());
    } else {
      ++lines;
    }
  }
  Time sent_at(std::size_t which) {
    while (times.size() < line.sent.size()) times.push_back(clock);
    return times[which];
  }

  test::Client line;
  ReliableFrameReceiver heard;
  std::uint64_t lines = 0;
  std::uint64_t left_out = 0;
  std::size_t read = 0;
  std::size_t unacknowledged = 0;
  Time last_ping{};
  Time clock{};  ///< time of the current tick
  std::vector<Time> times;
  std::deque<std::pair<Time, std::uint32_t>> under_way;
};

class ChatOfOthers : public testing::TestWithParam<int> {
 protected:
  std::unique_ptr<Session> make(test::Client& line, bool returns = false) {
    auto made = std::make_unique<Session>(std::make_unique<test::FakeChannel>(line), counters, now);
    made->start({[this, returns](Session& s, const wire::Hello& hello) {
                   if (returns) return away->resumeOn(s, away->welcomed(), hello.last_frame());
                   wire::Welcome welcome;
                   welcome.set_player(++players);
                   s.welcome(welcome);
                 },
                 [this](Session&, const std::string& text) { say(text); }, [this](Session&) { ++gone; },
                 [this] { return now; }});
    if (!returns) greet(line, 0);
    made->setGrace(60s);
    return made;
  }
  static void greet(const test::Client& line, std::uint32_t received) {
    wire::Hello hello = test::helloOf("Ann");
    hello.set_last_frame(received);
    line.greet(hello);
  }
  /// Sends a chat line to all listeners, as Host::sendChat() does.
  void say(const std::string& text) {
    ++said;
    wire::ServerMessage message;
    message.mutable_chat()->set_player(99);
    message.mutable_chat()->set_text(text);
    for (Session* p_session : {far.get(), away.get(), mute.get()}) p_session->sendReliable(message);
  }
  void tick() {
    for (const test::Client& chatter : lines) {
      for (int i = 0; talking && i < 2; ++i) chatter.say(chat_line);  // more than a player may send
    }
    for (Session* p_session : {far.get(), away.get(), mute.get()}) p_session->checkDeadlines(now);
    for (const auto& chatter : chatters) chatter->checkDeadlines(now);
    for (Listener* p_listener : {&far_end, &away_end, &mute_end, &back_end}) p_listener->clock = now;
    far_end.serve(now, 100ms, true);
    mute_end.serve(now, 0ms, false);
    if (!away->isDetached() && now < start + 55s) away_end.serve(now, 0ms, true);
    if (returned != nullptr) back_end.serve(now, 0ms, true);
    now += 33ms;
  }

  const Time start{1000s};
  Time now = start;
  Counters counters;
  std::uint32_t players = 0;
  int gone = 0;
  std::uint64_t said = 0;
  Listener far_end, away_end, mute_end, back_end;
  std::unique_ptr<Session> far = make(far_end.line), away = make(away_end.line), mute = make(mute_end.line);
  std::unique_ptr<Session> returned;
  std::deque<test::Client> lines;  ///< connections of the chatting players
  std::vector<std::unique_ptr<Session>> chatters;
  std::string chat_line;  ///< said by them
  bool talking = true;
};

TEST_P(ChatOfOthers, EndsNoListenersSession) {
  for (std::size_t i = 0; i < kMaxChatLength; ++i) chat_line += "\u2588";  // three bytes each
  for (int i = 0; i < GetParam(); ++i) chatters.push_back(make(lines.emplace_back()));
  while (now < start + 5s) tick();
  away_end.line.callbacks.on_closed(CloseReason::kError);
  while (now < start + 55s) tick();
  ASSERT_EQ(gone, 0);
  ASSERT_EQ(away->state(), Session::State::kPlaying);
  returned = make(back_end.line, true);
  back_end.heard = away_end.heard;
  greet(back_end.line, away_end.heard.newest());
  while (now < start + 60s) tick();
  talking = false;
  for (int i = 0; i < 200; ++i) tick();

  EXPECT_EQ(gone, 0);
  const auto most = static_cast<std::uint64_t>(GetParam() * (3 + 3 * 60));
  EXPECT_LE(said, most);
  EXPECT_GE(said, most - static_cast<std::uint64_t>(4 * GetParam()));
  EXPECT_EQ(far_end.lines + far_end.left_out, said);
  EXPECT_TRUE(GetParam() > 8 || far_end.left_out == 0) << "a long way alone is no reason";
  EXPECT_EQ(away_end.lines + away_end.left_out + back_end.lines + back_end.left_out, said);
  EXPECT_GT(back_end.lines, 60u) << "the newest";
  EXPECT_EQ(back_end.left_out > 0, said > 110);
}

INSTANTIATE_TEST_SUITE_P(Chatters, ChatOfOthers, testing::Values(1, 8, 63));

}  // namespace
}  // namespace naiad

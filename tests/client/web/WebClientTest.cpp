#include <gtest/gtest.h>

#include "client/web/WebClient.h"
#include "shared/net/base/WebSocketProtocol.h"
#include "tests/client/session/ClientSessionFixture.h"
#include "tests/client/web/FakePage.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;

class WebClientTest : public testing::Test {
 protected:
  explicit WebClientTest(const std::string& token = "") { make(token); }

  void make(const std::string& token, const std::string& room = "", const std::string& name = "Ada") {
    WebClient::Options options;
    options.room = room;
    options.name = name;
    options.token = token;
    options.program = "test 1";
    options.server = "the game";
    options.columns = 82;
    options.rows = 27;
    client = std::make_unique<WebClient>(page, options, now);
  }
  void receive(int stream, const wire::ServerMessage& message) {
    client->streams().received(stream, message.SerializeAsString());
    client->update(now);
  }
  void receive(const wire::ServerMessage& message) { receive(first, message); }
  void open() {
    first = page.newest;
    client->streams().opened(first);
  }
  void welcome(bool resumed = false) {
    wire::ServerMessage message = test::welcomeMessage();
    wire::Welcome& welcome = *message.mutable_welcome();
    welcome.set_view_width(60);
    welcome.set_view_height(20);
    welcome.set_resume_token("\x01\xab");
    welcome.set_resumed(resumed);
    if (resumed) welcome.mutable_resume_state()->set_snapshot(1);
    welcome.set_second_stream(true);
    receive(message);
  }
  /// Sends a world without Objects, which also counts as a picture.
  void snapshot(std::uint32_t number) {
    SnapshotHeader header;
    header.number = number;
    header.tick = number;
    header.complete = true;
    receive(test::bareSnapshot(header));
  }
  void play() {
    open();
    welcome();
    snapshot(1);
    now += 1s;
    client->update(now);
    ASSERT_EQ(client->state(), WebClient::State::kPlaying);
    ASSERT_TRUE(client->compose(now));
  }
  /// Returns the inputs sent over the first stream, each once.
  std::vector<Input> inputs() {
    std::vector<Input> all;
    for (const wire::ClientMessage& message : page.streams[first].sent) {
      if (message.payload_case() != wire::ClientMessage::kUpdate) continue;
      const auto update = readUpdate(message.update(), {1, 1, 0});
      if (!update) continue;
      for (const Input& input : update->inputs) {
        if (all.empty() || input.id > all.back().id) all.push_back(input);
      }
    }
    return all;
  }
  bool shows(const std::string& text) {
    client->compose(now);
    for (int y = 0; y < client->picture().height(); ++y) {
      if (client->picture().rowText(y).find(text) != std::string::npos) return true;
    }
    return false;
  }

  test::FakePage page;
  WebClient::Time now{1s};
  std::unique_ptr<WebClient> client;
  int first = 0;
};

class PlayingWebClientTest : public WebClientTest {
 protected:
  void SetUp() override { play(); }
};

TEST_F(WebClientTest, HelloContainsTheRoomOfTheAddressIfValid) {
  for (const auto& [room, wanted] : {std::pair<std::string, std::string>{"arcade", "arcade"},
                                     {"a b", ""},
                                     {"../x", ""},
                                     {std::string(33, 'a'), ""},
                                     {"", ""}}) {
    client.reset();
    page.streams.clear();
    make("", room);
    open();
    ASSERT_FALSE(page.streams[first].sent.empty());
    EXPECT_EQ(page.streams[first].sent.front().hello().room(), wanted);
  }
}

TEST_F(WebClientTest, JoinsShowsThePictureAndOpensASecondStream) {
  EXPECT_EQ(client->state(), WebClient::State::kJoining);
  play();
  ASSERT_FALSE(page.streams[first].sent.empty());
  const wire::Hello& hello = page.streams[first].sent.front().hello();
  EXPECT_EQ(hello.player_name(), "Ada");
  EXPECT_EQ(hello.columns(), 82u);
  EXPECT_EQ(hello.aeads_size(), 0);
  EXPECT_EQ(client->viewWidth(), 80);
  EXPECT_NE(page.newest, first);
  client->streams().opened(page.newest);
  ASSERT_EQ(page.sent().size(), 1u);
  EXPECT_TRUE(page.sent().front().hello().second_stream());
  EXPECT_EQ(page.sent().front().hello().resume_token(), "\x01\xab");
}

TEST_F(PlayingWebClientTest, KeysAndPointerReachTheServer) {
  client->pressKey("ArrowLeft", "ArrowLeft", KeyEvent::Action::kPress, 0, now);
  client->pressKey("ArrowLeft", "ArrowLeft", KeyEvent::Action::kRelease, 0, now);
  client->moveMouse({10, 5, df::Mouse::LEFT, MouseEvent::Action::kPress}, now);
  const std::vector<Input> sent = inputs();
  ASSERT_EQ(sent.size(), 3u);
  EXPECT_EQ(sent[0].key, df::Keyboard::LEFTARROW);
  EXPECT_EQ(sent[0].action, df::KEY_PRESSED);
  EXPECT_EQ(sent[1].action, df::KEY_RELEASED);
  EXPECT_TRUE(sent[2].is_mouse);
}

TEST_F(PlayingWebClientTest, HeldKeyIsReleasedWhenThePageLosesFocus) {
  client->pressKey("a", "KeyA", KeyEvent::Action::kPress, 0, now);
  for (int i = 0; i < 30; ++i) client->update(now += 33ms);
  EXPECT_EQ(inputs().back().action, df::KEY_DOWN);
  client->releaseKeys(now);
  EXPECT_EQ(inputs().back().action, df::KEY_RELEASED);
  const std::size_t count = inputs().size();
  client->update(now += 200ms);
  EXPECT_EQ(inputs().size(), count);
}

TEST_F(PlayingWebClientTest, ChatTextComesFromThePagesInputField) {
  client->command(U't', now);
  EXPECT_TRUE(client->isChatOpen());
  client->setChatText("Grüße");
  EXPECT_TRUE(shows("say: Grüße"));
  client->pressKey("Enter", "Enter", KeyEvent::Action::kPress, 0, now);
  EXPECT_FALSE(client->isChatOpen());
  EXPECT_EQ(page.streams[first].sent.back().chat().text(), "Grüße");
  client->setChatText("late");
  EXPECT_FALSE(shows("late"));
}

TEST_F(WebClientTest, AnotherNameThanRequestedIsReportedAtOnce) {
  for (const auto& [wanted, sent] : {std::pair<std::string, std::string>{"Ada", "Ada"},
                                     {"李雷", "player"},
                                     {"Ada 李", "Ada"},
                                     {"Maximiliane Mustermann", "Maximiliane Must"},
                                     {"Ада", "Ада"}}) {
    client.reset();
    page.streams.clear();
    make("", "", wanted);
    play();  // the server calls the player Ada
    EXPECT_EQ(page.streams[first].sent.front().hello().player_name(), sent);
    EXPECT_EQ(shows("You play as \"Ada\". Names are unique"), wanted != "Ada") << wanted;
  }
}

TEST_F(PlayingWebClientTest, ChatReportsWhatCannotBeShown) {
  for (const auto& [text, omits] :
       {std::pair<std::string, bool>{"Привет λ", false}, {"hi 李雷", true}, {"hi", false}}) {
    client->command(U't', now);  // opens the line, or only redraws it
    client->setChatText(text);
    EXPECT_EQ(shows("Only Latin, Greek and Cyrillic letters can be shown."), omits) << text;
  }
}

TEST_F(PlayingWebClientTest, HelpDoesNotMentionTerminals) {
  client->command(U'h', now);
  EXPECT_TRUE(shows("this help"));
  EXPECT_FALSE(shows("Ctrl-Z"));
  EXPECT_FALSE(shows("terminal"));
}

TEST_F(PlayingWebClientTest, TheTokenIsKeptUntilThePlayerLeaves) {
  EXPECT_EQ(page.token, "01ab");
  client->command(U'q', now);
  EXPECT_EQ(page.token, "");
  EXPECT_EQ(client->state(), WebClient::State::kLeft);
  EXPECT_EQ(page.streams[first].sent.back().payload_case(), wire::ClientMessage::kLeave);
}

TEST_F(WebClientTest, AReloadedPageAsksForItsSession) {
  make("01ab");
  open();
  const wire::Hello& hello = page.streams[first].sent.front().hello();
  EXPECT_TRUE(hello.new_process());
  EXPECT_EQ(hello.resume_token(), "\x01\xab");
  welcome(true);
  snapshot(2);
  client->update(now += 1s);
  EXPECT_EQ(client->state(), WebClient::State::kPlaying);
  EXPECT_TRUE(shows("Session resumed."));
}

TEST_F(WebClientTest, MalformedTokenStartsNoResume) {
  for (const std::string& kept :
       {std::string("0"), std::string("zz"), std::string(1000, 'a'), std::string("01AB")}) {
    make(kept);
    open();
    EXPECT_FALSE(page.streams[first].sent.front().hello().new_process()) << kept;
  }
}

TEST_F(PlayingWebClientTest, LostStreamIsReopenedToResumeTheSession) {
  client->streams().closed(first, 1006, "");
  client->update(now += 100ms);
  EXPECT_EQ(client->state(), WebClient::State::kPlaying);
  const int second = page.newest;
  EXPECT_NE(second, first);
  client->streams().opened(second);
  ASSERT_FALSE(page.streams[second].sent.empty());
  EXPECT_EQ(page.streams[second].sent.front().hello().resume_token(), "\x01\xab");
  EXPECT_FALSE(page.streams[second].sent.front().hello().new_process());
}

TEST_F(WebClientTest, WrongServerKeyIsFinal) {
  client->streams().closed(page.newest, static_cast<int>(GatewayCloseCode::kWrongKey), "It has another key.");
  EXPECT_EQ(client->state(), WebClient::State::kRefused);
  EXPECT_EQ(client->message(), "It has another key.");
}

TEST_F(PlayingWebClientTest, SoundsGoToThePage) {
  wire::ServerMessage message;
  wire::Sound& sound = *message.mutable_sounds()->add_sounds();
  sound.set_label("fire");
  sound.set_player(7);
  wire::Sound& own = *message.mutable_sounds()->add_sounds();
  own.set_label("boom");
  own.set_player(3);
  receive(message);
  ASSERT_EQ(page.sounds.size(), 2u);
  EXPECT_EQ(page.sounds[0].sound.label, "fire");
  EXPECT_FALSE(page.sounds[0].own);
  EXPECT_TRUE(page.sounds[1].own);
}

}  // namespace
}  // namespace naiad

// Fixture with a player's session and the streams on which its client connects.
#pragma once

#include <gtest/gtest.h>

#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "host/session/Session.h"
#include "naiad.pb.h"
#include "shared/net/base/Limits.h"
#include "tests/support/MessageLine.h"

namespace naiad::test {

using namespace std::chrono_literals;

/// A session that is welcomed on its first stream, and further sessions for the same player.
class SessionReturn : public testing::Test {
 protected:
  using Wire = MessageLine<wire::ServerMessage>;

  SessionReturn() : session(make(first)) {
    session->setGrace(60s);
    greet(first);
  }

  std::unique_ptr<Session> make(Wire& line) {
    auto made = std::make_unique<Session>(std::make_unique<FakeChannel>(line), counters, now);
    made->start({[this](Session& s, const wire::Hello& hello) {
                   if (!hello.resume_token().empty()) return onReturn(s, hello);
                   wire::Welcome welcome;
                   welcome.set_player(7);
                   welcome.set_name("Ann");
                   welcome.set_resume_token("secret");
                   s.welcome(welcome);
                 },
                 [this](Session&, const std::string& text) { chat.push_back(text); },
                 [this](Session&) { ++gone; }, [this] { return now; }});
    return made;
  }
  void onReturn(Session& other, const wire::Hello& hello) {
    wire::Welcome welcome = session->welcomed();
    welcome.set_resumed(true);
    if (hello.second_stream()) {
      session->attachSecondStream(other);
    } else if (hello.new_process()) {
      session->restart(other, welcome, nullptr);
    } else {
      session->resumeOn(other, welcome, hello.last_frame());
    }
  }
  static void say(Wire& line, const wire::ClientMessage& message) {
    line.callbacks.on_frame(message.SerializeAsString());
  }
  static void greet(Wire& line, const std::string& token = "", bool new_process = false,
                    std::uint32_t received = 0, bool second_stream = false) {
    wire::ClientMessage message;
    message.mutable_hello()->set_magic(kHelloMagic);
    message.mutable_hello()->set_second_stream(second_stream);
    message.mutable_hello()->set_resume_token(token);
    message.mutable_hello()->set_new_process(new_process);
    message.mutable_hello()->set_last_frame(received);
    say(line, message);
  }
  static void ping(Wire& line, std::uint32_t received) {
    wire::ClientMessage message;
    message.mutable_ping()->set_token(1);
    message.mutable_ping()->set_last_frame(received);
    say(line, message);
  }
  static void chatLine(Wire& line, const std::string& text, std::uint32_t number) {
    wire::ClientMessage message;
    message.mutable_chat()->set_text(text);
    message.set_number(number);
    say(line, message);
  }
  static void sendUpdate(Wire& line, const ClientUpdate& update) {
    wire::ClientMessage message;
    message.set_update(writeUpdate(update));
    say(line, message);
  }
  static void key(Wire& line, std::uint32_t id, int which, df::EventKeyboardAction action) {
    ClientUpdate update;
    update.inputs = {
        {.id = id, .action = static_cast<std::uint8_t>(action), .key = static_cast<std::uint8_t>(which)}};
    sendUpdate(line, update);
  }
  void sendChat(const std::string& text) {
    wire::ServerMessage message;
    message.mutable_chat()->set_text(text);
    session->sendReliable(message);
  }
  static std::vector<std::string> chatOf(const Wire& line) {
    std::vector<std::string> texts;
    for (const wire::ServerMessage& message : line.sent) {
      if (message.has_chat()) texts.push_back(message.chat().text());
    }
    return texts;
  }
  /// Takes the inputs that are due and returns them as "key action", in order.
  std::vector<std::string> taken() {
    std::vector<std::string> inputs;
    session->drainInputs(1, [&](const Input& input) {
      inputs.push_back(std::to_string(input.key) + (input.action == df::KEY_RELEASED ? " up" : " down"));
    });
    return inputs;
  }
  void breakStream(Wire& line) { line.callbacks.on_closed(CloseReason::kError); }

  Session::Clock::time_point now{1000s};
  Counters counters;
  std::vector<std::string> chat;
  int gone = 0;
  Wire first;
  Wire second;
  std::deque<Wire> lines;  ///< further streams
  std::unique_ptr<Session> session;
};

}  // namespace naiad::test

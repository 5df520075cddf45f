// A ClientSession on a fake channel, with hand-made messages of a server and a clock that stands still.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <memory>

#include "ClientSession.h"
#include "FakeChannel.h"
#include "RecordCodec.h"

namespace naiad::test {

class ClientSessionFixture : public testing::Test {
 protected:
  void SetUp() override {
    SessionOptions options;
    options.name = "Ada";
    options.game = "saucershoot";
    options.program = "test 1";
    options.columns = 100;
    options.rows = 40;
    session = std::make_unique<ClientSession>(std::make_unique<FakeChannel>(log), options, now);
  }

  void receive(const wire::ServerMessage& message) { session->receive(message.SerializeAsString(), now); }

  static wire::ServerMessage welcomeMessage() {
    wire::ServerMessage message;
    wire::Welcome& welcome = *message.mutable_welcome();
    welcome.set_player(3);
    welcome.set_name("Ada");
    welcome.set_game("saucershoot");
    welcome.set_tick_micros(33333);
    welcome.set_view_width(80);
    welcome.set_view_height(24);
    welcome.set_color(df::CYAN);
    welcome.set_server("dfserver 0.1");
    welcome.add_help("Space fires.");
    return message;
  }
  void join() { receive(welcomeMessage()); }

  static wire::ServerMessage snapshotMessage(std::uint32_t number, std::uint32_t tick) {
    RecordWriter records;
    ObjectRecord object;
    object.slot = 5;
    object.generation = 1;
    object.groups = kAllGroups;
    object.state.motion = {tick, {df::fromCells(10), df::fromCells(4)}, {}, {}};
    object.state.look.sequence = {{Glyph{0, 0, U'@', df::RED}}};
    records.write(object);
    wire::ServerMessage message;
    message.mutable_snapshot()->set_number(number);
    message.mutable_snapshot()->set_tick(tick);
    message.mutable_snapshot()->set_records(records.bytes());
    return message;
  }
  void snapshot(std::uint32_t number, std::uint32_t tick) { receive(snapshotMessage(number, tick)); }

  void expectRejected() {
    EXPECT_EQ(session->state(), ClientSession::State::kEnded);
    EXPECT_FALSE(session->sentence().empty());
    EXPECT_EQ(session->counters().bad_messages, 1u);
    EXPECT_TRUE(log->closed);
  }

  const wire::ClientMessage& last() const { return log->sent.back(); }

  std::shared_ptr<FakeChannel::Log> log = std::make_shared<FakeChannel::Log>();
  ClientSession::Time now = ClientSession::Time{} + std::chrono::hours(1);
  std::unique_ptr<ClientSession> session;
};

}  // namespace naiad::test

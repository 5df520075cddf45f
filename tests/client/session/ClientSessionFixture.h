// A ClientSession on a fake channel, with hand-made server messages and a clock that the test advances.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <memory>

#include "client/session/ClientSession.h"
#include "naiad.pb.h"
#include "shared/replica/UpdateCodec.h"
#include "tests/support/MessageLine.h"
#include "tests/support/WriteSnapshot.h"

namespace naiad::test {

inline wire::ServerMessage welcomeMessage() {
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

/// Returns a snapshot without records; with `sets_origin` it sets the first origin slot.
inline wire::ServerMessage bareSnapshot(const SnapshotHeader& header, std::uint32_t slot = 0,
                                        bool sets_origin = false) {
  Records records;
  if (sets_origin) records.origins = {{1, {}}};
  wire::ServerMessage message;
  message.set_snapshot(writeSnapshot(header, records, slot));
  return message;
}

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

  void TearDown() override { EXPECT_EQ(log.sent_late, 0u); }

  void receive(const wire::ServerMessage& message) { session->receive(message.SerializeAsString(), now); }

  static wire::ServerMessage welcomeMessage() { return test::welcomeMessage(); }
  void join() { receive(welcomeMessage()); }

  /// Returns a snapshot with object 5 at (10, 4) and the id of the last applied input, if not 0.
  static wire::ServerMessage snapshotMessage(std::uint32_t number, std::uint32_t tick,
                                             std::uint32_t input = 0) {
    SnapshotHeader header;
    header.number = number;
    header.tick = tick;
    header.has_input = input != 0;
    header.input = input;
    header.input_tick = tick;
    ObjectRecord object{5, 1, kAllGroups, {}};
    object.state.motion = {tick, {df::fromCells(10), df::fromCells(4)}, {}, {}};
    object.state.look.sequence = {{Glyph{0, 0, U'@', df::RED}}};
    Records records;
    records.objects = {object};
    wire::ServerMessage message;
    message.set_snapshot(writeSnapshot(header, records));
    return message;
  }
  void snapshot(std::uint32_t number, std::uint32_t tick) { receive(snapshotMessage(number, tick)); }
  /// Lets time pass until received snapshots are acknowledged.
  void acknowledge() { session->update(now + UpdateTiming::kAckDelay); }

  void expectRejected() {
    EXPECT_EQ(session->state(), ClientSession::State::kEnded);
    EXPECT_FALSE(session->message().empty());
    EXPECT_EQ(session->counters().bad_messages, 1u);
    EXPECT_TRUE(log.closed);
  }

  const wire::ClientMessage& last() const { return log.sent.back(); }
  /// Returns the last message, which must be an update.
  ClientUpdate lastUpdate() const {
    EXPECT_EQ(last().payload_case(), wire::ClientMessage::kUpdate);
    const SnapshotContext& newest = session->replica().newest();
    const auto update = readUpdate(last().update(), {newest.number, newest.tick, newest.input});
    EXPECT_TRUE(update);
    return update.value_or(ClientUpdate{});
  }
  Input lastInput() const {
    const ClientUpdate update = lastUpdate();
    EXPECT_FALSE(update.inputs.empty());
    return update.inputs.empty() ? Input{} : update.inputs.back();
  }

  MessageLine<wire::ClientMessage> log;
  ClientSession::Time now = ClientSession::Time{} + std::chrono::hours(1);
  std::unique_ptr<ClientSession> session;
};

}  // namespace naiad::test

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "DirectSender.h"
#include "host/snapshot/PerClientState.h"
#include "shared/replica/PredictedObject.h"
#include "shared/replica/ViewFollow.h"
#include "tests/support/CellsAt.h"

namespace naiad {
namespace {

using test::cellsAt;
using test::DirectSender;

/// The state of a client whose player looks at an empty world.
class PerClientStateTest : public testing::Test {
 protected:
  PerClientStateTest() {
    m_view.boundary = {cellsAt(0, 0), cellsAt(80, 24)};
    player.id = 1;
    m_view.players.push_back(player);
  }
  /// Runs a tick. Returns the records of the next snapshot, as far as they fit into `limit`.
  Records tick(std::size_t limit = kMaxDatagramSnapshot, bool repeats = false) {
    ++m_view.tick;
    m_publisher.update(m_view);
    state.applyTick(m_publisher, player);
    state.queueRepeats();
    state.queueCorrections(m_publisher, m_known);
    SnapshotHeader header{++number, m_view.tick, 0, true, false, 0, 0};
    state.writeInput(header);
    SnapshotWriter writer;
    writer.beginSnapshot(header, 0, {});
    sent_any = state.write(writer, number, limit, repeats);
    Snapshot snapshot;
    EXPECT_EQ(Replica().read(writer.finish(), snapshot), ReadResult::kOk);
    has_input = snapshot.header.has_input;
    return snapshot.records;
  }
  void say(const std::string& text) { player.texts = {{0, 1, 1, df::WHITE, text}}; }

  PerClientState state;
  df::PlayerFacts player;
  std::uint32_t number = 0;  ///< number of the newest snapshot
  bool sent_any = false;
  bool has_input = false;

 private:
  df::WorldView m_view;
  Publisher m_publisher;
  KnownObjects m_known;
};

TEST_F(PerClientStateTest, WorldViewAndOriginComeFirstAndOnce) {
  Records records = tick();
  EXPECT_TRUE(sent_any);
  EXPECT_EQ(records.worlds.size(), 1u);
  EXPECT_EQ(records.views.size(), 1u);
  EXPECT_EQ(records.origins.size(), 1u);
  EXPECT_TRUE(records.texts.empty());
  EXPECT_FALSE(state.hasPending());
  records = tick();
  EXPECT_FALSE(sent_any);
  EXPECT_TRUE(records.worlds.empty());
}

TEST_F(PerClientStateTest, OnlyTheNewestSendingIsRequeuedWhenLost) {
  tick();
  say("old");
  tick();
  say("new");
  tick();
  EXPECT_FALSE(state.requeueLost(2)) << "the next one replaced it";
  EXPECT_FALSE(state.hasPending());
  EXPECT_TRUE(state.requeueLost(3));
  EXPECT_EQ(tick().texts.at(0).text, "new");
}

TEST_F(PerClientStateTest, APartThatDoesNotFitWaits) {
  const Records records = tick(60);
  EXPECT_FALSE(sent_any);
  EXPECT_TRUE(records.worlds.empty());
  EXPECT_TRUE(state.hasPending());
  EXPECT_EQ(tick().worlds.size(), 1u);
}

TEST_F(PerClientStateTest, ARepeatedPartIsSentOnceMore) {
  tick();
  say("quick");
  EXPECT_EQ(tick(kMaxDatagramSnapshot, true).texts.size(), 1u);
  EXPECT_EQ(tick(kMaxDatagramSnapshot, true).texts.size(), 1u);
  EXPECT_EQ(tick(kMaxDatagramSnapshot, true).texts.size(), 0u);
}

TEST_F(PerClientStateTest, WhatHasArrivedIsNotRepeated) {
  tick();
  say("quick");
  tick(kMaxDatagramSnapshot, true);
  state.confirmArrival(number, false);
  EXPECT_TRUE(tick(kMaxDatagramSnapshot, true).texts.empty());
}

TEST_F(PerClientStateTest, EverySnapshotNamesTheInputUntilOneHasArrived) {
  tick();
  EXPECT_FALSE(has_input);
  state.setNewestInput(7, 2);
  for (int i = 0; i < 3; ++i) {
    tick();
    EXPECT_TRUE(has_input);
  }
  state.confirmArrival(1, false);
  state.confirmArrival(number, true);
  tick();
  EXPECT_TRUE(has_input) << "neither an older one nor a probe named it";
  state.confirmArrival(number, false);
  tick();
  EXPECT_FALSE(has_input);
}

/// A player whose view (80 by 24, in a wide world) follows the only object.
class FollowingTest : public testing::Test {
 protected:
  FollowingTest() {
    direct.view().boundary = {cellsAt(0, 0), cellsAt(400, 24)};
    direct.player.followed = {0, 1};
    direct.player.view_corner = cellsAt(60, 0);
    m_facts.key = {0, 1};
    m_facts.order = 1;
    m_facts.position = cellsAt(100, 5);
    direct.view().changed.push_back(m_facts);
  }

  /// Runs a tick that places the object at `x`, moving with `velocity`.
  void tick(double x, double velocity, bool acknowledges = true) {
    m_facts.position = cellsAt(x, 5);
    m_facts.velocity = cellsAt(velocity, 0);
    direct.view().changed.push_back(m_facts);
    const ViewFrame frame{direct.player.view_corner, cellsAt(80, 24), direct.view().boundary};
    direct.player.view_corner = followView(frame, m_facts.position);
    direct.tick();
    if (acknowledges) direct.acknowledge(direct.sender.newestNumber());
  }
  void becomeAnother() {
    direct.view().vanished.push_back(m_facts.key);
    direct.player.followed = m_facts.key = {0, ++m_facts.key.generation};
    ++m_facts.order;
  }
  void expectSameView() {
    EXPECT_EQ(direct.reader().viewCorner(direct.publisher.tick()).x, df::cellOf(direct.player.view_corner.x))
        << "tick " << direct.publisher.tick();
  }

  DirectSender direct{0};

 private:
  df::ObjectFacts m_facts;
};

TEST_F(FollowingTest, ViewFollowsNewObjectBeforeOldDeathIsConfirmed) {
  tick(100, 0);
  becomeAnother();
  for (int i = 0; i < 20; ++i) {  // the death is not acknowledged
    tick(100 + 3 * i, 3, false);
    EXPECT_EQ(direct.reader().aliveCount(), 1u);
    expectSameView();
  }
  tick(160, 3);
  tick(163, 3);
  EXPECT_EQ(direct.reader().aliveCount(), 1u);
  expectSameView();
}

/// A player who steers the only object by declared controls, and the client's replica.
class SteeringTest : public testing::Test {
 protected:
  SteeringTest() {
    m_table.rows.resize(1);
    m_table.rows[0].effect = df::ControlEffect::kDrive;
    m_table.rows[0].value = cellsAt(1, 0);
    m_facts.key = {0, 1};
    m_facts.order = 1;
    m_facts.position = cellsAt(10, 5);
    steering().p_table = std::make_shared<df::ControlTable>(m_table);
    steering().object = {0, 1};
    steering().state.steering = true;
  }

  df::SteeringFacts& steering() { return direct.player.steering; }
  const df::ControlTable& table() const { return m_table; }
  /// Runs a tick that moves the object by `velocity`. Returns whether the control state was sent.
  bool tick(df::FixedVector velocity, bool arrives = true) {
    m_facts.position = m_facts.position + velocity;
    m_facts.velocity = velocity;
    direct.view().changed.push_back(m_facts);
    steering().position = m_facts.position;
    steering().velocity = velocity;
    steering().state.x.target_velocity = velocity.x;
    bool sent = false;
    for (const SnapshotSender::Packet& packet : direct.tick()) {
      sent = sent || !direct.decoded(packet).controls.empty();
      if (arrives) reader.read(packet.bytes);
    }
    direct.sender.acknowledge(reader.acks);
    return sent;
  }
  void expectKnown() {
    const std::uint32_t now = direct.publisher.tick();
    const ControlRecord known = deadReckon(replica.control(), replica.controlTable(), now);
    EXPECT_EQ(known.position, steering().position);
    EXPECT_EQ(known.velocity, steering().velocity);
    EXPECT_EQ(known.state, steering().state);
    const Replica::ReplicaObject* entry = replica.find(known.slot);
    ASSERT_NE(entry, nullptr);
    EXPECT_EQ(entry->generation, known.generation);
    EXPECT_EQ(entry->state.order, 1u);
  }

  DirectSender direct{0};
  test::SnapshotReader reader;
  const Replica& replica = reader.replica;

 private:
  df::ControlTable m_table;
  df::ObjectFacts m_facts;
};

TEST_F(SteeringTest, ControlStateIsSentOnlyWhenUnpredictable) {
  EXPECT_TRUE(tick({}));
  EXPECT_EQ(replica.controlTable(), table());
  EXPECT_EQ(replica.controlNumber(), 1u);
  expectKnown();
  for (int i = 0; i < 40; ++i) EXPECT_FALSE(tick({})) << "at rest, tick " << i;
  EXPECT_TRUE(tick(cellsAt(1, 0)));
  for (int i = 0; i < 30; ++i) {
    EXPECT_FALSE(tick(cellsAt(1, 0))) << "straight on, tick " << i;
    expectKnown();
  }
  EXPECT_TRUE(tick(cellsAt(1, 0))) << "the longest coasting";
  EXPECT_EQ(replica.controlTableNumber(), 1u) << "the table came once";
}

TEST_F(SteeringTest, AnInputThatChangedNothingIsConfirmedToo) {
  tick({});
  direct.sender.setNewestInput(7, direct.publisher.tick() + 1);
  EXPECT_TRUE(tick({}));
  EXPECT_EQ(replica.control().newest_input, 7u);
  EXPECT_FALSE(tick({}));
}

TEST_F(SteeringTest, LostControlsAreSentAgain) {
  tick({}, false);
  for (int i = 0; i < 5; ++i) tick({}, false);
  bool sent = false;
  for (int i = 0; i < 40; ++i) sent = tick(cellsAt(i % 7 == 0 ? 1 : 0, 0)) || sent;
  EXPECT_TRUE(sent);
  EXPECT_EQ(replica.controlTable(), table());
  expectKnown();
}

TEST_F(SteeringTest, EndOfControlsIsSentAsAnEmptyTable) {
  tick({});
  steering() = {};
  tick({});
  EXPECT_TRUE(replica.controlTable().rows.empty());
  EXPECT_EQ(replica.controlTableNumber(), 2u);
}

TEST_F(SteeringTest, ControlRecordOfAMoveFitsIn8Bytes) {
  tick({});
  for (int i = 0; i < 10; ++i) tick({});
  direct.sender.setNewestInput(7, direct.publisher.tick() + 1);
  const std::uint32_t before = replica.controlNumber();
  BitWriter bits;
  ASSERT_TRUE(tick(cellsAt(1, 0)));
  ASSERT_GT(replica.controlNumber(), before);
  Origin origin;
  origin.x_bits = 7;
  origin.y_bits = 5;
  writeControlRecord(bits, replica.control(), origin);
  EXPECT_LE(bits.byteCount(), 8u);
}

WorldRecord worldOf(std::int32_t width, std::int32_t height) {
  return {.boundary = {}, .view_width = width, .view_height = height};
}

TEST(OriginChoice, AWindowServesAViewThatMovesALittle) {
  OriginChoice choice;
  const WorldRecord world = worldOf(80, 24);
  EXPECT_EQ(choice.slot(), 0u);
  const std::uint32_t slot = choice.updateWindow({100, 50}, world, 1);
  ASSERT_NE(slot, 0u);
  EXPECT_LE(choice.at(slot).corner.x, 96);
  EXPECT_GE(choice.at(slot).corner.x + (1 << choice.at(slot).x_bits), 184);
  for (int d = -4; d <= 4; ++d) EXPECT_EQ(choice.updateWindow({100 + d, 50 + d}, world, 1), 0u) << d;
}

TEST(OriginChoice, SnapshotsNameAWindowOnceItIsConfirmed) {
  OriginChoice choice;
  const WorldRecord world = worldOf(80, 24);
  const std::uint32_t first = choice.updateWindow({0, 0}, world, 1);
  EXPECT_EQ(choice.slot(), 0u);
  choice.confirmArrival(first);
  EXPECT_EQ(choice.slot(), first);
  const std::uint32_t second = choice.updateWindow({500, 0}, world, 1);
  EXPECT_NE(second, 0u);
  EXPECT_NE(second, first) << "snapshots on their way name that one";
  EXPECT_EQ(choice.slot(), first);
  choice.confirmArrival(first);
  EXPECT_EQ(choice.slot(), first) << "a late acknowledgement of the old one";
  choice.confirmArrival(second);
  EXPECT_EQ(choice.slot(), second);
}

TEST(OriginChoice, AnUnconfirmedWindowIsSetAgain) {
  OriginChoice choice;
  const WorldRecord world = worldOf(80, 24);
  const std::uint32_t slot = choice.updateWindow({0, 0}, world, 1);
  EXPECT_EQ(choice.updateWindow({500, 0}, world, 1), slot);
  EXPECT_LE(choice.at(slot).corner.x, 500);
}

TEST(OriginChoice, DistantOrderOrLargerViewNeedsANewWindow) {
  OriginChoice choice;
  EXPECT_NE(choice.updateWindow({0, 0}, worldOf(80, 24), 1), 0u);
  EXPECT_EQ(choice.updateWindow({0, 0}, worldOf(80, 24), 10'000), 0u);
  EXPECT_NE(choice.updateWindow({0, 0}, worldOf(80, 24), 20'000), 0u);
  EXPECT_NE(choice.updateWindow({0, 0}, worldOf(160, 24), 20'000), 0u);
}

}  // namespace
}  // namespace naiad

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

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
class Alone {
 public:
  Alone() {
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

TEST(PerClientState, WorldViewAndOriginComeFirstAndOnce) {
  Alone scene;
  Records records = scene.tick();
  EXPECT_TRUE(scene.sent_any);
  EXPECT_EQ(records.worlds.size(), 1u);
  EXPECT_EQ(records.views.size(), 1u);
  EXPECT_EQ(records.origins.size(), 1u);
  EXPECT_TRUE(records.texts.empty());
  EXPECT_FALSE(scene.state.hasPending());
  records = scene.tick();
  EXPECT_FALSE(scene.sent_any);
  EXPECT_TRUE(records.worlds.empty());
}

TEST(PerClientState, OnlyTheNewestSendingIsRequeuedWhenLost) {
  Alone scene;
  scene.tick();
  scene.say("old");
  scene.tick();
  scene.say("new");
  scene.tick();
  EXPECT_FALSE(scene.state.requeueLost(2)) << "the next one replaced it";
  EXPECT_FALSE(scene.state.hasPending());
  EXPECT_TRUE(scene.state.requeueLost(3));
  EXPECT_EQ(scene.tick().texts.at(0).text, "new");
}

TEST(PerClientState, APartThatDoesNotFitWaits) {
  Alone scene;
  const Records records = scene.tick(60);
  EXPECT_FALSE(scene.sent_any);
  EXPECT_TRUE(records.worlds.empty());
  EXPECT_TRUE(scene.state.hasPending());
  EXPECT_EQ(scene.tick().worlds.size(), 1u);
}

TEST(PerClientState, ARepeatedPartIsSentOnceMore) {
  Alone scene;
  scene.tick();
  scene.say("quick");
  EXPECT_EQ(scene.tick(kMaxDatagramSnapshot, true).texts.size(), 1u);
  EXPECT_EQ(scene.tick(kMaxDatagramSnapshot, true).texts.size(), 1u);
  EXPECT_EQ(scene.tick(kMaxDatagramSnapshot, true).texts.size(), 0u);
}

TEST(PerClientState, WhatHasArrivedIsNotRepeated) {
  Alone scene;
  scene.tick();
  scene.say("quick");
  scene.tick(kMaxDatagramSnapshot, true);
  scene.state.confirmArrival(scene.number, false);
  EXPECT_TRUE(scene.tick(kMaxDatagramSnapshot, true).texts.empty());
}

TEST(PerClientState, EverySnapshotNamesTheInputUntilOneHasArrived) {
  Alone scene;
  scene.tick();
  EXPECT_FALSE(scene.has_input);
  scene.state.setNewestInput(7, 2);
  for (int i = 0; i < 3; ++i) {
    scene.tick();
    EXPECT_TRUE(scene.has_input);
  }
  scene.state.confirmArrival(1, false);
  scene.state.confirmArrival(scene.number, true);
  scene.tick();
  EXPECT_TRUE(scene.has_input) << "neither an older one nor a probe named it";
  scene.state.confirmArrival(scene.number, false);
  scene.tick();
  EXPECT_FALSE(scene.has_input);
}

/// A player whose view (80 by 24, in a wide world) follows the only object.
class Following {
 public:
  Following() {
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

TEST(PerClientState, ViewFollowsNewObjectBeforeOldDeathIsConfirmed) {
  Following scene;
  scene.tick(100, 0);
  scene.becomeAnother();
  for (int i = 0; i < 20; ++i) {  // the death is not acknowledged
    scene.tick(100 + 3 * i, 3, false);
    EXPECT_EQ(scene.direct.reader().aliveCount(), 1u);
    scene.expectSameView();
  }
  scene.tick(160, 3);
  scene.tick(163, 3);
  EXPECT_EQ(scene.direct.reader().aliveCount(), 1u);
  scene.expectSameView();
}

/// A player who steers the only object by declared controls, and the client's replica.
class Steering {
 public:
  Steering() {
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

TEST(PerClientState, ControlStateIsSentOnlyWhenUnpredictable) {
  Steering scene;
  EXPECT_TRUE(scene.tick({}));
  EXPECT_EQ(scene.replica.controlTable(), scene.table());
  EXPECT_EQ(scene.replica.controlNumber(), 1u);
  scene.expectKnown();
  for (int i = 0; i < 40; ++i) EXPECT_FALSE(scene.tick({})) << "at rest, tick " << i;
  EXPECT_TRUE(scene.tick(cellsAt(1, 0)));
  for (int i = 0; i < 30; ++i) {
    EXPECT_FALSE(scene.tick(cellsAt(1, 0))) << "straight on, tick " << i;
    scene.expectKnown();
  }
  EXPECT_TRUE(scene.tick(cellsAt(1, 0))) << "the longest coasting";
  EXPECT_EQ(scene.replica.controlTableNumber(), 1u) << "the table came once";
}

TEST(PerClientState, AnInputThatChangedNothingIsConfirmedToo) {
  Steering scene;
  scene.tick({});
  scene.direct.sender.setNewestInput(7, scene.direct.publisher.tick() + 1);
  EXPECT_TRUE(scene.tick({}));
  EXPECT_EQ(scene.replica.control().newest_input, 7u);
  EXPECT_FALSE(scene.tick({}));
}

TEST(PerClientState, LostControlsAreSentAgain) {
  Steering scene;
  scene.tick({}, false);
  for (int i = 0; i < 5; ++i) scene.tick({}, false);
  bool sent = false;
  for (int i = 0; i < 40; ++i) sent = scene.tick(cellsAt(i % 7 == 0 ? 1 : 0, 0)) || sent;
  EXPECT_TRUE(sent);
  EXPECT_EQ(scene.replica.controlTable(), scene.table());
  scene.expectKnown();
}

TEST(PerClientState, EndOfControlsIsSentAsAnEmptyTable) {
  Steering scene;
  scene.tick({});
  scene.steering() = {};
  scene.tick({});
  EXPECT_TRUE(scene.replica.controlTable().rows.empty());
  EXPECT_EQ(scene.replica.controlTableNumber(), 2u);
}

TEST(PerClientState, ControlRecordOfAMoveFitsIn8Bytes) {
  Steering scene;
  scene.tick({});
  for (int i = 0; i < 10; ++i) scene.tick({});
  scene.direct.sender.setNewestInput(7, scene.direct.publisher.tick() + 1);
  const std::uint32_t before = scene.replica.controlNumber();
  BitWriter bits;
  ASSERT_TRUE(scene.tick(cellsAt(1, 0)));
  ASSERT_GT(scene.replica.controlNumber(), before);
  Origin origin;
  origin.x_bits = 7;
  origin.y_bits = 5;
  writeControlRecord(bits, scene.replica.control(), origin);
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

#include <gtest/gtest.h>

#include <vector>

#include "DirectSender.h"
#include "SimulatedWorld.h"
#include "host/snapshot/LookCapture.h"
#include "shared/replica/Limits.h"
#include "shared/replica/LookCodec.h"

namespace naiad {
namespace {

using test::cellsAt;
/// A hand-made WorldView of one player, who sees cells (0, 0) to (79, 23).
class PublisherTest : public testing::Test {
 protected:
  PublisherTest() {
    view.boundary = {cellsAt(0, 0), cellsAt(80, 24)};
    view.players.push_back({});
    view.players[0].id = 1;
  }

  df::ObjectFacts& changed(std::uint32_t slot, df::FixedVector position, df::FixedVector velocity = {}) {
    df::ObjectFacts facts;
    facts.key = {slot, 1};
    facts.order = slot;
    facts.position = position;
    facts.velocity = velocity;
    return view.changed.emplace_back(facts);
  }
  void drew(df::ObjectKey key, const std::vector<df::DrawCommand>& commands) {
    view.drawn.push_back(
        {key, static_cast<std::uint32_t>(view.commands.size()), static_cast<std::uint32_t>(commands.size())});
    view.commands.insert(view.commands.end(), commands.begin(), commands.end());
  }
  void drew(std::uint32_t slot, df::FixedVector position, char32_t ch = U'@') {
    drew({slot, 1}, {{position, ch, df::CYAN}});
  }
  /// Reports the object at `position`, where it also draws a character.
  void drawn(std::uint32_t slot, df::FixedVector position, df::FixedVector velocity = {}) {
    changed(slot, position, velocity);
    drew(slot, position);
  }
  /// Lets the object declare its look and draw the frame that is due in the next tick.
  void showed(std::uint32_t slot, df::FixedVector position, const Look& look) {
    std::vector<df::DrawCommand> commands;
    for (const Glyph& glyph : *look.select(view.tick + 1)) {
      const df::FixedVector offset{df::Fixed{glyph.dx} * (df::kFixedOne / 256),
                                   df::Fixed{glyph.dy} * (df::kFixedOne / 256)};
      commands.push_back({position + offset, glyph.ch, glyph.color});
    }
    declares(look);
    drew({slot, 1}, commands);
  }
  void declares(const Look& look) {
    view.looks.push_back({static_cast<std::uint32_t>(view.drawn.size()), std::make_shared<const Look>(look)});
  }
  /// Publishes the tick, returns its changes, and begins the next.
  std::vector<Publisher::Change> publish() {
    ++view.tick;
    publisher.update(view);
    view.changed.clear();
    view.vanished.clear();
    view.drawn.clear();
    view.commands.clear();
    view.looks.clear();
    return publisher.changes();
  }

  Publisher publisher;
  df::WorldView view;
};

std::uint8_t groupsOf(const std::vector<Publisher::Change>& changes, std::uint32_t slot) {
  for (const Publisher::Change& change : changes) {
    if (change.slot == slot) return change.groups;
  }
  return 0xFF;
}

TEST_F(PublisherTest, FlightIsPublishedOnce) {
  for (const df::FixedVector acceleration : {cellsAt(0, 0), cellsAt(0.01, 0.003)}) {
    publisher = Publisher();
    df::FixedVector position = cellsAt(5, 5);
    df::FixedVector velocity = cellsAt(0.3, 0.1);
    for (int i = 0; i < 60; ++i) {
      changed(0, position, velocity).acceleration = acceleration;
      drew(0, position);
      const auto changes = publish();
      ASSERT_EQ(changes.size(), i == 0 ? 1u : 0u) << "tick " << i;
      if (i == 0) {
        EXPECT_EQ(groupsOf(changes, 0), kAllGroups);
      }
      position = position + velocity;
      velocity = velocity + acceleration;
    }
    EXPECT_EQ(publisher.correctionCount(), 0u);
  }
}

TEST_F(PublisherTest, ViewObjectStandsStillWhileViewsMove) {
  for (int i = 0; i < 50; ++i) {
    const df::FixedVector corner = cellsAt(100 + 0.3 * i, 7.5);  // corner of the world's own view
    view.corner = corner;
    view.players[0].view_corner = cellsAt(-3.0 * i, 900);  // a player's view far from it
    changed(1, cellsAt(40, 1)).on_view = true;
    drew(1, corner + cellsAt(38, 1), U'H');
    view.drawn.back().on_view = true;
    EXPECT_EQ(publish().size(), i == 0 ? 1u : 0u) << "tick " << i;
  }
  const Publisher::Model& model = *publisher.find(1);
  EXPECT_TRUE(model.state.body.on_view);
  EXPECT_EQ(model.state.body.solidness, df::SPECTRAL) << "no object meets it";
  ASSERT_EQ(model.state.look.sequence.glyphCount(), 1u);
  const CellPosition cell =
      glyphCell(positionAt(model.state.motion, publisher.tick()), model.state.look.sequence[0][0]);
  EXPECT_EQ(cell, (CellPosition{38, 1}));
  EXPECT_GT(model.reach, Publisher::Model::kWide) << "so it is sent to every client";
}

TEST_F(PublisherTest, InvalidBackgroundColourBecomesBlack) {
  const auto published = [&](df::Color background) {
    view.background = background;
    publish();
    return publisher.world().background;
  };
  EXPECT_EQ(published(df::BLUE), df::BLUE);
  EXPECT_EQ(published(df::CUSTOM), df::BLACK);
  EXPECT_EQ(published(df::UNDEFINED_COLOR), df::BLACK);
}

TEST_F(PublisherTest, TurnIsCorrectedExactlyWhenItsCellIsWrong) {
  df::FixedVector position = cellsAt(10, 10);
  df::FixedVector velocity = cellsAt(0.125, 0);
  Motion modelled{1, position, velocity, {}};
  int corrections = 0;
  for (int i = 0; i < 200; ++i) {
    if (i == 20) velocity = cellsAt(0.0625, 0.0625);  // a turn that becomes visible only after some ticks
    if (i == 90) velocity = cellsAt(-0.125, 0);
    drawn(0, position, velocity);
    const auto changes = publish();
    const std::uint32_t tick = publisher.tick();
    const df::FixedVector expected = positionAt(modelled, tick);
    const bool wrong =
        df::cellOf(expected.x) != df::cellOf(position.x) || df::cellOf(expected.y) != df::cellOf(position.y);
    if (i == 0) modelled = publisher.find(0)->state.motion;
    if (i > 0) {
      ASSERT_EQ(changes.size(), wrong ? 1u : 0u) << "tick " << i;
    }
    if (wrong) {
      EXPECT_EQ(changes[0].groups, kMotion);
      modelled = publisher.find(0)->state.motion;
      ++corrections;
    }
    const df::FixedVector published = positionAt(publisher.find(0)->state.motion, tick);
    ASSERT_EQ(df::cellOf(published.x), df::cellOf(position.x));
    ASSERT_EQ(df::cellOf(published.y), df::cellOf(position.y));
    position = position + velocity;
  }
  EXPECT_EQ(publisher.correctionCount(), static_cast<std::uint64_t>(corrections));
  EXPECT_GE(corrections, 2);
  EXPECT_LE(corrections, 4);
}

TEST_F(PublisherTest, TurnOfAnUndrawnObjectIsCorrectedToo) {
  changed(0, cellsAt(10, 10), cellsAt(1, 0));
  drew({0, 1}, {});
  publish();
  changed(0, cellsAt(11, 10), cellsAt(0, 1));
  drew({0, 1}, {});
  EXPECT_TRUE(publish().empty());
  changed(0, cellsAt(11, 11), cellsAt(0, 1));
  drew({0, 1}, {});
  EXPECT_EQ(groupsOf(publish(), 0), kMotion);
}

TEST_F(PublisherTest, BlockedOrUnreportedObjectIsPublishedAsStandingStill) {
  for (const bool is_reported : {true, false}) {
    publisher = Publisher();
    drawn(0, cellsAt(10, 10), cellsAt(1, 0));
    publish();
    if (is_reported) changed(0, cellsAt(10, 10));  // blocked: zero velocity
    drew(0, cellsAt(10, 10));
    EXPECT_EQ(groupsOf(publish(), 0), kMotion);
    EXPECT_FALSE(isMoving(publisher.find(0)->state.motion));
    for (int i = 0; i < 10; ++i) {  // the object is not reported again while it stands still
      drew(0, cellsAt(10, 10));
      EXPECT_TRUE(publish().empty());
    }
  }
}

TEST_F(PublisherTest, StandingSolidObjectsAreExactOnceAClientPredicts) {
  const df::FixedVector position = cellsAt(10.3, 10.2);
  drawn(0, position);
  publish();
  EXPECT_NE(publisher.find(0)->state.motion.position, position) << "coarse is shorter";
  view.players[0].steering.p_table = std::make_shared<df::ControlTable>();
  drew(0, position);
  EXPECT_EQ(groupsOf(publish(), 0), kMotion);
  EXPECT_EQ(publisher.find(0)->state.motion.position, position);
  // An object that comes to rest within its cell is exact again.
  drawn(0, position, cellsAt(0.1, 0));
  publish();
  drawn(0, position + cellsAt(0.05, 0));
  EXPECT_EQ(groupsOf(publish(), 0), kMotion);
  EXPECT_EQ(publisher.find(0)->state.motion.position, position + cellsAt(0.05, 0));
}

TEST_F(PublisherTest, NewCharacterChangesOnlyTheLook) {
  changed(0, cellsAt(10, 10));
  drew(0, cellsAt(10, 10), U'a');
  publish();
  drew(0, cellsAt(10, 10), U'b');
  EXPECT_EQ(groupsOf(publish(), 0), kLook);
  EXPECT_EQ(publisher.find(0)->state.look.sequence[0][0].ch, U'b');
  EXPECT_EQ(publisher.correctionCount(), 0u);
}

TEST_F(PublisherTest, BoxChangesTheBodyAndAltitudeTheLook) {
  drawn(0, cellsAt(10, 10));
  publish();
  changed(0, cellsAt(10, 10)).box = {cellsAt(-1, -1), cellsAt(2, 2)};
  drew(0, cellsAt(10, 10));
  EXPECT_EQ(groupsOf(publish(), 0), kBody);
  df::ObjectFacts& facts = changed(0, cellsAt(10, 10));
  facts.box = {cellsAt(-1, -1), cellsAt(2, 2)};
  facts.altitude = 4;
  drew(0, cellsAt(10, 10));
  EXPECT_EQ(groupsOf(publish(), 0), kLook);
  EXPECT_EQ(publisher.find(0)->state.look.altitude, 4);
}

TEST_F(PublisherTest, HalfCellSpriteInFlightNeedsFewCorrections) {
  df::FixedVector position = cellsAt(5.3, 5.1);
  const df::FixedVector velocity = cellsAt(0.37, 0.11);
  std::size_t corrections = 0;
  for (int i = 0; i < 1000; ++i) {
    changed(0, position, velocity);
    std::vector<df::DrawCommand> sprite;
    for (int k = 0; k < 4; ++k) sprite.push_back({position + cellsAt(k - 1.5, -0.5), U'#', df::RED});
    drew({0, 1}, sprite);
    const std::size_t changes = publish().size();
    ASSERT_TRUE(i == 0 || changes == 0 || i >= 64) << "tick " << i;
    corrections += i > 0 ? changes : 0;
    position = position + velocity;
  }
  // The first rounded numbers fit for kMinHorizon ticks; corrected ones, for eight times the path's age.
  EXPECT_LE(corrections, 2u);
}

TEST_F(PublisherTest, SolidObjectStoppingAndHidingIsHiddenAtOnce) {
  view.players[0].steering.p_table = std::make_shared<df::ControlTable>();
  drawn(0, cellsAt(10.3, 10), cellsAt(0.2, 0));
  publish();
  changed(0, cellsAt(10.35, 10)).shown = false;  // the position must become exact in this tick
  EXPECT_EQ(groupsOf(publish(), 0), kLook | kMotion);
  EXPECT_EQ(publisher.find(0)->state.look.select(0), nullptr);
}

TEST_F(PublisherTest, AnObjectThatLeavesEveryViewKeepsItsLook) {
  df::FixedVector position = cellsAt(78, 5);
  const df::FixedVector velocity = cellsAt(1, 0);
  for (int i = 0; i < 20; ++i) {
    changed(0, position, velocity);
    if (df::cellOf(position.x) < 80) drew(0, position);
    const auto changes = publish();
    ASSERT_EQ(changes.size(), i == 0 ? 1u : 0u) << "tick " << i;
    position = position + velocity;
  }
  EXPECT_NE(publisher.find(0)->state.look.select(0), nullptr);
}

TEST_F(PublisherTest, SlotReuseInOneTickIsOneChange) {
  changed(3, cellsAt(10, 10));
  publish();
  view.vanished.push_back({3, 1});
  changed(3, cellsAt(11, 11)).key.generation = 2;
  const auto changes = publish();
  ASSERT_EQ(changes.size(), 1u);
  EXPECT_EQ(changes[0].groups, kAllGroups);
  EXPECT_EQ(publisher.find(3)->generation, 2u);
  view.vanished.push_back({3, 1});  // a death already reported
  EXPECT_TRUE(publish().empty());
  view.vanished.push_back({3, 2});
  EXPECT_EQ(groupsOf(publish(), 3), 0);
  EXPECT_EQ(publisher.find(3), nullptr);
}

TEST_F(PublisherTest, CharactersDrawnOutsideObjectsShareOneObject) {
  drew({}, {{cellsAt(5, 5), U'x', df::RED}});
  drew({}, {{cellsAt(60, 20), U'y', df::RED}});
  EXPECT_EQ(groupsOf(publish(), kFreeDrawSlot), kAllGroups);
  const ObjectState& state = publisher.find(kFreeDrawSlot)->state;
  ASSERT_EQ(state.look.sequence[0].size(), 2u);
  EXPECT_EQ(glyphCell(state.motion.position, state.look.sequence[0][1]), (CellPosition{60, 20}));
  EXPECT_EQ(state.look.altitude, 0);
  EXPECT_EQ(state.order, 0u);
  EXPECT_EQ(groupsOf(publish(), kFreeDrawSlot), kLook) << "nothing drawn: nothing shown";
  EXPECT_TRUE(publish().empty());
}

TEST_F(PublisherTest, ADrawingTooLargeToDescribeIsSentOnce) {
  const std::vector<df::DrawCommand> flood(kMaxGlyphs + 100, {cellsAt(5, 5), U'█', df::RED});
  changed(0, cellsAt(5, 5));
  drew({0, 1}, flood);
  EXPECT_EQ(publish().size(), 1u);
  for (int i = 0; i < 3; ++i) {
    drew({0, 1}, flood);
    EXPECT_TRUE(publish().empty());
  }
}

TEST_F(PublisherTest, SlotsBeyondTheLastAreRefusedAndCounted) {
  changed(kFreeDrawSlot, cellsAt(5, 5));
  EXPECT_TRUE(publish().empty());
  EXPECT_EQ(publisher.refusedCount(), 1u);
  EXPECT_EQ(publisher.find(kFreeDrawSlot), nullptr);
}

// Tests the whole chain: in every tick, a client draws exactly the world's cells.
void expectSamePictures(const test::WorldConfig& config, std::uint64_t seed, int ticks) {
  test::PublishedWorld world(config, seed);
  struct Client {
    SnapshotSender sender;
    test::SnapshotReader reader;
  };
  std::vector<Client> clients(config.players);
  for (int i = 0; i < ticks; ++i) {
    world.tick();
    for (std::size_t p = 0; p < clients.size(); ++p) {
      Client& client = clients[p];
      if (i < static_cast<int>(p) * 30) continue;  // the player joins later
      client.sender.applyTick(world.publisher, world.player(p));
      for (int round = 0; round < 3 && (round == 0 || !client.sender.isSettled()); ++round) {
        for (const SnapshotSender::Packet& packet : client.sender.build(world.publisher))
          client.reader.read(packet.bytes);
        client.sender.acknowledge(client.reader.acks);
      }
      ASSERT_TRUE(client.sender.isSettled());
      const df::Canvas wanted = world.picture(p);
      const df::Canvas seen = client.reader.replica.render(world.tickNumber());
      ASSERT_EQ(countDifferences(wanted, seen), 0)
          << "seed " << seed << ", tick " << i << ", player " << p << "\n"
          << test::explain(wanted, seen);
    }
  }
}

TEST_F(PublisherTest, ReplicaDrawsTheWorldsPictureEveryTick) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    test::WorldConfig config;
    config.players = 1 + seed % 3;
    config.objects = 10 + 7 * (seed % 9);
    if (seed % 4 == 0) {
      config.turn = config.restyle = config.reshape = config.vanish = config.hide = 0.2;
      config.scribble = config.speech = config.refollow = 0.3;
    }
    expectSamePictures(config, seed, 150);
    if (testing::Test::HasFatalFailure()) return;
  }
}

Sequence wheel() {
  std::vector<Appearance> frames;
  for (const char32_t spoke : {U'-', U'\\', U'|', U'/'})
    frames.push_back({{-256, 0, U'(', df::CYAN}, {0, 0, spoke, df::CYAN}, {256, 0, U')', df::CYAN}});
  return Sequence(frames);
}

// With any selector, the look is published once and then drawn correctly in all ticks.
TEST_F(PublisherTest, ALookThatChangesByItselfIsPublishedOnce) {
  for (const Selector& selector :
       {Selector::clock(1, 3), Selector::clock(1, 5, false), Selector::turning(1, 123456789, 98765432),
        Selector::turning(1, 0, -1'000'003), Selector::fixed(2)}) {
    publisher = Publisher();
    view.tick = 0;
    const Look look{wheel(), 2, selector};
    changed(0, cellsAt(10, 10));
    showed(0, cellsAt(10, 10), look);
    ASSERT_EQ(publish().size(), 1u);
    EXPECT_EQ(publisher.find(0)->state.look, look);
    EXPECT_TRUE(publisher.find(0)->recurs) << "worth a name from the beginning";
    for (int i = 0; i < 5000; ++i) {
      showed(0, cellsAt(10, 10), look);
      ASSERT_TRUE(publish().empty()) << i;
    }
  }
}

TEST_F(PublisherTest, PaceChangeIsPublishedWithTheFirstDifferentFrame) {
  Look look{wheel(), 2, Selector::turning(1, 0, 1 << 24)};  // 64 ticks per frame
  changed(0, cellsAt(10, 10));
  showed(0, cellsAt(10, 10), look);
  publish();
  const Look before = look;
  look.selector = Selector::turning(view.tick, before.selector.angleAt(view.tick), 1 << 25);
  int published = 0;
  for (int i = 0; i < 500; ++i) {
    const std::uint32_t tick = view.tick + 1;
    showed(0, cellsAt(10, 10), look);
    const auto changes = publish();
    const bool differs = published == 0 && look.select(tick) != before.select(tick);
    ASSERT_EQ(changes.size(), differs ? 1u : 0u) << tick;
    if (!differs) continue;
    ++published;
    EXPECT_EQ(changes[0].groups, kLook);
    EXPECT_TRUE(publisher.find(0)->state.look.sequence.isSharedWith(look.sequence));
  }
  EXPECT_EQ(published, 1);
}

TEST_F(PublisherTest, ADrawnLookOverridesTheDeclaredOne) {
  const Look look{wheel(), 2, Selector::clock(1, 3)};
  changed(0, cellsAt(10, 10));
  declares(look);
  drew({0, 1}, {{cellsAt(10, 10), U'?', df::RED}});
  publish();
  const Look& published = publisher.find(0)->state.look;
  EXPECT_EQ(published.sequence, (Sequence{{{0, 0, U'?', df::RED}}}));
  EXPECT_EQ(published.selector, Selector{});
  showed(0, cellsAt(10, 10), look);
  publish();
  EXPECT_EQ(published.sequence, wheel());
  EXPECT_EQ(published.selector, look.selector);
}

TEST(LookCapture, KeepsCharactersColoursAndOffsets) {
  const std::vector<df::DrawCommand> commands = {{cellsAt(10.25, 4), U'a', df::RED},
                                                 {cellsAt(8.75, 5), U'é', df::BLUE}};
  const Appearance appearance = captureAppearance(cellsAt(10.25, 4), commands);
  EXPECT_EQ(appearance, (Appearance{{0, 0, U'a', df::RED}, {-384, 256, U'é', df::BLUE}}));
}

TEST(LookCapture, NoticesEveryKindOfDifference) {
  const std::vector<df::DrawCommand> commands = {{cellsAt(1, 1), U'a', df::RED},
                                                 {cellsAt(2, 1), U'b', df::RED}};
  const Look look{{captureAppearance(cellsAt(1, 1), commands)}, 2};
  ASSERT_TRUE(drawsTheSame(look, 0, cellsAt(1, 1), commands));
  EXPECT_FALSE(drawsTheSame(look, 0, cellsAt(2, 1), commands));
  EXPECT_FALSE(drawsTheSame(look, 0, cellsAt(1, 1), std::span(commands).first(1)));
  EXPECT_FALSE(drawsTheSame(look, 0, cellsAt(1, 1), {}));
  EXPECT_FALSE(drawsTheSame(Look{}, 0, cellsAt(1, 1), commands));
  EXPECT_TRUE(drawsTheSame(Look{}, 0, cellsAt(1, 1), {}));
  for (int change = 0; change < 3; ++change) {
    std::vector<df::DrawCommand> other = commands;
    if (change == 0) other[1].ch = U'c';
    if (change == 1) other[1].color = df::BLUE;
    if (change == 2) other[1].position = cellsAt(2, 2);
    EXPECT_FALSE(drawsTheSame(look, 0, cellsAt(1, 1), other)) << change;
  }
}

TEST(LookCapture, LeavesOutDistantCharacters) {
  const std::vector<df::DrawCommand> commands = {{cellsAt(8192, 0), U'a', df::RED},
                                                 {cellsAt(8193, 0), U'b', df::RED}};
  EXPECT_EQ(captureAppearance(cellsAt(0, 0), commands).size(), 1u);
  EXPECT_EQ(captureCells(cellsAt(0, 0), commands).size(), 1u);
  const std::vector<df::DrawCommand> opposite = {{cellsAt(2e9, -2e9), U'a', df::RED}};
  EXPECT_TRUE(captureAppearance(cellsAt(-2e9, 2e9), opposite).empty());
  EXPECT_TRUE(captureCells(cellsAt(-2e9, 2e9), opposite).empty());
}

TEST(LookCapture, CutsAtTheLargestAppearance) {
  const std::vector<df::DrawCommand> commands(kMaxGlyphs + 5, {cellsAt(0, 0), U'x', df::RED});
  EXPECT_EQ(captureAppearance(cellsAt(0, 0), commands).size(), kMaxGlyphs);
}

TEST(LookCapture, TruncatesALookToFitARecord) {
  Appearance whole(kMaxGlyphs);
  SplitMix64 rng(3);
  for (Glyph& glyph : whole) {
    glyph = {static_cast<std::int32_t>(rng.below(90'000)), static_cast<std::int32_t>(rng.below(90'000)), U'█',
             static_cast<df::Color>(rng.below(8))};
  }
  ASSERT_GT(encodedBits({whole}), 8 * kMaxLookBytes);
  const Sequence fitted = fitToRecord(whole);
  EXPECT_LE(encodedBits(fitted), 8 * kMaxLookBytes);
  EXPECT_GT(encodedBits(fitted), 4 * kMaxLookBytes);
  ASSERT_EQ(fitted.size(), 1u);
  EXPECT_TRUE(std::equal(fitted[0].begin(), fitted[0].end(), whole.begin()));
  EXPECT_EQ(fitToRecord(fitted[0]), fitted);
}

}  // namespace
}  // namespace naiad

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>

#include "client/bot/TruthRecorder.h"
#include "shared/replica/Replica.h"
#include "shared/replica/TruthFile.h"
#include "tests/support/Text.h"

namespace naiad {
namespace {

class TruthFileTest : public testing::Test {
 protected:
  void TearDown() override { std::remove(path.c_str()); }
  std::string contents() const { return test::contentOf(path); }
  void put(const std::string& text) const { std::ofstream(path, std::ios::binary) << text; }

  std::string path = testing::TempDir() + "naiad-truth-" + std::to_string(getpid());
};

df::Canvas picture(char32_t ch, df::Color color) {
  df::Canvas canvas(4, 2);
  canvas.put(1, 0, {ch, color});
  canvas.put(3, 1, {U'x', df::BLACK});
  return canvas;
}

TEST_F(TruthFileTest, WritesTheDocumentedForm) {
  TruthWriter(path).write(12, 3, picture(U'é', df::RED));
  EXPECT_EQ(contents(), "tick 12 player 3 4 2\n é  \n   x\n.1..\n...0\n\n");
}

TEST_F(TruthFileTest, ReadsBackWhatWasWritten) {
  TruthWriter writer(path);
  writer.write(1, 1, picture(U'a', df::GREEN));
  writer.write(1, 2, df::Canvas(0, 0));
  writer.write(4000000000u, 1, picture(U'█', df::WHITE));
  ASSERT_TRUE(writer.isGood());
  TruthReader reader(path);
  auto record = reader.next();
  ASSERT_TRUE(record);
  EXPECT_EQ(record->tick, 1u);
  EXPECT_EQ(record->player, 1u);
  EXPECT_EQ(countDifferences(record->canvas, picture(U'a', df::GREEN)), 0);
  EXPECT_EQ(countDifferences(record->canvas, picture(U'a', df::RED)), 1);
  record = reader.next();
  ASSERT_TRUE(record);
  EXPECT_EQ(record->player, 2u);
  record = reader.next();
  ASSERT_TRUE(record);
  EXPECT_EQ(record->tick, 4000000000u);
  EXPECT_FALSE(reader.next());
  EXPECT_FALSE(reader.isMalformed());
}

TEST_F(TruthFileTest, IgnoresAnUnfinishedRecord) {
  TruthWriter(path).write(1, 1, picture(U'a', df::GREEN));
  const std::string whole = contents();
  for (std::size_t cut = 0; cut < whole.size(); ++cut) {
    put(whole + whole.substr(0, cut));
    TruthReader reader(path);
    EXPECT_TRUE(reader.next());
    EXPECT_FALSE(reader.next()) << "cut at " << cut;
    EXPECT_FALSE(reader.isMalformed()) << "cut at " << cut;
  }
}

TEST_F(TruthFileTest, RefusesOtherFiles) {
  for (const char* text : {"hello\n", "tick 1 player 1 4 2 9\n", "tick 1 player 1 -4 2\n",
                           "tick 1 player 1 99999 99999\n", "tick 1 player 1 2 1\nabc\n..\n\n",
                           "tick 1 player 1 2 1\nab\n9.\n\n", "tick 1 player 1 2 1\nab\n11\nx\n"}) {
    put(text);
    TruthReader reader(path);
    EXPECT_FALSE(reader.next()) << text;
    EXPECT_TRUE(reader.isMalformed()) << text;
  }
}

ObjectRecord star(std::uint32_t tick, int x, int velocity) {
  ObjectRecord object;
  object.id = 1;
  object.generation = 1;
  object.groups = kAllGroups;
  object.state.motion = {tick, {df::fromCells(x), df::fromCells(2)}, {df::fromCells(velocity), 0}, {}};
  object.state.look.sequence = {{Glyph{0, 0, U'*', df::YELLOW}}};
  return object;
}

df::Canvas starAt(int x) {
  df::Canvas canvas(80, 24);
  canvas.put(x, 2, {U'*', df::YELLOW});
  return canvas;
}

TEST_F(TruthFileTest, RecorderTakesTheLastPictureOfEachTick) {
  Replica replica;
  TruthRecorder recorder;
  std::uint32_t number = 0;
  AckWindow acks;
  const auto take = [&](std::uint32_t tick, std::vector<ObjectRecord> objects) {
    recorder.beforeSnapshot(replica, tick);
    Snapshot snapshot;
    snapshot.header.number = ++number;
    snapshot.header.tick = tick;
    snapshot.records.objects = std::move(objects);
    replica.apply(snapshot);
    acks.addReceived(number);
    recorder.afterSnapshot(snapshot.header, acks, false);
  };
  take(10, {});
  take(10, {star(10, 5, 1)});   // the second part of tick 10
  take(13, {star(13, 20, 0)});  // ticks 11 and 12 have no snapshot and are extrapolated
  recorder.finish(replica);
  EXPECT_EQ(recorder.tickCount(), 4u);
  EXPECT_EQ(recorder.movingCount(), 1u);

  TruthWriter writer(path);
  writer.write(9, 1, starAt(4));
  writer.write(10, 1, starAt(5));
  writer.write(10, 2, starAt(50));  // a picture of another player
  writer.write(11, 1, starAt(6));
  writer.write(12, 1, starAt(7));
  writer.write(13, 1, starAt(20));
  TruthRecorder::Comparison result = recorder.compare(path, 1);
  EXPECT_TRUE(result.readable);
  EXPECT_EQ(result.ticks, 4u);
  EXPECT_EQ(result.cells, 4u * 80 * 24);
  EXPECT_EQ(result.wrong, 0u);

  writer.write(13, 1, starAt(21));
  result = recorder.compare(path, 1);
  EXPECT_EQ(result.wrong, 2u);
  EXPECT_EQ(result.first_wrong_tick, 13u);
  EXPECT_FALSE(recorder.compare(path + "-none", 1).readable);
}

/// Gives a recorder snapshots without records.
class EmptySnapshots {
 public:
  explicit EmptySnapshots(TruthRecorder& recorder) : m_recorder(recorder) {}

  void take(std::uint32_t tick, bool complete, bool skips) {
    m_recorder.beforeSnapshot(replica, tick);
    SnapshotHeader header;
    header.number = m_acks.newest + 1;
    m_acks.addReceived(header.number);
    header.tick = tick;
    header.complete = complete;
    m_recorder.afterSnapshot(header, m_acks, skips);
  }

  const Replica replica;

 private:
  TruthRecorder& m_recorder;
  AckWindow m_acks;
};

TEST_F(TruthFileTest, RecorderLeavesOutIncompleteTicks) {
  TruthRecorder recorder;
  EmptySnapshots snapshots(recorder);
  const auto take = [&](std::uint32_t tick, bool complete, bool skips) {
    snapshots.take(tick, complete, skips);
  };
  TruthWriter writer(path);
  const df::Canvas blank(80, 24);
  for (std::uint32_t tick = 1; tick <= 12; ++tick) {
    const bool whole = tick == 3 || tick == 4 || tick == 7 || tick >= 10;
    writer.write(tick, 1, whole ? blank : starAt(1));
  }
  take(1, false, false);  // the first parts of a large world
  take(2, false, false);
  take(2, false, false);
  take(3, false, false);
  take(3, true, false);  // now complete
  take(5, false, false);
  take(7, true, true);  // on the stream, so 8 and 9 may have been skipped
  take(10, true, false);
  take(12, true, false);
  recorder.finish(snapshots.replica);
  const TruthRecorder::Comparison result = recorder.compare(path, 1);
  EXPECT_EQ(result.ticks, 6u);
  EXPECT_EQ(result.wrong, 0u) << "first at " << result.first_wrong_tick;
}

TEST_F(TruthFileTest, RecorderStopsAtItsCap) {
  TruthRecorder recorder(80 * 24 * 10);
  EmptySnapshots snapshots(recorder);
  snapshots.take(1, true, false);
  recorder.beforeSnapshot(snapshots.replica, 2000000000);  // a jump sent by a hostile server
  EXPECT_EQ(recorder.tickCount(), 10u);
}

}  // namespace
}  // namespace naiad

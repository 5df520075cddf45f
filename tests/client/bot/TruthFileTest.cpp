#include <gtest/gtest.h>

#include <fstream>

#include "client/bot/TruthRecorder.h"
#include "shared/replica/Replica.h"
#include "shared/replica/TruthFile.h"
#include "tests/support/TempFolder.h"
#include "tests/support/Text.h"

namespace naiad {
namespace {

class TruthFileTest : public testing::Test {
 protected:
  std::string contents() const { return test::contentOf(path); }
  void put(const std::string& text) const { std::ofstream(path, std::ios::binary) << text; }

  const test::TempFolder folder;
  const std::string path = folder / "truth";
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

/// A recorder of snapshots.
struct Recording {
  void take(std::uint32_t tick, bool complete, bool skips, std::vector<ObjectRecord> objects = {}) {
    recorder.beforeSnapshot(replica, tick);
    Snapshot snapshot;
    snapshot.header.number = acks.newest + 1;
    snapshot.header.tick = tick;
    snapshot.header.complete = complete;
    snapshot.records.objects = std::move(objects);
    replica.apply(snapshot);
    acks.addReceived(snapshot.header.number);
    recorder.afterSnapshot(snapshot.header, acks, skips);
  }

  TruthRecorder recorder;
  Replica replica;
  AckWindow acks;
};

TEST_F(TruthFileTest, RecorderTakesTheLastPictureOfEachTick) {
  Recording recording;
  TruthRecorder& recorder = recording.recorder;
  recording.take(10, true, false);
  recording.take(10, true, false, {star(10, 5, 1)});   // the second part of tick 10
  recording.take(13, true, false, {star(13, 20, 0)});  // ticks 11 and 12 are extrapolated
  recorder.finish(recording.replica);
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

TEST_F(TruthFileTest, RecorderLeavesOutIncompleteTicks) {
  Recording recording;
  TruthWriter writer(path);
  const df::Canvas blank(80, 24);
  for (std::uint32_t tick = 1; tick <= 12; ++tick) {
    const bool whole = tick == 3 || tick == 4 || tick == 7 || tick >= 10;
    writer.write(tick, 1, whole ? blank : starAt(1));
  }
  recording.take(1, false, false);  // the first parts of a large world
  recording.take(2, false, false);
  recording.take(2, false, false);
  recording.take(3, false, false);
  recording.take(3, true, false);  // now complete
  recording.take(5, false, false);
  recording.take(7, true, true);  // on the stream, so 8 and 9 may have been skipped
  recording.take(10, true, false);
  recording.take(12, true, false);
  recording.recorder.finish(recording.replica);
  const TruthRecorder::Comparison result = recording.recorder.compare(path, 1);
  EXPECT_EQ(result.ticks, 6u);
  EXPECT_EQ(result.wrong, 0u) << "first at " << result.first_wrong_tick;
}

TEST_F(TruthFileTest, RecorderStopsAtItsCap) {
  Recording recording;
  recording.recorder = TruthRecorder(80 * 24 * 10);
  recording.take(1, true, false);
  recording.recorder.beforeSnapshot(recording.replica, 2000000000);  // a jump sent by a hostile server
  EXPECT_EQ(recording.recorder.tickCount(), 10u);
}

}  // namespace
}  // namespace naiad

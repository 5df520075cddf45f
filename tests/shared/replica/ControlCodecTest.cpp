#include <gtest/gtest.h>

#include "RandomControls.h"

namespace naiad::test {
namespace {

std::string written(const df::ControlTable& table) {
  std::string bytes;
  writeControlTable(bytes, table);
  return bytes;
}

std::string written(const ControlRecord& record) {
  std::string bytes;
  writeControlRecord(bytes, record);
  return bytes;
}

df::ControlTable longestTable() {
  df::ControlTable table;
  df::ControlRow row;
  row.key = static_cast<df::Keyboard::Key>(df::Keyboard::kKeyCount - 1);
  row.value = {-df::kMaxControlReach, -df::kMaxControlReach};
  row.wait = df::kMaxControlTicks;
  row.group = df::kControlGroups - 1;
  table.rows.assign(df::kMaxControlRows, row);
  table.bounded = table.whole_cells = true;
  constexpr df::Fixed kFar = df::fromCells(1'000'000);
  table.bounds = {{-kFar, -kFar}, {kFar, kFar}};
  table.patience = df::kMaxControlTicks;
  return table;
}

TEST(ControlCodec, TablesAndStatesSurviveTheRoundTrip) {
  SplitMix64 rng(1);
  for (int i = 0; i < 5000; ++i) {
    const df::ControlTable table = randomTable(rng);
    ASSERT_TRUE(isValid(table));
    const auto read = readControlTable(written(table));
    ASSERT_TRUE(read);
    EXPECT_EQ(*read, table);
    const auto tick = static_cast<std::uint32_t>(rng.next());
    const ControlRecord record = randomControlRecord(rng, tick);
    const auto state = readControlRecord(written(record), tick);
    ASSERT_TRUE(state);
    EXPECT_EQ(*state, record);
  }
}

TEST(ControlCodec, LongestTableAndRecordFitTheirLimits) {
  EXPECT_LE(written(longestTable()).size(), kMaxControlTableBytes);
  ControlRecord record;
  record.slot = (1u << 20) - 1;
  record.generation = record.newest_input = UINT32_MAX;
  record.position.x = record.position.y = -df::fromCells(2'000'000'000);
  record.velocity.x = record.velocity.y = -df::fromCells(1 << 24);
  record.acceleration = record.velocity;
  record.state = {
      true, {-df::kMaxControlReach, true}, {-df::kMaxControlReach, true}, df::kMaxControlTicks, {}};
  record.state.wait.fill(df::kMaxControlTicks);
  EXPECT_LE(written(record).size(), kMaxControlRecordBytes);
  EXPECT_EQ(readControlRecord(written(record), 0), record);
}

TEST(ControlCodec, MovingShipTakesAtMost44Bytes) {
  ControlRecord record;
  record.slot = 40;
  record.generation = 1;
  record.newest_input = 1000;
  record.position = {df::fromCells(30), df::fromCells(20) + df::kFixedOne / 2};
  record.velocity = {df::kFixedOne, df::kFixedOne / 2};
  record.state = {true, {df::kFixedOne, false}, {df::kFixedOne / 2, false}, 3, {}};
  EXPECT_LE(written(record).size(), 44u);
}

TEST(ControlCodec, TruncatedAndOverlongBytesAreRefused) {
  SplitMix64 rng(2);
  for (int i = 0; i < 300; ++i) {
    const std::string table = written(randomTable(rng));
    const std::string record = written(randomControlRecord(rng, 7));
    for (std::size_t n = 0; n < table.size(); ++n) EXPECT_FALSE(readControlTable(table.substr(0, n)));
    for (std::size_t n = 0; n < record.size(); ++n) EXPECT_FALSE(readControlRecord(record.substr(0, n), 7));
    EXPECT_FALSE(readControlTable(table + '\0'));
    EXPECT_FALSE(readControlRecord(record + '\0', 7));
  }
}

TEST(ControlCodec, NumbersOutOfRangeAreRefused) {
  const auto refused = [](auto change) {
    df::ControlTable table = longestTable();
    change(table);
    return !isValid(table);
  };
  EXPECT_FALSE(refused([](df::ControlTable&) {}));
  EXPECT_TRUE(refused([](df::ControlTable& t) { t.rows.push_back(t.rows[0]); }));
  EXPECT_TRUE(refused([](df::ControlTable& t) { t.rows[3].value.x = df::kMaxControlReach + 1; }));
  EXPECT_TRUE(refused([](df::ControlTable& t) { t.rows[3].key = df::Keyboard::UNDEFINED_KEY; }));
  EXPECT_TRUE(refused([](df::ControlTable& t) { t.rows[3].action = df::UNDEFINED_KEYBOARD_ACTION; }));
  EXPECT_TRUE(refused([](df::ControlTable& t) { t.rows[3].group = df::kControlGroups; }));
  EXPECT_TRUE(refused([](df::ControlTable& t) { t.rows[3].x = false; }));
  EXPECT_TRUE(refused([](df::ControlTable& t) { t.patience = df::kMaxControlTicks + 1; }));
  EXPECT_TRUE(refused([](df::ControlTable& t) { t.bounds.size.x = -1; }));
  EXPECT_TRUE(refused([](df::ControlTable& t) { t.bounded = false; }));

  // Unknown keys, actions, effects and flags, and a position outside any world, are refused.
  std::string bytes = written(df::ControlTable{{df::ControlRow{}}, false, {}, false, 0});
  ASSERT_TRUE(readControlTable(bytes));
  for (const auto& [at, value] :
       {std::pair{3, df::Keyboard::kKeyCount}, {4, 0x33}, {4, 0x3C}, {4, 0x70}, {1, 4}}) {
    std::string bad = bytes;
    bad[static_cast<std::size_t>(at)] = static_cast<char>(value);
    EXPECT_FALSE(readControlTable(bad)) << at << " " << value;
  }
  ControlRecord far;
  far.position.x = df::fromCells(2'000'000'000) + 1;
  EXPECT_FALSE(readControlRecord(written(far), 0));
}

}  // namespace
}  // namespace naiad::test

// Messages between a host and a world's process: they arrive complete and are rejected if malformed.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <cctype>
#include <memory>
#include <string>
#include <vector>

#include "host/snapshot/Publisher.h"
#include "host/world/BuildId.h"
#include "host/world/TurnRecord.h"
#include "shared/net/base/Limits.h"
#include "shared/replica/Limits.h"
#include "tests/support/RunProgram.h"

namespace naiad {
namespace {

df::FixedVector at(std::int32_t x, std::int32_t y) {
  return {df::fromCells(x) + 12345, df::fromCells(y) - 54321};
}

std::shared_ptr<const Look> lookOf(char32_t first, Selector selector) {
  return std::make_shared<const Look>(Sequence{{{0, 0, first, df::RED}}, {{256, -256, first + 1, df::BLUE}}},
                                      3, selector);
}

/// Returns a view in which no field has its default.
df::WorldView fullView() {
  df::WorldView view;
  view.tick = 70'000;
  view.boundary = {at(-3, -4), at(200, 100)};
  view.view_width = 100;
  view.view_height = 30;
  view.changed.push_back(
      {{7, 3}, 11, at(1, 2), at(0, 1), at(1, 0), {at(-1, -1), at(3, 3)}, df::SOFT, true, false, true, 4});
  view.changed.push_back(
      {{2, 1}, 12, at(-5, 2), {}, {}, {at(0, 0), at(1, 1)}, df::HARD, false, true, false, 0});
  view.vanished = {{4, 9}, {5, 1}};
  view.commands = {{at(1, 2), U'x', df::GREEN}, {at(2, 2), U'é', df::CYAN}, {at(9, 9), U'o', df::BLACK}};
  view.drawn = {{{7, 3}, 0, 2, true}, {{}, 2, 1, false}};
  view.looks = {{0, lookOf(U'a', Selector::clock(69'000, 5))},
                {1, lookOf(U'c', Selector::turning(10, 1u << 31, -77))}};
  df::PlayerFacts player;
  player.id = 5;
  player.name = "änn";
  player.color = df::MAGENTA;
  player.score = -3;
  player.followed = {7, 3};
  player.view_corner = at(-40, -12);
  player.texts = {{1, 3, 4, df::YELLOW, "HP 3"}, {9, 0, 1, df::RED, "é"}};
  df::ControlTable table;
  table.rows.push_back({.key = df::Keyboard::LEFTARROW, .value = {df::fromCells(-1), 0}});
  player.steering = {
      std::make_shared<const df::ControlTable>(table), {7, 3}, {}, at(1, 2), at(0, 1), at(1, 0)};
  player.steering.state = {
      true, {df::kFixedOne, true}, {-df::kFixedOne, false}, 17, {0, 9000, 0, 0, 0, 0, 0, 1}};
  view.players.push_back(player);
  player.id = 8;
  player.name.clear();
  player.texts.clear();
  player.steering = {};
  view.players.push_back(player);
  view.corner = at(3, 1);
  view.sounds = {{"boom", df::SoundPlayed::kPause, true, true, 8}};
  view.sounds_lost = 3;
  view.playing = {{"theme", df::SoundPlayed::kPlay, true, true, 0}};
  view.notes = {"pause: 1 of 3", "resume: 2 of 3"};
  view.background = df::BLUE;
  view.shake_x = -2;
  view.shake_y = 1;
  return view;
}

std::string frameOf(const df::WorldView& view, ViewWriter& writer,
                    const WorldAnswer& answer = {false, {}, true, {}}) {
  std::string frame;
  EXPECT_TRUE(writeAnswer(answer, answer.has_view ? &view : nullptr, writer, frame));
  EXPECT_EQ(loadLittleEndian<std::uint32_t>(frame.data()), frame.size() - kWorldFrameHead);
  return frame;
}

std::string_view fieldsOf(const std::string& frame) {
  return std::string_view(frame).substr(kWorldFrameHead);
}

bool isSame(const df::SteeringFacts& a, const df::SteeringFacts& b) {
  if ((a.p_table == nullptr) != (b.p_table == nullptr)) return false;
  return (a.p_table == nullptr || *a.p_table == *b.p_table) && a.object == b.object && a.state == b.state &&
         a.position == b.position && a.velocity == b.velocity && a.acceleration == b.acceleration;
}

/// Compares two lists of objects that have no operator==.
template <class T, class Same>
void expectEach(const std::vector<T>& a, const std::vector<T>& b, Same same) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_TRUE(same(a[i], b[i])) << i;
}

void expectSame(const df::WorldView& a, const df::WorldView& b) {
  EXPECT_EQ(a.tick, b.tick);
  EXPECT_EQ(a.boundary, b.boundary);
  EXPECT_EQ(a.view_width, b.view_width);
  EXPECT_EQ(a.view_height, b.view_height);
  expectEach(a.changed, b.changed, [](const auto& f, const auto& g) {
    return f.key == g.key && f.order == g.order && f.position == g.position && f.velocity == g.velocity &&
           f.acceleration == g.acceleration && f.box == g.box && f.solidness == g.solidness &&
           f.no_soft == g.no_soft && f.shown == g.shown && f.on_view == g.on_view && f.altitude == g.altitude;
  });
  EXPECT_EQ(a.vanished, b.vanished);
  expectEach(a.commands, b.commands, [](const auto& f, const auto& g) {
    return f.position == g.position && f.ch == g.ch && f.color == g.color;
  });
  expectEach(a.drawn, b.drawn, [](const auto& f, const auto& g) {
    return f.key == g.key && f.first == g.first && f.count == g.count && f.on_view == g.on_view;
  });
  expectEach(a.looks, b.looks,
             [](const auto& f, const auto& g) { return f.drawn == g.drawn && *f.p_look == *g.p_look; });
  expectEach(a.players, b.players, [](const auto& f, const auto& g) {
    return f.id == g.id && f.name == g.name && f.color == g.color && f.score == g.score &&
           f.followed == g.followed && f.view_corner == g.view_corner && f.texts == g.texts &&
           isSame(f.steering, g.steering);
  });
  EXPECT_EQ(a.corner, b.corner);
  EXPECT_EQ(a.sounds, b.sounds);
  EXPECT_EQ(a.sounds_lost, b.sounds_lost);
  EXPECT_EQ(a.playing, b.playing);
  EXPECT_EQ(a.notes, b.notes);
  EXPECT_EQ(a.background, b.background);
  EXPECT_EQ(a.shake_x, b.shake_x);
  EXPECT_EQ(a.shake_y, b.shake_y);
}

class WorldMessages : public testing::Test {
 protected:
  /// Sends an answer from the world to the host; nullopt if it is refused.
  std::optional<WorldAnswer> send(const df::WorldView& sent,
                                  const WorldAnswer& answer = {false, {}, true, {}}) {
    return readAnswer(fieldsOf(frameOf(sent, writer, answer)), reader, view);
  }

  /// Call after a refused view.
  void restart() {
    reader = ViewReader();
    view = {};
  }

  ViewWriter writer;
  ViewReader reader;
  df::WorldView view;  ///< read by the host
};

TEST_F(WorldMessages, ViewsArriveUnchanged) {
  const df::WorldView sent = fullView();
  std::size_t first = 0;
  for (int i = 0; i < 3; ++i) {
    const std::string frame = frameOf(sent, writer);
    const auto answer = readAnswer(fieldsOf(frame), reader, view);
    ASSERT_TRUE(answer && answer->has_view);
    expectSame(view, sent);
    if (i == 0) first = frame.size();
    if (i > 0) {
      EXPECT_LT(frame.size(), first) << "sequences and tables were written before";
    }
  }
}

TEST_F(WorldMessages, ViewNumbersRestartAtTheLimit) {
  df::WorldView sent = fullView();
  for (std::uint32_t i = 0; i < 3 * kMaxViewNumbers; ++i) {
    sent.looks[1].p_look = lookOf(U'a' + static_cast<char32_t>(i % 20), Selector::fixed(i % 2));
    ASSERT_TRUE(send(sent)) << i;
    ASSERT_EQ(*view.looks[0].p_look, *sent.looks[0].p_look) << i;
    ASSERT_EQ(*view.looks[1].p_look, *sent.looks[1].p_look) << i;
  }
}

TEST_F(WorldMessages, TicksOfALaterWorldAreOffset) {
  constexpr std::uint32_t kLater = 1000;
  reader = ViewReader(kLater);
  const df::WorldView sent = fullView();
  ASSERT_TRUE(send(sent));
  EXPECT_EQ(view.tick, sent.tick + kLater);
  for (std::uint32_t tick = sent.tick; tick < sent.tick + 200; ++tick) {
    for (std::size_t i = 0; i < 2; ++i) {
      const Appearance* p_sent = sent.looks[i].p_look->select(tick);
      EXPECT_EQ(*view.looks[i].p_look->select(tick + kLater), *p_sent) << tick;
    }
  }
}

TEST_F(WorldMessages, ReadyMessageArrivesCompleteAndInRange) {
  WorldReady sent{100, 30, 50, true, {"left and right", std::string(kMaxHelpLength + 5, 'x')}};
  sent.runs_empty = true;
  std::string frame;
  writeReady(sent, frame);
  const auto ready = readReady(fieldsOf(frame));
  ASSERT_TRUE(ready);
  EXPECT_EQ(ready->window_width, 100);
  EXPECT_EQ(ready->window_height, 30);
  EXPECT_EQ(ready->frame_millis, 50);
  EXPECT_TRUE(ready->compat && ready->runs_empty);
  EXPECT_EQ(ready->help, (std::vector<std::string>{"left and right", std::string(kMaxHelpLength, 'x')}));
  for (std::size_t length = 0; length < frame.size() - kWorldFrameHead; ++length) {
    EXPECT_FALSE(readReady(fieldsOf(frame).substr(0, length))) << length;
  }
  for (std::size_t bit = 0; bit < (frame.size() - kWorldFrameHead) * 8; ++bit) {
    std::string flipped(fieldsOf(frame));
    flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << bit % 8));
    const auto read = readReady(flipped);
    EXPECT_TRUE(!read || (read->window_width <= kMaxViewWidth && read->window_height <= kMaxViewHeight &&
                          read->frame_millis <= kMaxFrameMillis && read->help.size() <= kMaxHelpLines))
        << bit;
  }
  sent.help.assign(kMaxHelpLines + 1, "x");
  writeReady(sent, frame);
  EXPECT_EQ(readReady(fieldsOf(frame)).value_or(WorldReady()).help.size(), kMaxHelpLines);
}

TEST_F(WorldMessages, OnlyTheIdOfAnotherBuildIsRead) {
  std::string frame;
  writeReady({}, frame);
  std::string fields(fieldsOf(frame));
  ASSERT_EQ(readBuild(fields), ownBuildId());
  ASSERT_GE(ownBuildId().size(), 16u);
  char& digit = fields[1];
  digit = digit == '0' ? '1' : '0';
  ASSERT_TRUE(readBuild(fields));
  EXPECT_NE(readBuild(fields), ownBuildId());
  EXPECT_FALSE(readReady(fields)) << "though the rest may read as ours";
  EXPECT_TRUE(readBuild(fields.substr(0, 1 + ownBuildId().size()) + "\xff\xff"));
  digit = '\x1b';
  EXPECT_FALSE(readBuild(fields)) << "what is no id must not come to the log";
}

TEST_F(WorldMessages, AnswersArriveUnchanged) {
  WorldAnswer sent{true, {3, 70'000}, false, {}};
  sent.pictures.push_back({5, df::Canvas(3, 2)});
  sent.pictures[0].canvas.put(1, 1, {U'ü', df::RED});
  sent.scores = {{"arcade", {"ann", -7}, 70'000, 3},
                 {"other", {"bob", df::HighScoreLimits::kMaxPoints}, 70'000, 4}};
  sent.sent = {{3, "arcade"}};
  const auto answer = send({}, sent);
  ASSERT_TRUE(answer);
  EXPECT_TRUE(answer->game_over);
  EXPECT_FALSE(answer->has_view);
  EXPECT_EQ(answer->leavers, sent.leavers);
  ASSERT_EQ(answer->scores.size(), 2u);
  EXPECT_EQ(answer->scores[0].table, "arcade");
  EXPECT_EQ(answer->scores[0].score, sent.scores[0].score);
  EXPECT_EQ(answer->scores[1].score, sent.scores[1].score);
  EXPECT_EQ(answer->scores[1].tick, 70'000u);
  EXPECT_EQ(answer->scores[1].number, 4);
  ASSERT_EQ(answer->sent.size(), 1u);
  EXPECT_EQ(answer->sent[0].player, 3u);
  EXPECT_EQ(answer->sent[0].room, "arcade");
  ASSERT_EQ(answer->pictures.size(), 1u);
  EXPECT_EQ(answer->pictures[0].player, 5u);
  EXPECT_EQ(countDifferences(answer->pictures[0].canvas, sent.pictures[0].canvas), 0);
}

WorldTurn fullTurn() {
  using Queue = df::InputQueue;
  WorldTurn turn{{}, true, true, true};
  turn.rendered_player = 5;
  turn.inputs.push_back({.kind = Queue::kJoin, .player = 4, .name = "bob", .color = df::GREEN});
  turn.inputs.push_back(
      {.kind = Queue::kKey, .player = 4, .key = df::Keyboard::PAGEDOWN, .key_action = df::KEY_DOWN});
  turn.inputs.push_back({.kind = Queue::kMouse,
                         .player = 4,
                         .seen = {true, 90'000, 90'003},
                         .button = df::Mouse::UNDEFINED_MOUSE_BUTTON,
                         .mouse_action = df::MOVED,
                         .x = 79,
                         .y = 23});
  turn.inputs.push_back({.kind = Queue::kLeave, .player = 4});
  turn.inputs.push_back(
      {.kind = Queue::kScore, .player = 0, .name = "eve", .table = "arcade", .points = -900'000'000'000});
  turn.inputs.push_back({.kind = Queue::kRoom,
                         .player = 0,
                         .room = {"arcade", "saucershoot", 3, df::GameRoomLimits::kMaxPlayers, true, false}});
  return turn;
}

std::string messageOf(const WorldTurn& turn, bool copied = false) {
  std::string record;
  std::string message;
  EXPECT_TRUE(TurnRecordWriter().write(turn, record));
  appendTurnMessage(record, copied, message);
  EXPECT_EQ(loadLittleEndian<std::uint32_t>(message.data()), message.size() - kWorldFrameHead);
  return message;
}

std::optional<WorldTurn> readTurn(std::string_view fields, bool* p_copied = nullptr) {
  TurnRecordReader records;
  bool copied = false;
  const auto turn = readTurnMessage(fields, records, copied);
  if (p_copied != nullptr) *p_copied = copied;
  return turn;
}

TEST_F(WorldMessages, TurnsArriveUnchanged) {
  const WorldTurn sent = fullTurn();
  bool copied = false;
  const std::string message = messageOf(sent, true);
  const auto turn = readTurn(fieldsOf(message), &copied);
  ASSERT_TRUE(turn);
  EXPECT_TRUE(turn->watched && turn->wants_truth && turn->ends_game && copied && !turn->checked);
  EXPECT_EQ(turn->rendered_player, 5u);
  ASSERT_EQ(turn->inputs.size(), sent.inputs.size());
  for (std::size_t i = 0; i < sent.inputs.size(); ++i) {
    const auto& a = sent.inputs[i];
    const auto& b = turn->inputs[i];
    EXPECT_TRUE(a.kind == b.kind && a.player == b.player && a.name == b.name && a.color == b.color &&
                a.key == b.key && a.key_action == b.key_action && a.button == b.button &&
                a.mouse_action == b.mouse_action && a.x == b.x && a.y == b.y && a.table == b.table &&
                a.points == b.points && a.room == b.room && a.seen.known == b.seen.known &&
                a.seen.base == b.seen.base && a.seen.drawn == b.seen.drawn)
        << i;
  }
}

TEST_F(WorldMessages, AMessageHasOneTurnAndNothingElse) {
  std::string records;
  TurnRecordWriter turn_writer;
  turn_writer.write(TickResult(), records);
  std::string message;
  appendTurnMessage(records, false, message);
  EXPECT_FALSE(readTurn(fieldsOf(message))) << "no turn";
  records.clear();
  turn_writer.write(WorldTurn(), records);
  turn_writer.write(WorldTurn(), records);
  message.clear();
  appendTurnMessage(records, false, message);
  EXPECT_FALSE(readTurn(fieldsOf(message))) << "two of them";
}

TEST_F(WorldMessages, EveryTruncationIsRefused) {
  const std::string frame = frameOf(fullView(), writer);
  const std::string turn = messageOf(fullTurn());
  for (std::size_t size = 0; size < frame.size() - kWorldFrameHead; ++size) {
    restart();
    EXPECT_FALSE(readAnswer(fieldsOf(frame).substr(0, size), reader, view)) << size;
  }
  for (std::size_t size = 0; size < turn.size() - kWorldFrameHead; ++size) {
    EXPECT_FALSE(readTurn(fieldsOf(turn).substr(0, size))) << size;
  }
  restart();
  EXPECT_FALSE(readAnswer(std::string(fieldsOf(frame)) + '\0', reader, view)) << "something is left over";
  EXPECT_FALSE(readTurn(std::string(fieldsOf(turn)) + '\0'));
}

// Accepted messages are legal: they can be written again and published.
TEST_F(WorldMessages, EverySingleBitFlipIsRefusedOrLegal) {
  const std::string frame = frameOf(fullView(), writer);
  int refused = 0;
  for (std::size_t bit = 8 * kWorldFrameHead; bit < 8 * frame.size(); ++bit) {
    std::string bad = frame;
    bad[bit / 8] = static_cast<char>(bad[bit / 8] ^ (1 << bit % 8));
    restart();
    if (!readAnswer(fieldsOf(bad), reader, view)) {
      ++refused;
      continue;
    }
    ViewWriter again;
    ViewReader back;
    df::WorldView same;
    ASSERT_TRUE(readAnswer(fieldsOf(frameOf(view, again)), back, same)) << bit;
    expectSame(same, view);
    Publisher publisher;
    publisher.update(fullView());
    publisher.update(view);
  }
  EXPECT_GT(refused, 100);
}

TEST_F(WorldMessages, MoreScoresThanATickMayHaveAreRefused) {
  const auto isRead = [this](std::size_t count) {
    const df::AddedScore score{"t", {"n", 0}, 0, 0};
    WorldAnswer sent;
    sent.scores.assign(df::HighScoreLimits::kMaxAddedInTick, score);
    std::string fields(fieldsOf(frameOf({}, writer, sent)));
    const std::size_t each = (fields.size() - fieldsOf(frameOf({}, writer, WorldAnswer())).size()) / 16;
    const std::size_t first = fields.find("t") - 1;
    fields[first - 1] = static_cast<char>(count);  // the number of scores that follow
    if (count == 17) fields.insert(first, fields.substr(first, each));
    return readAnswer(fields, reader, view).has_value();
  };
  EXPECT_TRUE(isRead(16));
  EXPECT_FALSE(isRead(17));
}

TEST_F(WorldMessages, WriterClampsOutOfRangeValues) {
  df::WorldView sent = fullView();
  sent.players[0].view_corner = {INT64_MAX, INT64_MIN};
  sent.changed[0].velocity = {INT64_MIN, INT64_MAX};
  sent.view_width = 100'000;
  sent.sounds[0].label = std::string(100'000, 'x');
  ASSERT_TRUE(send(sent));
  EXPECT_EQ(view.players[0].view_corner.y, -view.players[0].view_corner.x);
  EXPECT_GT(view.players[0].view_corner.x, 0);
}

std::string countOf(std::uint64_t count) {
  std::string bytes;
  ByteWriter(bytes).varint(count);
  return bytes;
}

/// Returns the peak memory of this process, in MiB.
long mostMemory() {
  rusage facts{};
  getrusage(RUSAGE_SELF, &facts);
  return facts.ru_maxrss / 1024;
}

TEST_F(WorldMessages, OversizedListIsRejectedBeforeAllocation) {
  constexpr long kMuch = 100;  // in MiB; 16 Mi strings would take 512 MiB
  WorldReady ready;
  std::string frame;
  writeReady(ready, frame);
  std::string fields(fieldsOf(frame));
  fields.pop_back();  // removes the number of help lines
  const std::string lines(kMaxWorldFrame - 64, '\0');
  const long before = mostMemory();
  EXPECT_FALSE(readReady(fields + countOf(lines.size()) + lines));
  EXPECT_LT(mostMemory() - before, kMuch);

  fields = fieldsOf(frameOf(view, writer));
  view.notes = {""};
  const std::string with_note(fieldsOf(frameOf(view, writer)));
  const auto notes = std::mismatch(fields.begin(), fields.end(), with_note.begin()).first - fields.begin();
  fields.replace(static_cast<std::size_t>(notes), 1, countOf(lines.size()) + lines);
  const long then = mostMemory();
  EXPECT_FALSE(readAnswer(fields, reader, view));
  EXPECT_LT(mostMemory() - then, kMuch);
}

TEST_F(WorldMessages, AFrameThatIsTooLongIsNotWritten) {
  df::WorldView sent = fullView();
  sent.commands.resize(kMaxWorldFrame / 16, {at(1, 1), U'x', df::RED});
  std::string frame;
  EXPECT_FALSE(writeAnswer({false, {}, true, {}}, &sent, writer, frame));
}

TEST(BuildId, MatchesTheLibraryFile) {
  const std::string& id = ownBuildId();
  ASSERT_GE(id.size(), 2 * kShownBuildId);
  ASSERT_LE(id.size(), kMaxBuildId);
  EXPECT_TRUE(std::ranges::all_of(id, [](unsigned char c) { return std::isxdigit(c) != 0; })) << id;
  const auto [code, notes] =
      test::runProgram("readelf -n '" NAIAD_BINARY_DIR "/../lib/libdragonfly.so' 2>/dev/null");
  if (code != 0) GTEST_SKIP() << "there is no readelf";
  EXPECT_NE(notes.find("Build ID: " + id), std::string::npos) << notes;
}

TEST(BuildId, IsFoundByTheFilesName) {
  EXPECT_EQ(buildIdOf("libdragonfly.so"), ownBuildId());
  EXPECT_NE(buildIdOf("libc.so"), ownBuildId());
  EXPECT_EQ(buildIdOf("libnothing.so"), "");
}

}  // namespace
}  // namespace naiad

#include "WorldSeeds.h"

#include <algorithm>

#include "ScriptedWorld.h"
#include "host/journal/DfrWriter.h"
#include "host/world/BuildId.h"
#include "host/world/TurnRecord.h"
#include "host/world/WorldMessages.h"
#include "shared/net/base/Limits.h"
#include "shared/replica/Bytes.h"

namespace naiad::fuzz {
namespace {

/// Little of everything.
df::WorldView fullView() {
  df::WorldView view;
  view.tick = 9;
  view.boundary = {{}, {df::fromCells(80), df::fromCells(24)}};
  view.changed.push_back({{1, 1}, 3, {}, {df::kFixedOne, 0}, {}, {{}, {df::kFixedOne, df::kFixedOne}}});
  view.vanished = {{2, 1}};
  view.commands = {{{}, U'x', df::GREEN}};
  view.drawn = {{{1, 1}, 0, 1, false}};
  const Sequence frames{{{0, 0, U'x', df::GREEN}}, {{0, 0, U'y', df::GREEN}}};
  view.looks = {{0, std::make_shared<const Look>(frames, 2, Selector::clock(9, 3))}};
  df::PlayerFacts player;
  player.id = 1;
  player.name = "ann";
  player.texts = {{1, 3, 4, df::YELLOW, "HP"}, {2, 3, 5, df::RED, "3"}};
  df::ControlTable table;
  table.rows.push_back({.key = df::Keyboard::A, .value = {df::kFixedOne, 0}});
  player.steering.p_table = std::make_shared<const df::ControlTable>(table);
  player.steering.object = player.followed = {1, 1};
  view.players.push_back(player);
  player.id = 2;
  view.players.push_back(player);
  view.sounds = {{"boom", df::SoundPlayed::kStop, true, true, 1}};
  return view;
}

std::string fieldsOf(const df::WorldView& view) {
  ViewWriter views;
  std::string frame;
  writeAnswer({.has_view = true}, &view, views, frame);
  return frame.substr(kWorldFrameHead);
}

/// More help lines, and more notes, than there can be.
void tooMany(Folder& folder) {
  const std::string lines(kMaxHelpLines + 1, '\0');
  std::string frame;
  writeReady({}, frame);
  frame.back() = static_cast<char>(lines.size());  // the number of lines is the last
  folder.add('\0' + frame.substr(kWorldFrameHead + 1 + ownBuildId().size()) + lines);

  df::WorldView view;
  std::string fields = fieldsOf(view);
  view.notes = {""};
  const std::string with_note = fieldsOf(view);
  const auto count = std::mismatch(fields.begin(), fields.end(), with_note.begin()).first;
  *count = static_cast<char>(lines.size());
  fields.insert(count + 1, lines.begin(), lines.end());
  folder.add('\1' + u16(fields.size()) + fields);
}

}  // namespace

void worlds(Folder folder) {
  SplitMix64 random(15);
  for (std::size_t i = 0; i < 16; ++i) {
    const std::string bytes = randomBytes(random, 200);
    Script script(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    ScriptedWorld world;
    ViewWriter views;
    std::string input = "\1";
    for (std::size_t tick = 0; tick <= i; ++tick) {
      world.happen(script);
      world.tick();
      std::string frame;
      writeAnswer({false, {}, true, {}}, &world.view(), views, frame);
      if (frame.size() > 0xFFFF) break;
      input += u16(frame.size() - kWorldFrameHead) + frame.substr(kWorldFrameHead);
    }
    folder.add(input);
  }
  std::string full = "\1";
  for (const Selector& selector :
       {Selector::clock(9, 3), Selector::turning(9, 1u << 30, 5), Selector::fixed(1)}) {
    df::WorldView view = fullView();
    view.looks[0].p_look = std::make_shared<const Look>(view.looks[0].p_look->sequence, 2, selector);
    WorldAnswer answer{
        .leavers = {1}, .has_view = true, .pictures = {{1, df::Canvas(2, 1)}}, .sent = {{1, "arcade"}}};
    ViewWriter views;
    std::string frame;
    writeAnswer(answer, &view, views, frame);
    folder.add("\1" + u16(frame.size() - kWorldFrameHead) + frame.substr(kWorldFrameHead));
    full += u16(frame.size() - kWorldFrameHead) + frame.substr(kWorldFrameHead);
  }
  folder.add(full);
  using Queue = df::InputQueue;
  WorldTurn turn{{}, true, true, false};
  turn.inputs.push_back({.kind = Queue::kJoin, .player = 4, .name = "bob", .color = df::GREEN});
  turn.inputs.push_back(
      {.kind = Queue::kKey, .player = 4, .key = df::Keyboard::A, .key_action = df::KEY_DOWN});
  turn.inputs.push_back(
      {.kind = Queue::kMouse, .player = 4, .seen = {true, 9, 10}, .mouse_action = df::MOVED});
  turn.inputs.push_back({.kind = Queue::kLeave, .player = 4});
  turn.inputs.push_back(
      {.kind = Queue::kRoom, .player = 0, .room = {.name = "arcade", .game = "tron", .max_players = 8}});
  std::string record;
  std::string message;
  TurnRecordWriter().write(turn, record);
  appendTurnMessage(record, false, message);
  folder.add('\0' + message.substr(kWorldFrameHead));
  tooMany(folder);
}

/// Each file as it is; the same records without a checksum in the way; chunks of one.
void rounds(Folder folder) {
  std::string records;
  TurnRecordWriter writer;
  WorldTurn turn;
  turn.watched = true;
  df::InputQueue::Input join{df::InputQueue::kJoin, 1};
  join.name = "Ann";
  join.color = df::RED;
  df::InputQueue::Input key{df::InputQueue::kKey, 1};
  key.key = df::Keyboard::A;
  key.key_action = df::KEY_PRESSED;
  turn.inputs = {join, key};
  writer.write(turn, records);
  TickResult result;
  result.has_check = true;
  result.check = 7;
  writer.write(result, records);
  turn.checked = true;
  turn.inputs = {{df::InputQueue::kLeave, 1}};
  writer.write(turn, records);
  result.state_hash = 1234567890123u;
  writer.write(result, records);
  RecordedPicture picture{1, df::Canvas(20, 10)};
  picture.canvas.put(1, 1, {U'@', df::RED});
  writer.write(picture, records);
  DfrTurnPacker packer;
  const std::string file = spellDfrHeader({}) + spellDfrMeta({{"game", "hello"}}) + packer.pack(records) +
                           packer.pack(records) + spellDfrDone("is over");
  folder.add(std::string(1, '\0') + file);
  folder.add(std::string("\2\0", 2) + records);
  std::string packed;
  RecordPacker().pack(records, packed);
  folder.add(std::string("\2\1", 2) + packed);
  const auto chunk = [](char type, const std::string& payload) {
    return type + u16(payload.size()) + payload;
  };
  const std::string meta = spellDfrMeta({{"game", "hello"}, {"players", "first"}}).substr(kDfrChunkHead);
  std::string turns(kDfrTurnPlace, '\0');
  ByteWriter(turns).varint(records.size() << 1 | kDfrRaw);
  folder.add("\1" + chunk(0, meta) + chunk(1, turns + records) + chunk(3, "later") + chunk(2, "is over"));
}

}  // namespace naiad::fuzz

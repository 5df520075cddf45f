#include "server/replay/Verify.h"

#include <algorithm>
#include <chrono>
#include <iomanip>
#include <ostream>
#include <utility>

#include "server/replay/Replay.h"
#include "shared/net/base/Limits.h"
#include "shared/net/base/SafeText.h"
#include "shared/replica/Limits.h"

namespace naiad {

namespace {

using WorldInput = df::InputQueue::Input;

double secondsOf(const RecordedRound& round, std::uint32_t ticks) {
  return static_cast<double>(round.header().frame_nanos) * ticks / 1e9;
}

const df::Canvas* findPicture(const Replay& replay, std::uint32_t player) {
  for (const WorldPicture& picture : replay.pictures()) {
    if (picture.player == player || player == 0) return &picture.canvas;
  }
  return nullptr;
}

std::string trimmed(const std::string& row) {
  const std::size_t last = row.find_last_not_of(' ');
  return safeText(row.substr(0, last == std::string::npos ? 0 : last + 1), 1000);
}

void printRows(const df::Canvas& recorded, const df::Canvas& again, std::ostream& out) {
  int same = 0;
  const int height = std::max(recorded.height(), again.height());
  for (int y = 0; y < height; ++y) {
    bool equal = true;
    const int width = std::max(recorded.width(), again.width());
    for (int x = 0; x < width && equal; ++x) equal = recorded.at(x, y) == again.at(x, y);
    if (equal) {
      ++same;
      continue;
    }
    out << "  row " << std::setw(3) << y + 1 << " recorded |" << trimmed(recorded.rowText(y)) << "\n"
        << "          replayed |" << trimmed(again.rowText(y)) << "\n";
  }
  out << "  " << same << " of " << height << " rows are equal\n";
}

/// Prints the differences between the file's picture of this tick, or the next one in the file, and the
/// world's.
void showDifference(Replay& replay, std::ostream& out) {
  do {
    if (!replay.recordedPicture()) continue;
    const RecordedPicture& recorded = *replay.recordedPicture();
    const df::Canvas* p_again = findPicture(replay, recorded.player);
    out << "Picture of player " << recorded.player << " at tick " << replay.tick() << ":\n";
    return printRows(recorded.canvas, p_again != nullptr ? *p_again : df::Canvas(), out);
  } while (replay.step());
  out << "The file has no picture after this tick.\n";
}

void printWarnings(const std::vector<std::string>& warnings, std::ostream& out) {
  for (const std::string& warning : warnings) out << "note: " << safeText(warning, 300) << "\n";
}

const char* endText(DfrEnd end) {
  switch (end) {
    case DfrEnd::kDone:
      return "to its end";
    case DfrEnd::kTorn:
      return "to the last complete record of a truncated file";
    case DfrEnd::kDamaged:
      break;
  }
  return "to the last record before a damaged one";
}

std::string keyName(df::Keyboard::Key key) {
  if (key >= df::Keyboard::A && key <= df::Keyboard::Z)
    return std::string(1, static_cast<char>('A' + key - df::Keyboard::A));
  if (key >= df::Keyboard::NUM1 && key <= df::Keyboard::NUM9)
    return std::string(1, static_cast<char>('1' + key - df::Keyboard::NUM1));
  if (key >= df::Keyboard::F1 && key <= df::Keyboard::F12)
    return "F" + std::to_string(1 + key - df::Keyboard::F1);
  using namespace df::Keyboard;
  static constexpr std::pair<Key, const char*> kNames[] = {
      {SPACE, "space"}, {RETURN, "return"},  {ESCAPE, "escape"},    {LEFTARROW, "left"},
      {UPARROW, "up"},  {DOWNARROW, "down"}, {RIGHTARROW, "right"}, {NUM0, "0"}};
  for (const auto& [named, p_name] : kNames) {
    if (named == key) return p_name;
  }
  return "key-" + std::to_string(static_cast<int>(key));
}

const char* actionName(df::EventKeyboardAction action) {
  return action == df::KEY_PRESSED ? "pressed" : action == df::KEY_RELEASED ? "released" : "down";
}

const char* actionName(df::EventMouseAction action) {
  return action == df::CLICKED ? "clicked" : action == df::PRESSED ? "pressed" : "moved";
}

void printInput(const WorldInput& input, std::ostream& out) {
  out << " player=" << input.player;
  switch (input.kind) {
    case df::InputQueue::kJoin:
      out << " joins name=\"" << safeText(input.name, 100) << "\" color=" << input.color;
      break;
    case df::InputQueue::kLeave:
      out << " leaves";
      break;
    case df::InputQueue::kKey:
      out << " key=" << keyName(input.key) << " " << actionName(input.key_action);
      break;
    case df::InputQueue::kMouse:
      out << " mouse=" << actionName(input.mouse_action) << " button=" << input.button << " x=" << input.x
          << " y=" << input.y;
      break;
    case df::InputQueue::kScore:
      out << " score table=" << safeText(input.table, 100) << " name=\"" << safeText(input.name, 100)
          << "\" points=" << input.points;
      break;
    case df::InputQueue::kRoom:
      out << " room=" << safeText(input.room.name, 100) << " players=" << input.room.players;
      break;
  }
}

}  // namespace

bool verifyRound(const RecordedRound& round, const ReplayEnvironment& environment, std::ostream& out) {
  printWarnings(round.warnings(), out);
  printWarnings(environment.warnings(), out);
  Replay replay(round, environment);
  for (const std::string& file : replay.changedFiles())
    out << "note: the file " << safeText(file, 300) << " is not the recorded one\n";
  if (!replay.hasFixedAddresses()) out << "note: memory addresses cannot be fixed on this machine\n";
  const auto begin = std::chrono::steady_clock::now();
  while (replay.firstDifference() == 0 && replay.step()) continue;
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  if (replay.firstDifference() != 0) {
    out << "tick " << replay.firstDifference() << ": " << replay.differenceText()
        << " differs from the recording\n";
    if (!replay.failure().empty()) out << "the world " << replay.failure() << "\n";
    showDifference(replay, out);
    return false;
  }
  const double real = secondsOf(round, replay.tick());
  out << "verified ticks=" << replay.tick() << " seconds=" << std::fixed << std::setprecision(1) << real
      << " took=" << std::setprecision(3) << took.count() << " times_real_time=" << std::setprecision(0)
      << (took.count() > 0 ? real / took.count() : 0) << " protocol=" << kProtocolVersion << " read "
      << endText(replay.end()) << (replay.endReason().empty() ? "" : ": the game " + replay.endReason())
      << "\n";
  return true;
}

void printInputs(const RecordedRound& round, std::ostream& out) {
  const auto reader = round.read();
  std::uint32_t tick = 0;
  while (const auto record = reader->next()) {
    const auto* p_turn = std::get_if<WorldTurn>(&*record);
    if (p_turn == nullptr) continue;
    ++tick;
    for (const WorldInput& input : p_turn->inputs) {
      out << "tick=" << tick;
      printInput(input, out);
      out << "\n";
    }
    if (p_turn->ends_game) out << "tick=" << tick << " the host ends the game\n";
  }
  out << "ticks=" << tick << " read " << endText(reader->end())
      << (reader->endReason().empty() ? "" : ": the game " + reader->endReason()) << "\n";
}

bool printScores(const RecordedRound& round, const ReplayEnvironment& environment, std::ostream& out) {
  Replay replay(round, environment);
  replay.readScores();
  std::size_t count = 0;
  while (replay.firstDifference() == 0 && replay.step()) {
    for (const df::AddedScore& added : replay.scores()) {
      out << "tick=" << added.tick << " number=" << added.number << " table=" << safeText(added.table, 100)
          << " name=\"" << safeText(added.score.name, 100) << "\" points=" << added.score.points << "\n";
      ++count;
    }
  }
  if (replay.firstDifference() != 0) {
    out << "tick " << replay.firstDifference() << ": " << replay.differenceText()
        << " differs from the recording\n";
    return false;
  }
  out << "ticks=" << replay.tick() << " scores=" << count << " read " << endText(replay.end()) << "\n";
  return true;
}

bool printPicture(const RecordedRound& round, const ReplayEnvironment& environment, std::uint32_t tick,
                  std::uint32_t player, std::ostream& out) {
  Replay replay(round, environment);
  while (replay.tick() + 1 < tick) {
    if (!replay.step()) return false;
  }
  if (!replay.step(true)) return false;
  const df::Canvas* p_picture = findPicture(replay, player);
  if (p_picture == nullptr) return false;
  for (int y = 0; y < p_picture->height(); ++y) out << trimmed(p_picture->rowText(y)) << "\n";
  return true;
}

}  // namespace naiad

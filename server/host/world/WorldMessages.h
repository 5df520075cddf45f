// The messages between a host and a world in a process of its own, as frames (WorldFrame.h).
//
//   world → host   ready: the game's settings           once, when it has called GM.run()
//   host → world   turn: its record (TurnRecord.h); the world then ticks
//   world → host   answer: the result of the tick; each turn has one answer
//
// When the game is over, or the host has closed its end, the world's process closes its own end and exits.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/world/GameRoomTable.h"
#include "engine/world/HighScores.h"
#include "engine/world/ScoreTables.h"
#include "engine/world/WorldView.h"
#include "host/world/Determinism.h"
#include "host/world/ViewCodec.h"
#include "shared/net/base/Limits.h"
#include "shared/values/Canvas.h"

namespace naiad {

/// Settings of the game, for the players that will join.
struct WorldReady {
  int window_width = 80;
  int window_height = 24;
  int frame_millis = 33;  ///< frame time of df-config.txt in ms, at most kMaxFrameMillis
  bool compat = false;
  std::vector<std::string> help;     ///< at most kMaxHelpLines of kMaxHelpLength bytes
  std::vector<ReadFile> files = {};  ///< files read by the game so far, if it is to be repeatable
  bool fixed_addresses = false;      ///< the world's process has fixed addresses (FixedAddresses.h)
  bool runs_empty = false;           ///< true if the world ticks even without players
};
inline constexpr int kMaxFrameMillis = 1000;

/// The picture of one player.
struct WorldPicture {
  std::uint32_t player = 0;
  df::Canvas canvas;
};

/// The result of a tick.
struct WorldAnswer {
  bool game_over = false;
  std::vector<std::uint32_t> leavers;
  bool has_view = false;
  std::optional<std::uint64_t> state_hash;  ///< df::hashState(), if the turn requested it
  std::vector<WorldPicture> pictures = {};  ///< sorted by player
  std::vector<df::AddedScore> scores = {};  ///< at most HighScoreLimits::kMaxAddedInTick
  std::vector<df::RoomTransfer> sent = {};  ///< at most GameRoomLimits::kMaxSentInTick
  std::uint64_t hash = 0;                   ///< hash of the answer's bytes, set by the reader; 0: none
};

// Writers fill `frame` with a whole frame; writeAnswer() returns false if it would be too long. Readers
// return nullopt if a field is missing or out of range; readReady() and readAnswer() also if bytes are left.

// Records (TurnRecord.h) use these functions, too.
template <class F, class Text, class Number>
void visitScore(F& f, Text& table, Text& name, Number& points) {
  f.text(table, df::HighScoreLimits::kMaxTableName);
  f.text(name, kMaxNameBytes);
  f.number(points, -df::HighScoreLimits::kMaxPoints, df::HighScoreLimits::kMaxPoints);
}
void visitPicture(FieldWriter& out, const df::Canvas& canvas);
void visitPicture(FieldReader& in, df::Canvas& canvas);

/// Writes the ready message, which begins with the build id of its writer.
void writeReady(const WorldReady& ready, std::string& frame);
/// Returns the build id (BuildId.h) of the world that sent a ready message. If it is another build, nothing
/// else of its frames can be read, because their format may differ.
std::optional<std::string> readBuild(std::string_view fields);
/// Returns nullopt also for a message of another build.
std::optional<WorldReady> readReady(std::string_view fields);

/// Writes an answer. `p_view`: the tick's view; null: the answer has none.
bool writeAnswer(const WorldAnswer& answer, const df::WorldView* p_view, ViewWriter& views,
                 std::string& frame);
/// Reads an answer. Fills `view` if the answer has one.
std::optional<WorldAnswer> readAnswer(std::string_view fields, ViewReader& views, df::WorldView& view);
/// Like readAnswer(), without the view, which is not checked.
std::optional<WorldAnswer> readAnswerHead(std::string_view fields);

}  // namespace naiad

// The messages between a host and a world in a process of its own, as frames (WorldFrame.h).
//
//   world → host   ready: what the game has set up      once, when it has come to GM.run()
//   host → world   turn: its record, and tick (TurnRecord.h)
//   world → host   answer: how the tick ended; a turn has one answer
//
// When the game is over, the world's process closes its end and exits; so it does when the host closes its
// own.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/world/HighScores.h"
#include "engine/world/RoomTable.h"
#include "engine/world/ScoreTables.h"
#include "engine/world/WorldView.h"
#include "host/world/Repeatable.h"
#include "host/world/ViewCodec.h"
#include "shared/net/base/Limits.h"
#include "shared/values/Canvas.h"

namespace naiad {

/// What the game has set up for players who join.
struct WorldReady {
  int window_width = 80;
  int window_height = 24;
  int frame_millis = 33;  ///< as df-config.txt writes it, up to kMaxFrameMillis
  bool compat = false;
  std::vector<std::string> help;  ///< at most kMaxHelpLines of kMaxHelpLength bytes
  std::vector<ReadFile> files;    ///< that the game has read so far, if it is to be repeatable
  bool fixed_addresses = false;   ///< of this process (FixedStart.h)
  bool runs_empty = false;        ///< it ticks without players, too
};
inline constexpr int kMaxFrameMillis = 1000;

/// What one player sees.
struct WorldPicture {
  std::uint32_t player = 0;
  df::Canvas canvas;
};

/// How a tick ended.
struct WorldAnswer {
  bool game_over = false;
  std::vector<std::uint32_t> leavers;
  bool has_view = false;
  std::optional<std::uint64_t> state_hash;  ///< df::hashState(), if the turn asked for it
  std::vector<WorldPicture> pictures;       ///< by player
  std::vector<df::AddedScore> scores = {};  ///< at most HighScoreLimits::kMaxAddedInTick
  std::vector<df::SentPlayer> sent = {};    ///< at most GameRoomLimits::kMaxSentInTick
  std::uint64_t hash = 0;                   ///< of its bytes, for who has read them; 0: there is none
};

// Writers make `frame` a whole frame. False: it would be too long. Readers return nothing if anything is
// missing, out of range or left over.

// Parts of records (TurnRecord.h), too.
template <class F, class Text, class Number>
void visitScore(F& f, Text& table, Text& name, Number& points) {
  f.text(table, df::HighScoreLimits::kMaxTableName);
  f.text(name, kMaxNameBytes);
  f.number(points, -df::HighScoreLimits::kMaxPoints, df::HighScoreLimits::kMaxPoints);
}
void visitPicture(FieldWriter& out, const df::Canvas& canvas);
void visitPicture(FieldReader& in, df::Canvas& canvas);

/// It begins with the build that has written it.
void writeReady(const WorldReady& ready, std::string& frame);
/// Of which build (BuildId.h) the world is that has sent this. That alone may be read of another build: what
/// follows in its frames may be anything.
std::optional<std::string> readBuild(std::string_view fields);
std::optional<WorldReady> readReady(std::string_view fields);

/// `p_view` if the answer has one.
bool writeAnswer(const WorldAnswer& answer, const df::WorldView* p_view, ViewWriter& views,
                 std::string& frame);
/// `view` is filled if the answer has one.
std::optional<WorldAnswer> readAnswer(std::string_view fields, ViewReader& views, df::WorldView& view);
/// The same without the view, of which nothing is checked.
std::optional<WorldAnswer> readAnswerHead(std::string_view fields);

}  // namespace naiad

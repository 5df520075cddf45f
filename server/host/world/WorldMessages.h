// The messages between a host and a world in a process of its own, as frames (WorldFrame.h).
//
//   world → host   ready: what the game has set up      once, when it has come to GM.run()
//   host → world   turn: inputs, and tick
//   world → host   answer: how the tick ended; a turn has one answer, and no turn is sent before it
//
// When the game is over, the world's process closes its end and exits; so it does when the host closes its
// own.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/world/InputQueue.h"
#include "engine/world/RoomTable.h"
#include "engine/world/ScoreTables.h"
#include "engine/world/WorldView.h"
#include "host/world/Repeatable.h"
#include "host/world/ViewCodec.h"
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
};
inline constexpr int kMaxFrameMillis = 1000;

/// Inputs, and a tick.
struct WorldTurn {
  std::vector<df::InputQueue::Input> inputs;  ///< in the order they came
  bool watched = false;                       ///< the answer is to have a view
  bool wants_truth = false;                   ///< and pictures
  bool ends_game = false;
  bool checked = false;            ///< the answer is to have a hash of the state
  bool copied = false;             ///< behind it a copy is to be made (WorldCopies.h)
  std::uint32_t heard_player = 0;  ///< only their input comes; 0: all players' does
  std::uint32_t pictured = 0;      ///< only their picture is wanted; 0: all players' are
};

/// The keys and clicks that wait for a world (WorldProcess::kMaxInputs), joins, leaves and scores.
inline constexpr std::size_t kMaxTurnInputs = std::size_t{1} << 16;

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
};

// Writers make `frame` a whole frame. False: it would be too long. Readers return nothing if anything is
// missing, out of range or left over.

// Parts of a turn, for those who keep it in another form.
void visitTurnInput(FieldWriter& out, const df::InputQueue::Input& input);
void visitTurnInput(FieldReader& in, df::InputQueue::Input& input);
void visitPicture(FieldWriter& out, const df::Canvas& canvas);
void visitPicture(FieldReader& in, df::Canvas& canvas);

/// It begins with the build that has written it.
void writeReady(const WorldReady& ready, std::string& frame);
/// Of which build (BuildId.h) the world is that has sent this. That alone may be read of another build: what
/// follows in its frames may be anything.
std::optional<std::string> readBuild(std::string_view fields);
std::optional<WorldReady> readReady(std::string_view fields);

bool writeTurn(const WorldTurn& turn, std::string& frame);
std::optional<WorldTurn> readTurn(std::string_view fields);

/// `p_view` if the answer has one.
bool writeAnswer(const WorldAnswer& answer, const df::WorldView* p_view, ViewWriter& views,
                 std::string& frame);
/// `view` is filled if the answer has one.
std::optional<WorldAnswer> readAnswer(std::string_view fields, ViewReader& views, df::WorldView& view);
/// The same without the view, of which nothing is checked.
std::optional<WorldAnswer> readAnswerHead(std::string_view fields);

}  // namespace naiad

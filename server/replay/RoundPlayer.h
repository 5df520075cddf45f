// Plays a round in the terminal: forwards at any speed, 5 s to and fro, with the eyes of any player.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "client/terminal/InputDecoder.h"
#include "client/terminal/Picture.h"
#include "server/replay/Replay.h"

namespace naiad {

/// The pictures of a round by tick, forwards and back: those of the last minute are kept, earlier ones made
/// again.
class PictureReel {
 public:
  /// Cells of all pictures that are kept: of one player in 80 by 24 for a minute and more.
  static constexpr std::size_t kMaxCells = std::size_t{4} << 20;
  /// Ticks before a wanted one whose pictures are made as well, to go back to.
  static constexpr std::uint32_t kLead = 150;

  /// Both outlive it. Throws as Replay.
  PictureReel(const RecordedRound& round, const RoundStage& stage);

  /// Go to this tick, from 1; to the last one that there is if the round ends before. Return where it is; 0:
  /// it has no tick. Far back it executes the round from its beginning.
  std::uint32_t seek(std::uint32_t tick);
  std::uint32_t tick() const { return m_tick; }
  /// What players see after that tick, by player. Those of a tick without players: none.
  const std::vector<WorldPicture>& pictures() const;
  /// Ticks of the whole round.
  std::uint32_t count() const { return m_count; }
  /// The first tick so far that was other than recorded; 0: none.
  std::uint32_t firstDifference() const { return m_replay->firstDifference(); }

 private:
  struct Frame {
    std::uint32_t tick = 0;
    std::vector<WorldPicture> pictures;
  };
  const Frame* find(std::uint32_t tick) const;
  void executeTo(std::uint32_t tick);
  void keep();

  const RecordedRound& m_round;
  const RoundStage& m_stage;
  std::unique_ptr<Replay> m_replay;
  std::deque<Frame> m_frames;  ///< without gaps
  std::size_t m_cells = 0;
  std::uint32_t m_tick = 0;
  std::uint32_t m_count = 0;
};

/// What the keys do, without a terminal: time is passed in.
class RoundControls {
 public:
  using Time = std::chrono::steady_clock::time_point;

  static constexpr int kSlowest = -2;  ///< a quarter, as a power of two
  static constexpr int kFastest = 6;   ///< 64 times
  static constexpr std::uint64_t kJumpNanos = 5'000'000'000;

  /// `player`: whose eyes; 0: the first there is. Begins with tick `from`, or the last one before it.
  RoundControls(PictureReel& reel, std::uint64_t frame_nanos, std::uint32_t player, Time now,
                std::uint32_t from = 1);

  /// False: the player wants to end it.
  bool takeKey(const KeyEvent& key, Time now);
  /// Go on to where the round is at this time. True: the picture is another one.
  bool update(Time now);
  /// When update() will next have something to do.
  Time deadline(Time now) const;

  bool isPaused() const { return m_paused; }
  int speed() const { return m_speed; }
  std::uint32_t player() const { return m_player; }
  /// A picture of this size: the game, and a line that says where it is.
  Picture compose(int columns, int rows) const;

 private:
  void jump(std::int64_t ticks, Time now);
  void go(std::uint32_t tick, Time now);
  void changeSpeed(int by, Time now);
  void changeEyes();
  const WorldPicture* shown() const;
  std::string status() const;
  double ticksPerNano() const;

  PictureReel& m_reel;
  std::uint64_t m_frame_nanos;
  std::uint32_t m_player;
  bool m_paused = false;
  int m_speed = 0;
  Time m_since;  ///< when the round was at m_from
  std::uint32_t m_from = 1;
};

class RoundPlayer {
 public:
  /// As RoundControls.
  RoundPlayer(const RecordedRound& round, const RoundStage& stage, std::uint32_t player, std::uint32_t from)
      : m_round(round), m_stage(stage), m_player(player), m_from(from) {}
  /// Until a key or a signal ends it. Throws std::runtime_error with a sentence if the terminal cannot show
  /// it.
  void run();

  static bool hasTerminal();

 private:
  const RecordedRound& m_round;
  const RoundStage& m_stage;
  std::uint32_t m_player;
  std::uint32_t m_from;
};

}  // namespace naiad

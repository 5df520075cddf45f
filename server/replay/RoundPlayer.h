// Plays a round in the terminal: at 1/4 to 64 times its speed, with jumps of 5 s, as seen by any player.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "client/terminal/InputDecoder.h"
#include "client/terminal/ScreenBuffer.h"
#include "server/replay/Replay.h"

namespace naiad {

/// The pictures of a round, which can be requested in any order of their ticks. Keeps the pictures of about a
/// minute; makes earlier ones again by replaying the round.
class FrameHistory {
 public:
  /// Maximum cells of all kept pictures: enough for more than a minute of one player with 80 by 24 cells.
  static constexpr std::size_t kMaxCells = std::size_t{4} << 20;
  /// Number of ticks before a requested tick whose pictures are made as well, for rewinding.
  static constexpr std::uint32_t kRewindTicks = 150;

  /// `round` and `environment` must outlive this object. Throws what the constructor of Replay throws.
  FrameHistory(const RecordedRound& round, const ReplayEnvironment& environment);

  /// Moves to this tick (at least 1), or to the last one if the round ends before it. Returns the tick
  /// reached; 0 if the round has no ticks. To move far back, replays the round from its beginning.
  std::uint32_t seek(std::uint32_t tick);
  std::uint32_t tick() const { return m_tick; }
  /// Returns the players' pictures after tick(), in the order of the players; empty if there are no players.
  const std::vector<WorldPicture>& pictures() const;
  /// Returns the number of ticks of the whole round.
  std::uint32_t count() const { return m_count; }
  /// Returns the first tick so far that differed from the recording; 0: none.
  std::uint32_t firstDifference() const { return m_replay->firstDifference(); }

 private:
  struct Frame {
    std::uint32_t tick = 0;
    std::vector<WorldPicture> pictures;
  };
  const Frame* find(std::uint32_t tick) const;
  void executeTo(std::uint32_t tick);
  void storeFrame();

  const RecordedRound& m_round;
  const ReplayEnvironment& m_environment;
  std::unique_ptr<Replay> m_replay;
  std::deque<Frame> m_frames;  ///< pictures of consecutive ticks
  std::size_t m_cells = 0;
  std::uint32_t m_tick = 0;
  std::uint32_t m_count = 0;
};

/// The reaction of a RoundPlayer to keys, without a terminal. Time is passed in.
class RoundControls {
 public:
  using Time = std::chrono::steady_clock::time_point;

  static constexpr int kMinSpeed = -2;  ///< exponent of 2: a quarter of the normal speed
  static constexpr int kMaxSpeed = 6;   ///< exponent of 2: 64 times the normal speed
  static constexpr std::uint64_t kJumpNanos = 5'000'000'000;

  /// `player`: number of the player whose picture is shown; 0: the first player. Begins with tick `from`, or
  /// with the last tick if the round ends before it.
  RoundControls(FrameHistory& history, std::uint64_t frame_nanos, std::uint32_t player, Time now,
                std::uint32_t from = 1);

  /// Handles a key. Returns false if the key ends the RoundPlayer.
  bool handleKey(const KeyEvent& key, Time now);
  /// Advances the round to this time. Returns true if the picture or the status line has changed.
  bool update(Time now);
  /// Returns the time at which to call update() again.
  Time deadline(Time now) const;

  bool isPaused() const { return m_paused; }
  int speed() const { return m_speed; }
  std::uint32_t player() const { return m_player; }
  /// Returns a picture of this size: the game, and a status line.
  ScreenBuffer compose(int columns, int rows) const;

 private:
  void jump(std::int64_t ticks, Time now);
  void seekTo(std::uint32_t tick, Time now);
  void changeSpeed(int by, Time now);
  void switchPlayer();
  const WorldPicture* shown() const;
  std::string status() const;
  double ticksPerNano() const;

  FrameHistory& m_history;
  std::uint64_t m_frame_nanos;
  std::uint32_t m_player;
  bool m_paused = false;
  int m_speed = 0;
  Time m_since;  ///< time at which the round was at m_from
  std::uint32_t m_from = 1;
};

class RoundPlayer {
 public:
  /// `player` and `from`: as for RoundControls.
  RoundPlayer(const RecordedRound& round, const ReplayEnvironment& environment, std::uint32_t player,
              std::uint32_t from)
      : m_round(round), m_environment(environment), m_player(player), m_from(from) {}
  /// Plays until a key or a signal ends it. Throws std::runtime_error with a sentence if the terminal cannot
  /// show pictures or the game does not run.
  void run();

  static bool hasTerminal();

 private:
  const RecordedRound& m_round;
  const ReplayEnvironment& m_environment;
  std::uint32_t m_player;
  std::uint32_t m_from;
};

}  // namespace naiad

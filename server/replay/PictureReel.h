// The pictures of a round by tick, forwards and back: those of the last minute are kept, earlier ones made
// again.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

#include "server/replay/Replay.h"

namespace naiad {

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

}  // namespace naiad

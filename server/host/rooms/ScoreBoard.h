// The interface through which rooms use the score tables of a host's games.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "engine/world/ScoreTables.h"
#include "host/rounds/Round.h"

namespace naiad {

/// Thread: the host's.
class ScoreBoard {
 public:
  using Tables = std::map<std::string, std::vector<df::HighScore>>;

  virtual ~ScoreBoard() = default;
  /// Returns the tables that a world of this game gets at its start. Valid until the next call of add().
  virtual const Tables& tables(const std::string& game) = 0;
  /// Adds scores from a world's round. The world may be an untrusted program, so all values are checked. A
  /// replayed round may report a score again; it counts once.
  virtual void add(const std::string& game, const RoundName& round,
                   const std::vector<df::AddedScore>& scores) = 0;
};

}  // namespace naiad

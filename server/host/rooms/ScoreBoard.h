// The tables of scores of a host's games, as rooms see them.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "engine/world/ScoreTables.h"
#include "host/rounds/Round.h"

namespace naiad {

/// On the host's thread.
class ScoreBoard {
 public:
  using Tables = std::map<std::string, std::vector<df::HighScore>>;

  virtual ~ScoreBoard() = default;
  /// What a world of this game is passed at its start. Valid until the next call of add().
  virtual const Tables& tables(const std::string& game) = 0;
  /// A world of this game has added these in its round. It may be a stranger's program: all is checked. Of a
  /// round that is executed again they may come again, and count once.
  virtual void add(const std::string& game, const RoundName& round,
                   const std::vector<df::AddedScore>& scores) = 0;
};

}  // namespace naiad

// The scores of a host's games, as one of its parts: what worlds begin with and add, and what is on disk.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "host/loop/HostPart.h"
#include "host/rooms/ScoreBoard.h"
#include "host/scores/ScoreKeeper.h"

namespace naiad {

/// On the host's thread.
class HostScores : public HostPart, public ScoreBoard {
 public:
  /// Gets each row that a world has added, before it is written, with the name of its game.
  using Observer = std::function<void(const ScoreRow& row, const std::string& game)>;

  explicit HostScores(const HostAccess& access);

  void setObserver(Observer observer) { m_observer = std::move(observer); }
  /// The tables of this game.
  ScoreKeeper& of(const std::string& game);

  const Tables& tables(const std::string& game) override { return of(game).tables(); }
  void add(const std::string& game, const RoundName& round,
           const std::vector<df::AddedScore>& scores) override;

  /// Opens the tables of all games that are played here: a tick should not wait for the disk.
  void begin() override;
  /// News of the file goes to the log, and what is counted to the host's counters.
  void tick(Clock::time_point now) override;
  void finish() override;

 private:
  HostAccess m_access;
  Observer m_observer;                                            ///< null: none
  std::map<std::string, std::unique_ptr<ScoreKeeper>> m_keepers;  ///< by game
};

}  // namespace naiad

// The host part for scores: gives worlds their tables, collects the scores they add, and saves them.
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

/// Thread: the host's.
class HostScores : public HostPart, public ScoreBoard {
 public:
  /// Called for each row that a world has added, before it is written, with the name of the game.
  using Observer = std::function<void(const ScoreRow& row, const std::string& game)>;

  explicit HostScores(const HostAccess& access);

  void setObserver(Observer observer) { m_observer = std::move(observer); }
  /// Returns the score tables of this game. Opens them on the first call.
  ScoreKeeper& of(const std::string& game);

  const Tables& tables(const std::string& game) override { return of(game).tables(); }
  void add(const std::string& game, const RoundName& round,
           const std::vector<df::AddedScore>& scores) override;

  /// Opens the tables of all games played here, so that no tick has to wait for the disk.
  void begin() override;
  /// Logs the keepers' messages and updates the host's counters.
  void tick(Clock::time_point now) override;
  void finish() override;

 private:
  HostAccess m_access;
  Observer m_observer;                                            ///< null: none
  std::map<std::string, std::unique_ptr<ScoreKeeper>> m_keepers;  ///< key: game
};

}  // namespace naiad

// Replays the round of a killed server: provides the turns for the new world, and compares its answers with
// the recorded results.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host/journal/UnfinishedRound.h"
#include "host/world/TurnRecord.h"

namespace naiad {

class RoundRecovery {
 public:
  explicit RoundRecovery(std::shared_ptr<const UnfinishedRound> round);

  /// True at the last turn, or after it, if the file lacks its result and all earlier results matched.
  bool isAtUnknownResult() const {
    return m_turns + 1 >= m_round->turns() && !m_round->hasLastResult() && !m_differs;
  }

  const UnfinishedRound& round() const { return *m_round; }
  /// Returns the progress in percent.
  int percent() const;

  /// Returns the next turn; nullopt after the last. Several may be taken before the first is answered.
  std::optional<SentTurn> nextTurn();
  /// Returns the number of turns that were taken and not yet answered.
  std::uint32_t unanswered() const { return static_cast<std::uint32_t>(m_results.size()); }
  /// Compares the answer to the oldest unanswered turn with the file. Returns the difference in words; empty
  /// if there is none, or if the file lacks the result.
  std::string compareResult(const WorldAnswer& answer);
  /// True if the file lacks the result of the turn compared last: the server was killed before recording it.
  bool isResultMissing() const { return m_result_missing; }
  /// Returns the number of turns that the world has answered.
  std::uint32_t turns() const { return m_turns; }

  /// Returns the turn that follows all turns of the file (UnfinishedRound::closingInputs). It is not watched,
  /// so that the next watched turn reports every Object as changed.
  WorldTurn closingTurn() const;
  /// Returns the sessions of players that may reconnect.
  std::vector<PersistedSession> sessions() const;

 private:
  static std::string findDifference(const TickResult& result, const WorldAnswer& answer);
  /// Returns the next record that belongs to a turn.
  std::optional<TurnRecord> nextRecord();

  std::shared_ptr<const UnfinishedRound> m_round;
  TurnRecordReader m_records;
  TurnRecordWriter m_writer;          ///< encodes turns for the world; no other records are sent to it
  std::optional<TurnRecord> m_ahead;  ///< record that was read while searching for a result
  /// Recorded results of the unanswered turns; nullopt: not in the file.
  std::deque<std::optional<TickResult>> m_results;
  std::uint32_t m_turns = 0;
  bool m_result_missing = false;
  bool m_differs = false;
};

}  // namespace naiad

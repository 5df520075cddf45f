// Which turns a world gets that goes on with the round of a server that was killed, and whether it answers
// as it did then.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host/journal/OpenRound.h"
#include "host/world/TurnRecord.h"

namespace naiad {

class RoundRecovery {
 public:
  explicit RoundRecovery(std::shared_ptr<const OpenRound> round);

  /// It is at the last one or has had it, the file does not say what came of it, and all before was the same.
  bool isAtUnknownResult() const {
    return m_turns + 1 >= m_round->turns() && !m_round->hasLastResult() && !m_differs;
  }
  /// It has had all of them.
  bool isAtEnd() const { return m_turns == m_round->turns(); }

  const OpenRound& round() const { return *m_round; }
  /// How far it is, in percent.
  int percent() const;

  /// The next turn of the file; nothing: there is none. Several may be taken before the first is answered.
  std::optional<SentTurn> nextTurn();
  /// Those that were taken and not answered.
  std::uint32_t unanswered() const { return static_cast<std::uint32_t>(m_results.size()); }
  /// Hold what came of the oldest turn that was not answered against the file. Return what is other, as
  /// words; empty: nothing is.
  std::string compareResult(const WorldAnswer& answer);
  /// The file does not say what came of that turn: the server was killed before it knew.
  bool isResultMissing() const { return m_result_missing; }
  /// Turns that the world has answered.
  std::uint32_t turns() const { return m_turns; }

  /// The turn behind all of them (OpenRound::closingInputs). It is not watched, so that the next one that is
  /// shows every Object again.
  WorldTurn closingTurn() const;
  /// Of the players who may come back.
  std::vector<KeptSession> sessions() const;

 private:
  static std::string findDifference(const TickResult& result, const WorldAnswer& answer);
  /// The next record that says something of a turn.
  std::optional<TurnRecord> nextRecord();

  std::shared_ptr<const OpenRound> m_round;
  TurnRecordReader m_records;
  TurnRecordWriter m_writer;          ///< for the world, which is sent nothing else of the file
  std::optional<TurnRecord> m_ahead;  ///< read while a result was looked for
  /// Of the turns that are not answered; nothing: the file does not say it.
  std::deque<std::optional<TickResult>> m_results;
  std::uint32_t m_turns = 0;
  bool m_result_missing = false;
  bool m_differs = false;
};

}  // namespace naiad

#include "host/journal/RoundRecovery.h"

#include <utility>

namespace naiad {

RoundRecovery::RoundRecovery(std::shared_ptr<const UnfinishedRound> round) : m_round(std::move(round)) {
  m_records.add(m_round->records());
  m_writer.repeatFlags();  // a copy of a world has seen other turns before
}

int RoundRecovery::percent() const {
  const std::uint64_t all = m_round->turns();
  return all == 0 ? 100 : static_cast<int>(std::uint64_t{100} * m_turns / all);
}

std::optional<TurnRecord> RoundRecovery::nextRecord() {
  if (m_ahead) return std::exchange(m_ahead, std::nullopt);
  while (auto record = m_records.next()) {
    if (!std::holds_alternative<RecordedPicture>(*record) &&
        !std::holds_alternative<PersistedSession>(*record))
      return record;
  }
  return std::nullopt;
}

std::optional<SentTurn> RoundRecovery::nextTurn() {
  while (auto record = nextRecord()) {
    auto* p_turn = std::get_if<WorldTurn>(&*record);
    if (p_turn == nullptr) continue;
    m_ahead = nextRecord();
    if (m_ahead && std::holds_alternative<InputsDropped>(*m_ahead)) {
      dropKeys(*p_turn);
      m_ahead.reset();
      m_ahead = nextRecord();
    }
    auto& result = m_results.emplace_back();
    if (m_ahead && std::holds_alternative<TickResult>(*m_ahead)) {
      result = std::get<TickResult>(*m_ahead);
      m_ahead.reset();
    }
    SentTurn turn{std::move(*p_turn), {}};
    m_writer.write(turn.turn, turn.record);
    return turn;
  }
  return std::nullopt;
}

std::string RoundRecovery::compareResult(const WorldAnswer& answer) {
  ++m_turns;
  const std::optional<TickResult> result = m_results.front();
  m_results.pop_front();
  m_result_missing = !result;
  std::string difference = result ? findDifference(*result, answer) : std::string();
  m_differs = m_differs || !difference.empty();
  return difference;
}

std::string RoundRecovery::findDifference(const TickResult& result, const WorldAnswer& answer) {
  if (result.game_over != answer.game_over)
    return answer.game_over ? "the game is over, but was not in the recorded round"
                            : "the game continues, but was over in the recorded round";
  if (result.state_hash && result.state_hash != answer.state_hash) return "the world's state is different";
  if (result.has_check && result.check != checkOf(answer.hash)) return "the world's output is different";
  return {};
}

WorldTurn RoundRecovery::closingTurn() const {
  WorldTurn turn;
  turn.inputs = m_round->closingInputs();
  turn.checked = true;
  turn.input_player = m_round->lastTurn().input_player;
  return turn;
}

std::vector<PersistedSession> RoundRecovery::sessions() const {
  std::vector<PersistedSession> sessions;
  for (const auto& [player, session] : m_round->sessions()) sessions.push_back(session);
  return sessions;
}

}  // namespace naiad

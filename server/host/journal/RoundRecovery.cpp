#include "host/journal/RoundRecovery.h"

#include <utility>

namespace naiad {

RoundRecovery::RoundRecovery(std::shared_ptr<const OpenRound> round)
    : m_round(std::move(round)), m_reader(m_round->read()) {}

int RoundRecovery::percent() const {
  const std::uint64_t all = m_round->turns();
  return all == 0 ? 100 : static_cast<int>(std::uint64_t{100} * m_turns / all);
}

std::optional<TurnRecord> RoundRecovery::nextRecord() {
  if (m_ahead) return std::exchange(m_ahead, std::nullopt);
  while (auto record = m_reader->next()) {
    if (!std::holds_alternative<RecordedPicture>(*record) && !std::holds_alternative<KeptSession>(*record))
      return record;
  }
  return std::nullopt;
}

std::optional<WorldTurn> RoundRecovery::nextTurn() {
  while (auto record = nextRecord()) {
    auto* p_turn = std::get_if<WorldTurn>(&*record);
    if (p_turn == nullptr) continue;
    ++m_turns;
    m_ahead = nextRecord();
    if (m_ahead && std::holds_alternative<InputsDropped>(*m_ahead)) {
      m_ahead.reset();
      dropKeys(*p_turn);
    }
    return std::move(*p_turn);
  }
  return std::nullopt;
}

std::string RoundRecovery::compareResult(const WorldPort& world) {
  auto record = nextRecord();
  const auto* p_result = record ? std::get_if<TickResult>(&*record) : nullptr;
  m_result_missing = p_result == nullptr;
  if (m_result_missing) {
    m_ahead = std::move(record);
    return {};
  }
  if (p_result->game_over != world.isGameOver())
    return world.isGameOver() ? "the game is over, and was not" : "the game goes on, and was over";
  if (p_result->state_hash && p_result->state_hash != world.stateHash())
    return "the state of the world is another one";
  if (p_result->has_check && p_result->check != checkOf(world.answerHash()))
    return "what the world answers is other than it was";
  return {};
}

WorldTurn RoundRecovery::closingTurn() const {
  WorldTurn turn;
  turn.inputs = m_round->closingInputs();
  turn.checked = true;
  turn.heard_player = m_round->lastTurn().heard_player;
  return turn;
}

std::vector<KeptSession> RoundRecovery::sessions() const {
  std::vector<KeptSession> sessions;
  for (const auto& [player, session] : m_round->sessions()) sessions.push_back(session);
  return sessions;
}

}  // namespace naiad

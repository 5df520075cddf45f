#include "server/replay/Replay.h"

#include <cstdio>
#include <utility>

#include "host/rounds/Journals.h"
#include "host/world/WorldProcess.h"
#include "shared/net/base/SafeText.h"

namespace naiad {

Replay::Replay(const RecordedRound& round, const RoundStage& stage)
    : m_reader(round.read()), m_world(stage.launcher(), stage.order()) {
  if (!m_world.ready())
    throw RoundError("The game " + m_world.failure() + " before it began. " +
                     safeText(m_world.printed(), 500));
  compareFiles(round);
  readAhead();
}

void Replay::compareFiles(const RecordedRound& round) {
  for (const ReadFile& file : m_world.ready()->files) {
    const std::string recorded = round.fact(kFactFile + file.name);
    char now[17];
    std::snprintf(now, sizeof now, "%016llx", static_cast<unsigned long long>(file.hash));
    if (recorded != now) m_other_files.push_back(file.name);
  }
}

// Sessions are for servers that go on with the round.
void Replay::readAhead() {
  do m_next = m_reader->next();
  while (m_next && std::holds_alternative<KeptSession>(*m_next));
}

bool Replay::nextTurn() {
  while (m_next && !std::holds_alternative<WorldTurn>(*m_next)) readAhead();
  if (!m_next) return false;
  m_turn = std::get<WorldTurn>(std::move(*m_next));
  readAhead();
  if (m_next && std::holds_alternative<InputsDropped>(*m_next)) {
    if (m_tick + 1 != m_kept_tick) dropKeys(m_turn);
    readAhead();
  }
  return true;
}

bool Replay::step(bool pictures) {
  if (!m_failure.empty() || !nextTurn()) return false;
  ++m_tick;
  m_differs = false;
  m_pictures.clear();
  m_scores.clear();
  m_recorded.reset();
  const bool exact = !pictures || (m_turn.wants_truth && m_turn.pictured == 0);
  WorldTurn turn = m_turn;
  if (!exact) {
    turn.wants_truth = true;
    turn.pictured = 0;
  }
  const auto answer = m_world.step(turn);
  if (!answer) {
    // The round ended so, too, if nothing came of this turn.
    if (m_next) {
      noteDifference("the world's end");
      m_failure = m_world.failure();
    }
    return false;
  }
  takeRest(*answer, exact);
  if (turn.wants_truth || m_reads_scores) {
    if (auto head = readAnswerHead(*answer)) {
      m_pictures = std::move(head->pictures);
      m_scores = std::move(head->scores);
    }
  }
  return true;
}

/// What the file has of this tick beside its turn.
void Replay::takeRest(std::string_view answer, bool exact) {
  for (; m_next && !std::holds_alternative<WorldTurn>(*m_next); readAhead()) {
    if (const auto* p_result = std::get_if<TickResult>(&*m_next)) compare(*p_result, answer, exact);
    if (auto* p_picture = std::get_if<RecordedPicture>(&*m_next)) m_recorded = std::move(*p_picture);
  }
}

void Replay::compare(const TickResult& result, std::string_view answer, bool exact) {
  if (exact && result.has_check && checkOf(hashAnswer(answer)) != result.check)
    noteDifference("what the world answers");
  if (!result.state_hash) return;
  const auto head = readAnswerHead(answer);
  if (!head || head->state_hash != result.state_hash) noteDifference("the state");
}

void Replay::noteDifference(const char* what) {
  m_differs = true;
  if (m_first_difference != 0) return;
  m_first_difference = m_tick;
  m_what_differs = what;
}

}  // namespace naiad

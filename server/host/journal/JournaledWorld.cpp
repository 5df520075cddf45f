#include "host/journal/JournaledWorld.h"

#include <algorithm>
#include <cassert>
#include <string_view>
#include <system_error>
#include <utility>

#include "host/journal/TurnRing.h"
#include "host/world/WorldProcess.h"

namespace naiad {

namespace {

using Input = df::InputQueue::Input;

}  // namespace

JournaledWorld::JournaledWorld(std::unique_ptr<WorldPort> world, Book book)
    : m_world(std::move(world)), m_book(std::move(book)) {
  if (m_book.recovery) m_writer = TurnRecordWriter(m_book.recovery->round().lastTurn());
  m_history = std::move(m_book.history);
  listenToWorld();
}

void JournaledWorld::listenToWorld() {
  m_world->setOnTick([this] {
    if (m_book.recovery) return endRepeatedTick();
    m_in_tick = false;
    storeResult();
    reportTick();
  });
}

JournaledWorld::~JournaledWorld() {
  finish("stopped");
}

// The world has a list of its own, with the same bound: what does not fit in one is in neither.
std::uint32_t JournaledWorld::addInput(Input input) {
  const bool lasts = input.kind != df::InputQueue::kKey && input.kind != df::InputQueue::kMouse;
  if (!lasts && m_turn.inputs.size() >= WorldProcess::kMaxInputs) return input.player;
  Input kept = input;
  const std::uint32_t player = isTakingOver() ? input.player : m_world->addInput(std::move(input));
  if (!m_goes_on) return player;
  kept.player = player;
  kept.seen.base -= m_later;
  kept.seen.drawn -= m_later;
  if (!isTakingOver()) noteInput(kept);
  m_turn.inputs.push_back(std::move(kept));
  return player;
}

void JournaledWorld::noteInput(const Input& input) {
  if (input.kind == df::InputQueue::kJoin) m_players.push_back(input.player);
  if (input.kind == df::InputQueue::kLeave) std::erase(m_players, input.player);
}

// While turns are repeated the world hears the players of those.
void JournaledWorld::setHeard(std::uint32_t player) {
  if (m_book.recovery) return;
  m_turn.heard_player = player;
  m_world->setHeard(player);
}

void JournaledWorld::endGame() {
  m_turn.ends_game = true;
  if (!isTakingOver()) m_world->endGame();
}

void JournaledWorld::setPictured(std::uint32_t player) {
  m_pictured = player;
  if (!isTakingOver()) m_world->setPictured(player);
}

void JournaledWorld::begin() {
  if (std::exchange(m_began, true)) return;
  m_later = m_world->nextTick() - 1;
  if (!m_book.late_facts) return;
  m_book.journal->addFacts(m_book.late_facts());
  m_book.writer->wake();  // a server that is killed within the first second knows them, too
}

void JournaledWorld::tick(bool watched, bool truth) {
  begin();
  ++m_ticks;
  m_in_tick = true;
  if (!m_goes_on) return m_world->tick(watched, truth);
  m_turn.watched = watched;
  m_turn.wants_truth = truth;
  m_turn.pictured = m_pictured;
  m_turn.checked = m_ticks % kHashTicks == 0;
  if (watched && m_ticks % kPictureTicks == kFirstPicture && !m_players.empty()) choosePicture();
  orderCopy();
  storeTurn();
  m_world->setChecked(m_turn.checked);
  truth = m_turn.wants_truth;
  m_sent = std::exchange(m_turn, WorldTurn());
  m_world->tick(watched, truth);
  m_world->setPictured(m_pictured);
}

// What the host wants to see anyway, or the player who has been here longest.
void JournaledWorld::choosePicture() {
  if (!m_turn.wants_truth) {
    m_turn.wants_truth = true;
    m_turn.pictured = m_players.front();
  }
  m_recorded = m_turn.pictured != 0 ? m_turn.pictured : m_players.front();
  m_world->setPictured(m_turn.pictured);
}

void JournaledWorld::storeTurn() {
  m_record.clear();
  if (!m_writer.write(m_turn, m_record)) {
    m_goes_on = false;  // nor does the world take such a turn
    return;
  }
  store();
}

void JournaledWorld::storeResult() {
  if (!m_goes_on) return;
  if (m_book.check) m_book.check->add(m_sent, m_world->answerHash(), m_world->view());
  TickResult result;
  const std::uint64_t hash = m_world->answerHash();
  result.has_check = hash != 0;
  result.check = checkOf(hash);
  result.game_over = m_world->isGameOver();
  result.state_hash = m_world->stateHash();
  m_record.clear();
  m_writer.write(result, m_record);
  if (const std::uint32_t player = std::exchange(m_recorded, 0); player != 0)
    m_writer.write(RecordedPicture{player, m_world->renderPlayer(player)}, m_record);
  store();
  if (m_copies.endTick(m_history.size())) m_writer.repeatFlags();
}

void JournaledWorld::store() {
  if (m_book.new_world && m_history.size() + m_record.size() <= kMaxHistory) {
    m_history += m_record;
  } else {
    m_history.clear();
    m_copies.clear();
    m_book.new_world = {};
  }
  m_goes_on = m_book.journal->add(m_record);
  if (m_goes_on && m_book.journal->isFilling()) m_book.writer->wake();
}

void JournaledWorld::checkProcess(std::uint32_t tick) {
  // The first tick of a round keeps its number, whichever world and server has it.
  const std::uint32_t first = m_began ? m_later + 1 : m_book.first_tick;
  m_world->checkProcess(m_book.recovery && first != 0 ? first : tick);
  if (m_book.recovery && !m_repeating && m_world->isReady()) {
    m_repeating = true;
    const std::string difference = m_book.find_difference ? m_book.find_difference() : std::string();
    begin();
    difference.empty() ? repeatTurns() : endRecovery(difference);
  }
  if (const auto end = m_world->end(); end && !m_unrecovered) {
    if (takeOver(*end)) return;
    if (m_book.recovery) endRecovery("the game " + end->text);
  }
  if (m_book.check && (!m_goes_on || !m_book.check->update())) m_book.check.reset();
  if (const auto problem = m_book.journal->takeProblem()) {
    m_goes_on = false;
    if (m_book.on_problem) m_book.on_problem(*problem);
  }
  if (const auto ended = end()) finish(ended->text);
}

void JournaledWorld::finish(const std::string& why) {
  if (m_book.writer == nullptr) return;
  m_goes_on = false;
  m_book.journal->finish(why);
  m_book.writer->wake();
  m_book.writer.reset();
}

// ---- a round of a server that was killed ------------------------------------------------------------------

// Until the sessions are there again: a client that comes before them would be a new player. While another
// world takes over, players may join and press keys as ever.
std::optional<int> JournaledWorld::recovering() const {
  if (m_sessions) return 100;
  return m_book.recovery && !isTakingOver() ? std::optional(m_book.recovery->percent()) : std::nullopt;
}

void JournaledWorld::noteSession(const KeptSession& session) {
  if (!m_goes_on || (m_book.recovery && !isTakingOver())) return;
  m_record.clear();
  m_writer.write(session, m_record);
  store();
}

// Several are under way at once: neither end waits for the other then. Behind the first one, for which a
// world has longer than for the others.
void JournaledWorld::repeatTurns() {
  const std::uint32_t limit = m_book.recovery->turns() == 0 ? 1 : m_world->turnsAhead();
  while (m_unanswered < limit) {
    const auto turn = m_book.recovery->nextTurn();
    if (!turn) break;
    ++m_unanswered;
    sendTurn(*turn);
  }
  if (m_unanswered == 0) closeRecovery();
}

// The one that the world is at.
std::uint32_t JournaledWorld::currentTick() const {
  return m_ticks - (std::max(m_unanswered, 1u) - 1);
}

void JournaledWorld::sendTurn(const WorldTurn& turn) {
  ++m_ticks;
  for (Input input : turn.inputs) {
    noteInput(input);
    input.seen.base += m_later;  // the world's own numbers are in the file
    input.seen.drawn += m_later;
    m_world->addInput(std::move(input));
  }
  m_world->setHeard(turn.heard_player);
  if (turn.ends_game) m_world->endGame();
  m_world->setPictured(turn.pictured);
  m_world->setChecked(turn.checked);
  m_world->tick(turn.watched, turn.wants_truth);
}

// A server that was killed may not have written the last ones. Those of a world before were taken from it.
void JournaledWorld::keepRepeatedScores() {
  if (isTakingOver()) return;
  const std::vector<df::AddedScore> scores = m_world->takeScores();
  m_scores.insert(m_scores.end(), scores.begin(), scores.end());
  if (m_scores.size() > kMaxScores) m_scores.erase(m_scores.begin(), m_scores.end() - kMaxScores);
}

std::vector<df::AddedScore> JournaledWorld::takeScores() {
  std::vector<df::AddedScore> scores = std::exchange(m_scores, {});
  const std::vector<df::AddedScore> last = m_world->takeScores();
  scores.insert(scores.end(), last.begin(), last.end());
  return scores;
}

RoundName JournaledWorld::roundName() const {
  return {uuidText(m_book.journal->header().uuid), m_book.recording};
}

// What was sent last may have no result in the file; that of the closing turn is stored as any other.
void JournaledWorld::endRepeatedTick() {
  keepRepeatedScores();
  if (m_closing) {
    storeResult();
    return endRecovery({});
  }
  const std::uint32_t tick = currentTick();
  --m_unanswered;
  const std::string difference = m_book.recovery->compareResult(*m_world);
  if (!m_book.recovery->isAtEnd()) m_world->takeLeavers();  // who have been dismissed
  if (!difference.empty() && m_by_copy) return m_world->giveUp("is other in tick " + std::to_string(tick));
  if (!difference.empty())
    return endRecovery("in tick " + std::to_string(m_book.recovery->turns()) + " " + difference);
  if (m_book.recovery->isResultMissing() && !isTakingOver()) storeResult();
  m_world->isGameOver() ? endRecovery({}) : repeatTurns();
}

// A world that takes over is then where its players are.
void JournaledWorld::closeRecovery() {
  if (isTakingOver()) return endTakeOver({});
  m_closing = true;
  m_turn = m_book.recovery->closingTurn();
  storeTurn();
  sendTurn(std::exchange(m_turn, WorldTurn()));
}

// Players who left or were led to other rooms while the round was played have gone.
void JournaledWorld::endRecovery(const std::string& problem) {
  if (isTakingOver()) return endTakeOver(problem);
  const auto recovery = std::move(m_book.recovery);
  m_sessions = recovery->sessions();
  m_world->takeLeavers();
  m_world->takeSent();
  if (m_on_repeated) std::exchange(m_on_repeated, {})();
  if (m_book.on_recovered) m_book.on_recovered(recovery->turns(), problem);
  if (problem.empty()) return;
  m_unrecovered = WorldEnd{WorldEnd::kNotRecovered, "could not go on: " + problem};
  finish(m_unrecovered->text);
  m_world->close();
}

// ---- a world that crashed or hangs ------------------------------------------------------------------------

// False: the round ends with it.
bool JournaledWorld::takeOver(const WorldEnd& end) {
  const bool failed = end.why == WorldEnd::kCrashed || end.why == WorldEnd::kHung;
  if (!failed || !m_book.new_world || !m_goes_on || !m_began) return false;
  const std::uint32_t tick = currentTick();
  if (m_by_copy && !m_book.recovery->isAtUnknownResult()) {
    say("a copy of the game's world " + end.text + " before it was where the world had been");
    return beginAgain(false);
  }
  const bool again = m_died_at && tick < *m_died_at + kSameDeath;
  // A server that goes on with a round knows no more than that the world had the last turn.
  const bool in_last_turn = m_book.recovery ? m_book.recovery->isAtUnknownResult() : m_in_tick;
  const bool goes_on = !again && (!m_book.recovery || in_last_turn);
  if (m_book.on_death) m_book.on_death(end, tick, goes_on);
  if (!goes_on) return false;
  m_died_at = tick;
  if (!m_book.recovery) {
    m_death = end;
    m_death_at = Clock::now();
    m_next_tick = m_world->nextTick();
    m_view = m_world->view();
  }
  return beginAgain(in_last_turn);
}

bool JournaledWorld::beginAgain(bool drops_keys) {
  if (drops_keys) {
    m_record.clear();
    m_writer.write(InputsDropped(), m_record);
    store();
  }
  if (!m_book.new_world) {  // the round has become too long by that
    m_death.reset();
    return false;
  }
  return repeatByCopy() || repeatByAnother();
}

bool JournaledWorld::repeatByCopy() {
  m_by_copy = false;
  const auto ticks = m_world->goOnWithCopy();
  if (!ticks) return false;
  const auto mark = m_copies.take(*ticks);
  assert(mark);  // one for each that there is
  prepareToRepeat(mark->records);
  m_by_copy = m_repeating = true;
  m_ticks = mark->ticks;
  m_players = mark->players;
  repeatTurns();
  return true;
}

bool JournaledWorld::repeatByAnother() {
  try {
    AnotherWorld another = m_book.new_world();
    m_world = std::move(another.world);
    m_on_repeated = std::move(another.on_repeated);
  } catch (const std::system_error&) {
    if (isTakingOver()) m_book.recovery.reset();  // that of a copy
    m_death.reset();
    return false;
  }
  listenToWorld();
  m_copies.clear();
  prepareToRepeat(0);
  return true;
}

/// With the turns behind so many bytes of records.
void JournaledWorld::prepareToRepeat(std::size_t records) {
  m_book.check.reset();
  m_book.find_difference = {};  // of the world before
  m_book.recovery = std::make_unique<RoundRecovery>(std::make_shared<const OpenRound>(
      m_book.journal->header(), std::string_view(m_history).substr(records)));
  m_ticks = m_unanswered = 0;
  m_players.clear();
  m_scores.clear();
  m_repeating = m_closing = false;
}

// What came meanwhile is in the next turn. A tick that the world before did not end ends now.
void JournaledWorld::endTakeOver(const std::string& problem) {
  const auto recovery = std::move(m_book.recovery);
  const TakeOver done{std::exchange(m_by_copy, false), recovery->turns()};
  if (!problem.empty()) {
    m_unrecovered = std::exchange(m_death, std::nullopt);
    m_unrecovered->text += ", and another world did not do the same (" + problem + ")";
    finish(m_unrecovered->text);
    return m_world->close();
  }
  if (m_on_repeated) std::exchange(m_on_repeated, {})();
  m_world->endRepetition();
  m_taken_over = done;
  if (m_book.on_taken_over)
    m_book.on_taken_over(done,
                         std::chrono::duration_cast<std::chrono::milliseconds>(Clock::now() - m_death_at));
  m_death.reset();
  m_view = {};
  const bool ends_tick = std::exchange(m_in_tick, false);
  if (ends_tick) storeResult();
  m_world->setPictured(m_pictured);
  if (m_turn.ends_game) m_world->endGame();
  for (Input input : m_turn.inputs) {
    noteInput(input);
    input.seen.base += m_later;
    input.seen.drawn += m_later;
    m_world->addInput(std::move(input));
  }
  if (ends_tick) reportTick();
}

// ---- copies -----------------------------------------------------------------------------------------------

void JournaledWorld::orderCopy() {
  if (!m_book.new_world || !m_copies.isDue(m_ticks, [this] { return m_world->cpuTime(); })) return;
  m_copies.beginTick(m_ticks, m_players, m_world->keepCopy());
  if (const auto problem = m_world->takeCopyProblem())
    say("of this game's world no copies are kept: " + *problem);
}

void JournaledWorld::say(const std::string& sentence_of_copies) const {
  if (m_book.on_copies) m_book.on_copies(sentence_of_copies);
}

}  // namespace naiad

#include "host/rounds/Round.h"

#include <algorithm>
#include <cassert>
#include <string_view>
#include <system_error>
#include <utility>

#include "host/journal/Journal.h"
#include "host/journal/JournalWriter.h"
#include "host/journal/RepeatCheck.h"
#include "host/journal/RoundRecovery.h"
#include "host/world/WorldProcess.h"

namespace naiad {

namespace {

using Input = df::InputQueue::Input;

}  // namespace

Round::Round(Book book)
    : m_book(std::move(book)), m_goes_on(m_book.journal != nullptr), m_history(std::move(m_book.history)) {
  if (m_book.journal) m_name = {uuidText(m_book.journal->header().uuid), m_book.recording};
  if (m_book.recovery) m_writer = TurnRecordWriter(m_book.recovery->round().lastTurn());
}

Round::Round(std::unique_ptr<WorldPort> world) : Round(std::move(world), Book()) {}

Round::Round(std::unique_ptr<WorldProcess> world) : Round(std::move(world), Book()) {}

Round::Round(std::unique_ptr<WorldPort> world, Book book) : Round(std::move(book)) {
  adopt(std::move(world));
}

Round::Round(std::unique_ptr<WorldProcess> world, Book book) : Round(std::move(book)) {
  adopt(std::move(world));
}

Round::~Round() {
  finish("stopped");
}

void Round::adopt(std::unique_ptr<WorldProcess> world) {
  m_p_process = world.get();
  adopt(std::unique_ptr<WorldPort>(std::move(world)));
}

void Round::adopt(std::unique_ptr<WorldPort> world) {
  m_world = std::move(world);
  m_world->setOnTick([this] { endTick(); });
}

// ---- the next turn ----------------------------------------------------------------------------------------

void Round::addInput(Input input) {
  const bool lasts = input.kind != df::InputQueue::kKey && input.kind != df::InputQueue::kMouse;
  if (!lasts && m_turn.inputs.size() >= kMaxInputs) return;
  input.seen.base -= m_later;
  input.seen.drawn -= m_later;
  m_turn.inputs.push_back(std::move(input));
}

void Round::endGame() {
  m_turn.ends_game = true;
  if (m_p_process == nullptr) m_world->answer().game_over = true;
}

void Round::notePlayers(const WorldTurn& turn) {
  for (const Input& input : turn.inputs) {
    if (input.kind == df::InputQueue::kJoin) m_players.push_back(input.player);
    if (input.kind == df::InputQueue::kLeave) std::erase(m_players, input.player);
  }
}

void Round::begin() {
  if (std::exchange(m_began, true)) return;
  m_later = m_world->ticksBefore();
  if (!m_book.late_facts) return;
  m_book.journal->addFacts(m_book.late_facts());
  m_book.writer->wake();  // so that they survive if the server is killed within a second
}

void Round::tick(bool watched, bool truth, std::uint32_t pictured) {
  begin();
  m_in_tick = true;
  m_turn.watched = watched;
  m_turn.wants_truth = truth;
  m_turn.pictured = pictured;
  notePlayers(m_turn);
  ++m_ticks;
  if (m_p_process != nullptr) m_p_process->setImpatient(isImpatient());
  if (m_goes_on) {
    m_turn.checked = m_ticks % kHashTicks == 0;
    if (watched && m_ticks % kPictureTicks == kFirstPicture && !m_players.empty()) choosePicture();
    orderCopy();
  }
  sendTurn(std::exchange(m_turn, WorldTurn()));
}

// Chooses the picture that the host asked for, or that of the player who has been here longest.
void Round::choosePicture() {
  if (!m_turn.wants_truth) {
    m_turn.wants_truth = true;
    m_turn.pictured = m_players.front();
  }
  m_recorded = m_turn.pictured != 0 ? m_turn.pictured : m_players.front();
}

void Round::sendTurn(WorldTurn turn) {
  m_sent.turn = std::move(turn);
  m_sent.record.clear();
  // The world rejects a turn that is too long for a record, too.
  m_goes_on = m_writer.write(m_sent.turn, m_sent.record) && m_goes_on;
  if (m_goes_on) {
    m_book.journal->setCalm(m_players.empty());
    storeBytes(m_sent.record);
  }
  m_world->tick(m_sent);
}

// ---- results ----------------------------------------------------------------------------------------------

void Round::endTick() {
  if (m_p_process != nullptr && m_p_process->wasSlow()) noteSlowTick();
  if (m_book.recovery) return endRepeatedTick();
  m_in_tick = false;
  storeResult();
  if (m_on_tick) m_on_tick();
}

void Round::storeResult() {
  if (!m_goes_on) return;
  const WorldAnswer& answer = m_world->answer();
  if (m_book.check) m_book.check->add(m_sent, answer.hash, m_world->view());
  TickResult result;
  result.has_check = answer.hash != 0;
  result.check = checkOf(answer.hash);
  result.game_over = answer.game_over;
  result.state_hash = answer.state_hash;
  store(result);
  if (const std::uint32_t player = std::exchange(m_recorded, 0); player != 0)
    store(RecordedPicture{player, renderPlayer(player)});
  if (m_history.endTick()) m_writer.repeatFlags();
}

template <class Record>
void Round::store(const Record& record) {
  std::string bytes;
  m_writer.write(record, bytes);
  storeBytes(bytes);
}

void Round::storeBytes(std::string_view records) {
  if (m_book.new_world && !m_history.add(records)) m_book.new_world = {};
  m_goes_on = m_book.journal->add(records);
  if (m_goes_on && m_book.journal->isFilling()) m_book.writer->wake();
}

std::vector<df::AddedScore> Round::takeScores() {
  std::vector<df::AddedScore> scores = std::exchange(m_scores, {});
  const std::vector<df::AddedScore> last = std::exchange(m_world->answer().scores, {});
  scores.insert(scores.end(), last.begin(), last.end());
  return scores;
}

df::Canvas Round::renderPlayer(std::uint32_t player) const {
  for (const WorldPicture& picture : m_world->answer().pictures) {
    if (picture.player == player) return picture.canvas;
  }
  return {m_world->view().view_width, m_world->view().view_height};
}

// ---- checks -----------------------------------------------------------------------------------------------

void Round::checkProcess(std::uint32_t tick) {
  // The first tick of a round keeps its number in every world and server.
  const std::uint32_t first = m_began ? m_later + 1 : m_book.first_tick;
  m_world->checkProcess(m_book.recovery && first != 0 ? first : tick);
  if (m_book.recovery && !m_repeating && m_world->isReady()) beginRepetition();
  if (const auto end = m_world->end(); end && !m_unrecovered) {
    if (takeOver(*end)) return;
    if (m_book.recovery) endRecovery("the game " + end->text);
  }
  if (m_book.journal) checkJournal();
}

void Round::checkJournal() {
  if (m_book.check && (!m_goes_on || !m_book.check->update())) m_book.check.reset();
  if (const auto problem = m_book.journal->takeProblem()) {
    m_goes_on = false;
    if (m_book.on_problem) m_book.on_problem(*problem);
  }
  if (const auto ended = end()) finish(ended->text);
}

void Round::finish(const std::string& why) {
  if (m_book.writer == nullptr) return;
  m_goes_on = false;
  m_book.journal->finish(why);
  m_book.writer->wake();
  m_book.writer.reset();
}

std::optional<std::string> Round::takeWarning() {
  return m_p_process != nullptr ? m_p_process->takeWarning() : std::nullopt;
}

// ---- replay of a killed server's round --------------------------------------------------------------------

// Recovery ends when the sessions are restored, because a client that came before would be a new player.
// While another world takes over, players may join and press keys as usual.
std::optional<int> Round::recovering() const {
  if (m_sessions) return 100;
  return m_book.recovery && !isTakingOver() ? std::optional(m_book.recovery->percent()) : std::nullopt;
}

void Round::noteSession(const KeptSession& session) {
  if (m_goes_on && (!m_book.recovery || isTakingOver())) store(session);
}

void Round::beginRepetition() {
  m_repeating = true;
  const std::string difference = m_book.find_difference ? m_book.find_difference() : std::string();
  begin();
  difference.empty() ? repeatTurns() : endRecovery(difference);
}

// Sends several turns ahead, so that neither end waits for the other. The first one is sent alone, because
// its time limit is longer.
void Round::repeatTurns() {
  const std::uint32_t limit = m_book.recovery->turns() == 0 ? 1 : m_world->turnsAhead();
  while (m_book.recovery->unanswered() < limit) {
    const auto turn = m_book.recovery->nextTurn();
    if (!turn) break;
    ++m_ticks;
    notePlayers(turn->turn);
    m_world->tick(*turn);
  }
  if (m_book.recovery->unanswered() == 0) closeRecovery();
}

// Returns the tick that the world is in.
std::uint32_t Round::currentTick() const {
  const std::uint32_t unanswered = m_book.recovery ? m_book.recovery->unanswered() : 0;
  return m_ticks - (std::max(unanswered, 1u) - 1);
}

// A killed server may not have stored the last scores; in a takeover they were taken before.
void Round::keepRepeatedScores() {
  if (isTakingOver()) return;
  m_scores = takeScores();
  if (m_scores.size() > kMaxScores) m_scores.erase(m_scores.begin(), m_scores.end() - kMaxScores);
}

// Stores the result of the last turn, which may be missing in the file, and that of the closing turn.
void Round::endRepeatedTick() {
  keepRepeatedScores();
  if (m_closing) {
    storeResult();
    return endRecovery({});
  }
  const std::uint32_t tick = currentTick();
  const std::string difference = m_book.recovery->compareResult(m_world->answer());
  if (!difference.empty() && m_by_copy) return m_p_process->giveUp("differs in tick " + std::to_string(tick));
  if (!difference.empty())
    return endRecovery("in tick " + std::to_string(m_book.recovery->turns()) + " " + difference);
  if (m_book.recovery->isResultMissing() && !isTakingOver()) storeResult();
  m_world->answer().game_over ? endRecovery({}) : repeatTurns();
}

// A world that takes over needs no closing turn, because its players are still connected.
void Round::closeRecovery() {
  if (isTakingOver()) return endTakeOver({});
  m_closing = true;
  ++m_ticks;
  WorldTurn turn = m_book.recovery->closingTurn();
  notePlayers(turn);
  sendTurn(std::move(turn));
}

// Drops requests to leave or change rooms: the players of the replayed turns have left or moved already.
void Round::endRecovery(const std::string& problem) {
  if (isTakingOver()) return endTakeOver(problem);
  const auto recovery = std::move(m_book.recovery);
  m_sessions = recovery->sessions();
  takeLeavers();
  takeSent();
  if (m_p_process != nullptr) m_p_process->endRepetition();
  if (m_book.on_recovered) m_book.on_recovered(recovery->turns(), problem);
  if (problem.empty()) return;
  m_unrecovered = WorldEnd{WorldEnd::kNotRecovered, "could not be recovered: " + problem};
  finish(m_unrecovered->text);
  close();
}

// ---- a world that crashed or hangs ------------------------------------------------------------------------

// Returns false if the round ends with its world.
bool Round::takeOver(const WorldEnd& end) {
  const bool failed = end.why == WorldEnd::kCrashed || end.why == WorldEnd::kHung;
  if (!failed || !m_book.new_world || !m_goes_on || !m_began) return false;
  if (end.why == WorldEnd::kHung) noteHang();
  const std::uint32_t tick = currentTick();
  if (m_by_copy && !m_book.recovery->isAtUnknownResult()) {
    say("a copy of the game's world " + end.text + " before it had caught up");
    return beginAgain(false);
  }
  const bool again = m_died_at && tick < *m_died_at + kSameDeath;
  // After a server's crash it is only known that the world had got the last turn.
  const bool in_last_turn = m_book.recovery ? m_book.recovery->isAtUnknownResult() : m_in_tick;
  const bool goes_on = !again && (!m_book.recovery || in_last_turn);
  if (m_book.on_death) m_book.on_death(end, tick, goes_on);
  if (!goes_on) return false;
  m_died_at = tick;
  if (!m_book.recovery) m_death = Death{end, Clock::now(), m_world->nextTick(), m_world->view()};
  return beginAgain(in_last_turn);
}

// False if the round would end with the tick: then the tick gets the full limit.
bool Round::isImpatient() const {
  const bool is_followed = m_goes_on && m_book.new_world && !(m_died_at && m_ticks < *m_died_at + kSameDeath);
  return is_followed && (m_hangs == Hangs::kUnknown || m_hangs == Hangs::kReal);
}

void Round::noteHang() {
  m_hangs = m_hangs == Hangs::kUnknown ? Hangs::kOneEnded : Hangs::kReal;
}

// The first tick does not count, because games load in it.
void Round::noteSlowTick() {
  if (currentTick() > 1 && std::exchange(m_hangs, Hangs::kSlow) != Hangs::kSlow)
    say("slow tick " + std::to_string(m_later + currentTick()) +
        " finished: from now on, ticks of this round get " + std::to_string(WorldProcess::kPatience) +
        " times as long before they count as hung");
}

bool Round::beginAgain(bool drops_keys) {
  if (drops_keys) store(InputsDropped());
  if (!m_book.new_world) {  // that has made the round too long
    m_death.reset();
    return false;
  }
  return repeatByCopy() || repeatByAnother();
}

bool Round::repeatByCopy() {
  m_by_copy = false;
  const auto ticks = m_p_process->goOnWithCopy();
  if (!ticks) return false;
  const auto mark = m_history.takeCopy(*ticks);
  assert(mark);  // each copy has a mark
  prepareToRepeat(mark->records);
  m_by_copy = m_repeating = true;
  m_ticks = mark->ticks;
  m_players = mark->players;
  repeatTurns();
  return true;
}

bool Round::repeatByAnother() {
  try {
    if (!m_history.hasBeginning()) throw std::system_error(std::make_error_code(std::errc::value_too_large));
    adopt(m_book.new_world());
  } catch (const std::system_error&) {
    if (isTakingOver()) m_book.recovery.reset();  // the copy's
    m_death.reset();
    return false;
  }
  m_history.dropCopies();
  prepareToRepeat(0);
  return true;
}

/// Prepares the replay of the turns after this many bytes of records.
void Round::prepareToRepeat(std::size_t records) {
  m_book.check.reset();
  m_book.find_difference = {};  // belongs to the previous world
  m_book.recovery = std::make_unique<RoundRecovery>(std::make_shared<const OpenRound>(
      m_book.journal->header(), std::string_view(m_history.records()).substr(records)));
  m_ticks = 0;
  m_players.clear();
  m_scores.clear();
  m_repeating = m_closing = false;
}

// Input of the meantime is in the next turn. A tick that the previous world did not end ends now.
void Round::endTakeOver(const std::string& problem) {
  const auto recovery = std::move(m_book.recovery);
  const TakeOver done{std::exchange(m_by_copy, false), recovery->turns()};
  const Death death = *std::exchange(m_death, std::nullopt);
  if (!problem.empty()) {
    m_unrecovered = death.end;
    m_unrecovered->text += ", and its replay gave a different result (" + problem + ")";
    finish(m_unrecovered->text);
    return close();
  }
  m_p_process->endRepetition();
  m_taken_over = done;
  if (m_book.on_taken_over)
    m_book.on_taken_over(done,
                         std::chrono::duration_cast<std::chrono::milliseconds>(Clock::now() - death.at));
  if (!std::exchange(m_in_tick, false)) return;
  storeResult();
  if (m_on_tick) m_on_tick();
}

// ---- copies -----------------------------------------------------------------------------------------------

void Round::dropCopies() {
  if (m_p_process == nullptr || !m_history.hasBeginning()) return;
  m_p_process->dropCopies();
  m_history.dropCopies();
}

void Round::orderCopy() {
  if (!m_book.new_world || !m_p_process->canKeepCopy()) return;
  if (!m_history.isCopyDue(m_ticks, [this] { return m_p_process->cpuTime(); })) return;
  m_history.beginCopy(m_ticks, m_players, m_p_process->keepCopy());
  if (const auto problem = m_p_process->takeCopyProblem())
    say("no copies of this game's world are kept: " + *problem);
}

void Round::say(const std::string& sentence_of_copies) const {
  if (m_book.on_copies) m_book.on_copies(sentence_of_copies);
}

}  // namespace naiad

#include "host/rounds/Round.h"

#include <algorithm>
#include <cassert>
#include <string_view>
#include <system_error>
#include <utility>

#include "host/journal/DeterminismCheck.h"
#include "host/journal/Journal.h"
#include "host/journal/JournalWriter.h"
#include "host/journal/RoundRecovery.h"
#include "host/world/WorldProcess.h"

namespace naiad {

namespace {

using Input = df::InputQueue::Input;

}  // namespace

Round::Round(std::unique_ptr<WorldPort> world, JournalBinding book)
    : m_binding(std::move(book)),
      m_is_recording(m_binding.journal != nullptr),
      m_history(std::move(m_binding.history)) {
  adopt(std::move(world));
  if (m_binding.journal) m_name = {uuidText(m_binding.journal->header().uuid), m_binding.recording};
  if (!m_binding.recovery) return;
  m_writer = TurnRecordWriter(m_binding.recovery->round().lastTurn());
  m_highest_player = m_binding.recovery->round().highestPlayer();
}

Round::Round(std::unique_ptr<WorldPort> world, std::uint32_t highest_player)
    : Round(std::move(world), JournalBinding()) {
  m_highest_player = highest_player;
}

Round::~Round() {
  finish("stopped");
}

void Round::adopt(std::unique_ptr<WorldPort> world) {
  m_world = std::move(world);
  m_p_process = dynamic_cast<WorldProcess*>(m_world.get());
  m_world->setOnTick([this] { endTick(); });
}

// ---- the next turn ----------------------------------------------------------------------------------------

void Round::addInput(Input input) {
  const bool lasts = input.kind != df::InputQueue::kKey && input.kind != df::InputQueue::kMouse;
  if (!lasts && m_turn.inputs.size() >= kMaxInputs) return;
  if (input.kind == df::InputQueue::kJoin) m_highest_player = std::max(m_highest_player, input.player);
  input.seen.base -= m_tick_offset;
  input.seen.drawn -= m_tick_offset;
  m_turn.inputs.push_back(std::move(input));
}

void Round::endGame() {
  m_turn.ends_game = true;
  if (m_p_process == nullptr) m_world->answer().game_over = true;
}

void Round::updatePlayers(const WorldTurn& turn) {
  for (const Input& input : turn.inputs) {
    if (input.kind == df::InputQueue::kJoin) m_players.push_back(input.player);
    if (input.kind == df::InputQueue::kLeave) std::erase(m_players, input.player);
  }
}

void Round::begin() {
  if (std::exchange(m_began, true)) return;
  m_tick_offset = m_world->ticksBefore();
  if (!m_binding.late_facts) return;
  m_binding.journal->addFacts(m_binding.late_facts());
  m_binding.writer->wake();  // so that the facts survive if the server is killed within a second
}

void Round::tick(bool watched, bool truth, std::uint32_t rendered_player) {
  begin();
  m_in_tick = true;
  m_turn.watched = watched;
  m_turn.wants_truth = truth;
  m_turn.rendered_player = rendered_player;
  updatePlayers(m_turn);
  ++m_ticks;
  if (m_p_process != nullptr) m_p_process->setFastFailover(usesFastFailover());
  if (m_is_recording) {
    m_turn.checked = m_ticks % kHashTicks == 0;
    if (watched && m_ticks % kPictureTicks == kFirstPicture && !m_players.empty()) choosePicture();
    requestCheckpoint();
  }
  sendTurn(std::exchange(m_turn, WorldTurn()));
}

// Chooses the picture that the host asked for, or else that of the player who has been in the world longest.
void Round::choosePicture() {
  if (!m_turn.wants_truth) {
    m_turn.wants_truth = true;
    m_turn.rendered_player = m_players.front();
  }
  m_recorded = m_turn.rendered_player != 0 ? m_turn.rendered_player : m_players.front();
}

void Round::sendTurn(WorldTurn turn) {
  m_sent.turn = std::move(turn);
  m_sent.record.clear();
  // A world in a process rejects a turn that is too long for a record, too.
  m_is_recording = m_writer.write(m_sent.turn, m_sent.record) && m_is_recording;
  if (m_is_recording) {
    m_binding.journal->setIdle(m_players.empty());
    storeBytes(m_sent.record);
  }
  m_world->tick(m_sent);
}

// ---- results ----------------------------------------------------------------------------------------------

void Round::endTick() {
  if (m_p_process != nullptr && m_p_process->wasTickSlow()) onSlowTick();
  if (m_binding.recovery) return endReplayedTick();
  m_in_tick = false;
  storeResult();
  if (m_on_tick) m_on_tick();
}

void Round::storeResult() {
  if (!m_is_recording) return;
  const WorldAnswer& answer = m_world->answer();
  if (m_binding.check) m_binding.check->add(m_sent, answer.hash, m_world->view());
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
  if (m_binding.new_world && !m_history.add(records)) m_binding.new_world = {};
  m_is_recording = m_binding.journal->add(records);
  if (m_is_recording && m_binding.journal->isFilling()) m_binding.writer->wake();
}

std::vector<df::AddedScore> Round::popScores() {
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
  const std::uint32_t first = m_began ? m_tick_offset + 1 : m_binding.first_tick;
  m_world->checkProcess(m_binding.recovery && first != 0 ? first : tick);
  if (m_binding.recovery && !m_replaying && m_world->isReady()) beginReplay();
  if (const auto end = m_world->end(); end && !m_unrecovered) {
    if (startFailover(*end)) return;
    if (m_binding.recovery) endRecovery("the game " + end->text);
  }
  if (m_binding.journal) checkJournal();
}

void Round::checkJournal() {
  if (m_binding.check && (!m_is_recording || !m_binding.check->update())) m_binding.check.reset();
  if (const auto problem = m_binding.journal->popProblem()) {
    m_is_recording = false;
    if (m_binding.on_problem) m_binding.on_problem(*problem);
  }
  if (const auto ended = end()) finish(ended->text);
}

void Round::finish(const std::string& why) {
  if (m_binding.writer == nullptr) return;
  m_is_recording = false;
  m_binding.journal->finish(why);
  m_binding.writer->wake();
  m_binding.writer.reset();
}

std::optional<std::string> Round::popWarning() {
  return m_p_process != nullptr ? m_p_process->popWarning() : std::nullopt;
}

// ---- replay of a killed server's round --------------------------------------------------------------------

// Recovery ends when the sessions are restored, because a client that joined before would be a new player.
// While another world takes over, players may join and press keys as usual.
std::optional<int> Round::recovering() const {
  if (m_sessions) return 100;
  return m_binding.recovery && !isFailingOver() ? std::optional(m_binding.recovery->percent()) : std::nullopt;
}

std::vector<PersistedSession> Round::awaitedSessions() const {
  const bool is_recovery = m_binding.recovery && !isFailingOver();
  return is_recovery ? m_binding.recovery->sessions() : m_sessions.value_or(std::vector<PersistedSession>());
}

void Round::recordSession(const PersistedSession& session) {
  if (m_is_recording && (!m_binding.recovery || isFailingOver())) store(session);
}

void Round::beginReplay() {
  m_replaying = true;
  const std::string difference = m_binding.find_difference ? m_binding.find_difference() : std::string();
  begin();
  difference.empty() ? replayTurns() : endRecovery(difference);
}

// Sends several turns ahead, so that neither process waits for the other. The first one is sent alone,
// because its time limit is longer.
void Round::replayTurns() {
  const std::uint32_t limit = m_binding.recovery->turns() == 0 ? 1 : m_world->turnsAhead();
  while (m_binding.recovery->unanswered() < limit) {
    const auto turn = m_binding.recovery->nextTurn();
    if (!turn) break;
    ++m_ticks;
    updatePlayers(turn->turn);
    m_world->tick(*turn);
  }
  if (m_binding.recovery->unanswered() == 0) closeRecovery();
}

// Returns the tick that the world is in.
std::uint32_t Round::currentTick() const {
  const std::uint32_t unanswered = m_binding.recovery ? m_binding.recovery->unanswered() : 0;
  return m_ticks - (std::max(unanswered, 1u) - 1);
}

// Keeps the scores of replayed turns, which a killed server may not have stored. In a failover, this server
// has them already.
void Round::collectReplayedScores() {
  if (isFailingOver()) return;
  m_scores = popScores();
  if (m_scores.size() > kMaxScores) m_scores.erase(m_scores.begin(), m_scores.end() - kMaxScores);
}

// Compares a replayed result with the file. Stores the last turn's, if missing there, and the closing turn's.
void Round::endReplayedTick() {
  collectReplayedScores();
  if (m_closing) {
    storeResult();
    return endRecovery({});
  }
  const std::uint32_t tick = currentTick();
  const std::string difference = m_binding.recovery->compareResult(m_world->answer());
  if (!difference.empty() && m_by_checkpoint)
    return m_p_process->markFailed("differs in tick " + std::to_string(tick));
  if (!difference.empty())
    return endRecovery("in tick " + std::to_string(m_binding.recovery->turns()) + " " + difference);
  if (m_binding.recovery->isResultMissing() && !isFailingOver()) storeResult();
  m_world->answer().game_over ? endRecovery({}) : replayTurns();
}

// A world that takes over needs no closing turn, because its players are still connected.
void Round::closeRecovery() {
  if (isFailingOver()) return finishFailover({});
  m_closing = true;
  ++m_ticks;
  WorldTurn turn = m_binding.recovery->closingTurn();
  updatePlayers(turn);
  sendTurn(std::move(turn));
}

// Drops requests to leave or change rooms: the players of the replayed turns have left or moved already.
void Round::endRecovery(const std::string& problem) {
  if (isFailingOver()) return finishFailover(problem);
  const auto recovery = std::move(m_binding.recovery);
  m_sessions = recovery->sessions();
  popLeavers();
  popSent();
  if (m_p_process != nullptr) m_p_process->endReplay();
  if (m_binding.on_recovered) m_binding.on_recovered(recovery->turns(), problem);
  if (problem.empty()) return;
  m_unrecovered = WorldEnd{WorldEnd::kNotRecovered, "could not be recovered: " + problem};
  finish(m_unrecovered->text);
  close();
}

// ---- a world that crashed or hangs ------------------------------------------------------------------------

// Lets another world take over after a crash or hang; the players stay connected. Returns false, and the
// round ends, if the world ended otherwise or had not begun, the round is not recorded or has no new_world,
// the last failure was less than kSameFailureTicks ago, no other world can start, or a world that replays a
// killed server's round failed before the last turn.
bool Round::startFailover(const WorldEnd& end) {
  const bool failed = end.why == WorldEnd::kCrashed || end.why == WorldEnd::kHung;
  if (!failed || !m_binding.new_world || !m_is_recording || !m_began) return false;
  if (isFailingOver() && !m_replaying && Clock::now() - m_failed_world->at < kRestartTime)
    return replayInNewWorld();
  if (end.why == WorldEnd::kHung) onHang();
  const std::uint32_t tick = currentTick();
  if (m_by_checkpoint && !m_binding.recovery->isAtUnknownResult()) {
    logCheckpoints("a copy of the game's world " + end.text + " before it had caught up");
    return replayFromStart(false);
  }
  const bool again = m_failed_at && tick < *m_failed_at + kSameFailureTicks;
  // After a server's crash it is only known that the world had got the last turn.
  const bool in_last_turn = m_binding.recovery ? m_binding.recovery->isAtUnknownResult() : m_in_tick;
  const bool goes_on = !again && (!m_binding.recovery || in_last_turn);
  if (m_binding.on_failure) m_binding.on_failure(end, tick, goes_on);
  if (!goes_on) return false;
  m_failed_at = tick;
  if (!m_binding.recovery)
    m_failed_world = FailedWorld{end, Clock::now(), m_world->nextTick(), m_world->view()};
  return replayFromStart(in_last_turn);
}

// Returns false if a hang would end the round, or ticks may just be slow: then the tick gets the full limit.
bool Round::usesFastFailover() const {
  const bool is_followed =
      m_is_recording && m_binding.new_world && !(m_failed_at && m_ticks < *m_failed_at + kSameFailureTicks);
  return is_followed && (m_hangs == Hangs::kUnknown || m_hangs == Hangs::kReal);
}

void Round::onHang() {
  m_hangs = m_hangs == Hangs::kUnknown ? Hangs::kOneEnded : Hangs::kReal;
}

// The first tick does not count, because games load files in it.
void Round::onSlowTick() {
  if (currentTick() > 1 && std::exchange(m_hangs, Hangs::kSlow) != Hangs::kSlow)
    logCheckpoints("slow tick " + std::to_string(m_tick_offset + currentTick()) +
                   " finished: from now on, ticks of this round get " +
                   std::to_string(WorldProcess::kAnswerTimeoutFactor) +
                   " times as long before they count as hung");
}

bool Round::replayFromStart(bool drops_keys) {
  if (drops_keys) store(InputsDropped());
  if (!m_binding.new_world) {  // this record has made the round too long
    m_failed_world.reset();
    return false;
  }
  return replayFromCheckpoint() || replayInNewWorld();
}

bool Round::replayFromCheckpoint() {
  m_by_checkpoint = false;
  const auto ticks = m_p_process->resumeFromCheckpoint();
  if (!ticks) return false;
  const auto mark = m_history.popCheckpoint(*ticks);
  assert(mark);  // each copy has a mark
  prepareReplay(mark->records);
  m_by_checkpoint = m_replaying = true;
  m_ticks = mark->ticks;
  m_players = mark->players;
  replayTurns();
  return true;
}

bool Round::replayInNewWorld() {
  try {
    if (!m_history.hasBeginning()) throw std::system_error(std::make_error_code(std::errc::value_too_large));
    adopt(m_binding.new_world());
  } catch (const std::system_error&) {
    if (isFailingOver()) m_binding.recovery.reset();  // the recovery of the copy
    m_failed_world.reset();
    return false;
  }
  m_history.dropCheckpoints();
  prepareReplay(0);
  return true;
}

/// Prepares the replay of the turns after this many bytes of records.
void Round::prepareReplay(std::size_t records) {
  m_binding.check.reset();
  m_binding.find_difference = {};  // belongs to the previous world
  m_binding.recovery = std::make_unique<RoundRecovery>(std::make_shared<const UnfinishedRound>(
      m_binding.journal->header(), std::string_view(m_history.records()).substr(records)));
  m_ticks = 0;
  m_players.clear();
  m_scores.clear();
  m_replaying = m_closing = false;
}

// Input received during the replay is in the next turn. A tick that the failed world did not finish ends now.
void Round::finishFailover(const std::string& problem) {
  const auto recovery = std::move(m_binding.recovery);
  const Failover done{std::exchange(m_by_checkpoint, false), recovery->turns()};
  const FailedWorld death = *std::exchange(m_failed_world, std::nullopt);
  if (!problem.empty()) {
    m_unrecovered = death.end;
    m_unrecovered->text += ", and its replay gave a different result (" + problem + ")";
    finish(m_unrecovered->text);
    return close();
  }
  m_p_process->endReplay();
  m_failover = done;
  if (m_binding.on_failover)
    m_binding.on_failover(done,
                          std::chrono::duration_cast<std::chrono::milliseconds>(Clock::now() - death.at));
  if (!std::exchange(m_in_tick, false)) return;
  storeResult();
  if (m_on_tick) m_on_tick();
}

// ---- copies -----------------------------------------------------------------------------------------------

void Round::dropCheckpoints() {
  if (m_p_process == nullptr || !m_history.hasBeginning()) return;
  m_p_process->dropCheckpoints();
  m_history.dropCheckpoints();
}

void Round::requestCheckpoint() {
  if (!m_binding.new_world || !m_p_process->canRequestCheckpoint()) return;
  if (!m_history.isCheckpointDue(m_ticks, [this] { return m_p_process->cpuTime(); })) return;
  m_history.beginCheckpoint(m_ticks, m_players, m_p_process->requestCheckpoint());
  if (const auto problem = m_p_process->popCheckpointProblem())
    logCheckpoints("no copies of this game's world are kept: " + *problem);
}

void Round::logCheckpoints(const std::string& sentence) const {
  if (m_binding.on_copies) m_binding.on_copies(sentence);
}

}  // namespace naiad

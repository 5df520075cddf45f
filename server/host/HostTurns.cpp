// Games that know no players: whose turn it is, and who goes when the game says that it is over.
#include <algorithm>

#include "GameManager.h"
#include "Host.h"
#include "Limits.h"
#include "SafeText.h"
#include "World.h"
#include "WorldExtras.h"

namespace naiad {

namespace {

constexpr int kLongestFrameMillis = 1000;     ///< as --frame-time
constexpr std::uint64_t kShortestRound = 30;  ///< ticks of one without players that another may follow

wire::ServerMessage line(const std::string& text) {
  wire::ServerMessage message;
  message.mutable_chat()->set_text(text);  // from nobody: the server says it
  return message;
}

}  // namespace

// What the game asks for, unless this host was told otherwise.
void Host::adoptSettings(df::World& world) {
  if (const df::WorldExtras* p_extras = world.findExtras()) {
    // 33 ms is how the published engine writes 1/30 s.
    const int millis = std::min(p_extras->settings.frame_time, kLongestFrameMillis);
    if (m_options.frame_micros == 0 && millis != df::FRAME_TIME_DEFAULT)
      m_options.frame_micros = millis * 1000;
  }
  world.setGameOverLeaves(m_options.on_game_over != "exit");
  if (world.compat()) m_log("compat is on: the published engine's rules where they differ from the book's");
}

// Of those who are there, the one who came first.
void Host::giveTurn() {
  if (m_options.players != "first") return;
  const Session* p_first = nullptr;
  forEachPlaying([&p_first](const Session& session) {
    if (session.isDetached()) return;
    if (p_first == nullptr || session.player() < p_first->player()) p_first = &session;
  });
  const std::uint32_t turn = p_first != nullptr ? p_first->player() : 0;
  m_p_world->extras().heard_player = turn;
  if (turn == m_turn) return;
  m_turn_before = std::exchange(m_turn, turn);
  if (p_first == nullptr || m_turn_before == 0) return;
  const wire::ServerMessage message = line(p_first->name() + " plays now.");
  forEachPlaying([&message](Session& session) { session.sendKept(message); });
}

// What the engine itself has to say to the players.
void Host::sendNotes(const df::World& world) {
  for (const std::string& note : world.view().notes) {
    const wire::ServerMessage message = line(safeText(note, kMaxChatLength));
    forEachPlaying([&message](Session& session) { session.sendKept(message); });
  }
}

void Host::tellTurn(Session& session) {
  const Session* p_first = m_turn != 0 ? findPlayer(m_turn) : nullptr;
  if (p_first != nullptr)
    session.sendKept(line(p_first->name() + " plays; you watch until it is your turn."));
}

bool Host::isHeard(const Session& session, const Input& input) const {
  if (m_options.players != "first" || session.player() == m_turn) return true;
  const bool lets_go = !input.is_mouse && input.action == df::KEY_RELEASED;
  return lets_go && session.player() == m_turn_before;
}

// The game is over for those who pressed the key that ends it; the others play on.
void Host::dismissLeavers(df::World& world) {
  for (const std::uint32_t leaver : world.takeLeavers()) {
    if (m_ends_with_last && connected() <= 1) {
      world.setGameOver();
      continue;
    }
    if (Session* session = findPlayer(leaver)) session->goodbye("For you, the game is over.");
  }
}

// Not if nobody but the player in the game's own terminal would see it. And a game that is over at once, with
// nobody there, would be over at once for ever.
bool Host::wantsNextRound(const df::World& world) const {
  const bool alone = m_ends_with_last && connected() <= 1;
  return m_options.on_game_over == "restart" && world.isGameOver() && m_stop_sentence.empty() && !alone &&
         (m_ever_joined || m_counters.ticks >= kShortestRound);
}

Session* Host::findPlayer(std::uint32_t player) {
  const auto found = std::find_if(m_sessions.begin(), m_sessions.end(), [player](const auto& session) {
    return session->player() == player && session->state() == Session::State::kPlaying;
  });
  return found != m_sessions.end() ? found->get() : nullptr;
}

}  // namespace naiad

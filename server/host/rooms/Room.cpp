#include "host/rooms/Room.h"

#include <algorithm>
#include <utility>

#include "naiad.pb.h"
#include "shared/net/base/Limits.h"
#include "shared/net/base/SafeText.h"

namespace naiad {

namespace {

wire::ServerMessage line(const std::string& text) {
  wire::ServerMessage message;
  message.mutable_chat()->set_text(text);  // without a player, the line is from the server
  return message;
}

df::InputQueue::Input inputOf(const Session& session, const Input& input) {
  if (!input.is_mouse) {
    return {.kind = df::InputQueue::kKey,
            .player = session.player(),
            .key = static_cast<df::Keyboard::Key>(input.key),
            .key_action = static_cast<df::EventKeyboardAction>(input.action)};
  }
  return {.kind = df::InputQueue::kMouse,
          .player = session.player(),
          .seen = session.viewedTick(input),
          .button = static_cast<df::Mouse::Button>(int{input.button} - 1),
          .mouse_action = static_cast<df::EventMouseAction>(input.action),
          .x = input.x,
          .y = input.y};
}

/// True if the player steers or follows an Object.
bool hasPart(const df::PlayerFacts& player) {
  return player.steering.p_table != nullptr ? player.steering.state.steering
                                            : player.followed.generation != 0;
}

bool isBefore(const Session* p_session, std::uint32_t player) {
  return p_session->player() < player;
}

}  // namespace

Room::Room(std::unique_ptr<Round> round, bool first_only, StageClock& stages)
    : m_p_round(std::move(round)), m_stages(stages), m_input_focus(first_only) {}

void Room::add(Session& session) {
  m_members.insert(std::lower_bound(m_members.begin(), m_members.end(), session.player(), isBefore),
                   &session);
  announceInputFocus(session);
}

void Room::remove(const Session& session) {
  std::erase(m_members, &session);
}

bool Room::has(const Session& session) const {
  return std::find(m_members.begin(), m_members.end(), &session) != m_members.end();
}

Session* Room::find(std::uint32_t player) const {
  const auto found = std::lower_bound(m_members.begin(), m_members.end(), player, isBefore);
  const bool plays = found != m_members.end() && (*found)->player() == player &&
                     (*found)->state() == Session::State::kPlaying;
  return plays ? *found : nullptr;
}

bool Room::isEmpty() const {
  return std::none_of(m_members.begin(), m_members.end(), [](const Session* p_session) {
    return p_session->state() == Session::State::kPlaying;
  });
}

std::size_t Room::countPlaying() const {
  std::size_t count = 0;
  forEachPlaying([&count](const Session&) { ++count; });
  return count;
}

void Room::broadcast(const std::string& text) const {
  const wire::ServerMessage message = line(text);
  forEachPlaying([&message](Session& session) { session.sendReliable(message); });
}

void Room::disconnectAll(const std::string& sentence, std::chrono::seconds again) const {
  forEachPlaying([&](Session& session) { session.sendGoodbye(sentence, again); });
}

// ---- ticks ------------------------------------------------------------------------------------------------

bool Room::beginTick(bool truth, std::uint32_t audited_player) {
  m_stages.enter(Stage::kInputs);
  updateInputFocus();
  applyInputs();
  if (!m_p_round->isReady()) return false;
  const bool watched = !isEmpty();
  if (watched && !m_watched) m_publisher = Publisher();
  m_watched = watched;
  m_ticking = true;
  m_stages.enter(Stage::kWorld);
  m_audited_player = watched && audited_player != 0 && find(audited_player) != nullptr ? audited_player : 0;
  m_p_round->tick(watched, truth || m_audited_player != 0, truth ? 0 : m_audited_player);
  return true;
}

void Room::applyInputs() {
  const std::uint32_t next = m_p_round->nextTick();
  forEachPlaying([this, next](Session& session) {
    session.drainInputs(next, [&](const Input& input) {
      if (m_input_focus.accepts(session.player(), input)) m_p_round->addInput(inputOf(session, input));
    });
  });
}

void Room::publish(TruthWriter* p_truth) {
  m_ticking = false;
  ++m_ticks;
  if (!m_watched) return;
  const Stage before = m_stages.enter(Stage::kPublish);
  m_publisher.update(m_p_round->view());
  m_p_round->onPublished(m_publisher);
  updateWatching();
  m_stages.enter(Stage::kSnapshots);
  sendSnapshots(p_truth);
  m_stages.enter(Stage::kBroadcasts);
  m_sound_broadcaster.tick(m_p_round->view(), soundSender());
  sendNotes();
  m_stages.enter(before);
}

// A player only watches while another one has the turn, or has a part in the game that this player lacks. If
// no player has one, the game may expect keys of all, as on a title screen.
void Room::updateWatching() {
  const bool has_parts = std::ranges::any_of(m_p_round->view().players, hasPart);
  forEachInWorld([&](Session& session, const df::PlayerFacts& facts) {
    const bool has_turn = !m_input_focus.isExclusive() || m_input_focus.player() == facts.id;
    session.status().setWatching(!has_turn || (has_parts && !hasPart(facts)), session.now());
  });
}

void Room::sendSnapshots(TruthWriter* p_truth) {
  forEachInWorld([&](Session& session, const df::PlayerFacts& facts) {
    // Written before the snapshot is sent, so a test that receives the snapshot finds its truth in the file.
    if (p_truth != nullptr) p_truth->write(m_publisher.tick(), facts.id, m_p_round->renderPlayer(facts.id));
    if (facts.id == m_audited_player && session.isAudited())
      session.recordTruth(m_publisher.tick(), m_p_round->renderPlayer(facts.id));
    session.setControls(facts.steering.p_table);
    session.sendTick(m_publisher, facts);
  });
}

SoundBroadcaster::Send Room::soundSender() const {
  return [this](std::uint32_t player, const wire::ServerMessage& message, bool lasts) {
    Session* p_session = find(player);
    if (p_session == nullptr) return false;
    if (!lasts) return p_session->sendBestEffort(message);
    p_session->sendReliable(message);
    return true;
  };
}

// Sends the engine's own lines to the players as chat.
void Room::sendNotes() const {
  for (const std::string& note : m_p_round->view().notes) broadcast(safeText(note, kMaxChatLength));
}

std::unique_ptr<Round> Room::changeRound(std::unique_ptr<Round> round) {
  std::swap(m_p_round, round);
  m_publisher = Publisher();
  m_sound_broadcaster.changeWorld(soundSender());
  m_watched = m_ticking = false;
  m_ticks = 0;
  forEachPlaying([this](Session& session) {
    session.beginWorld();
    join(session.player(), session.name(), static_cast<df::Color>(session.welcomed().color()));
  });
  return round;
}

// ---- whose input counts -----------------------------------------------------------------------------------

// Gives the turn to the connected player with the lowest id.
void Room::updateInputFocus() {
  if (!m_input_focus.isExclusive()) return;
  const Session* p_first = nullptr;
  forEachPlaying([&p_first](const Session& session) {
    if (p_first == nullptr && !session.isDetached()) p_first = &session;
  });
  const std::uint32_t turn = p_first != nullptr ? p_first->player() : 0;
  m_p_round->setInputPlayer(turn);
  if (m_input_focus.moveTo(turn)) broadcast(p_first->name() + " plays now.");
}

void Room::announceInputFocus(Session& session) const {
  const Session* p_first = m_input_focus.player() != 0 ? find(m_input_focus.player()) : nullptr;
  if (p_first != nullptr)
    session.sendReliable(line(p_first->name() + " plays; you watch until it is your turn."));
}

}  // namespace naiad

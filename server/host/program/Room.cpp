#include "host/program/Room.h"

#include <algorithm>
#include <utility>

#include "shared/net/base/Limits.h"
#include "shared/net/base/SafeText.h"

namespace naiad {

namespace {

wire::ServerMessage line(const std::string& text) {
  wire::ServerMessage message;
  message.mutable_chat()->set_text(text);  // from nobody: the server says it
  return message;
}

bool isBefore(const Session* p_session, std::uint32_t player) {
  return p_session->player() < player;
}

}  // namespace

Room::Room(std::unique_ptr<WorldPort> port, bool first_only)
    : m_p_port(std::move(port)), m_first_only(first_only) {}

void Room::add(Session& session) {
  m_members.insert(std::lower_bound(m_members.begin(), m_members.end(), session.player(), isBefore),
                   &session);
  tellTurn(session);
}

void Room::remove(const Session& session) {
  std::erase(m_members, &session);
}

bool Room::has(const Session& session) const {
  return std::find(m_members.begin(), m_members.end(), &session) != m_members.end();
}

Session* Room::find(std::uint32_t player) const {
  const auto found = std::lower_bound(m_members.begin(), m_members.end(), player, isBefore);
  const bool is_he = found != m_members.end() && (*found)->player() == player &&
                     (*found)->state() == Session::State::kPlaying;
  return is_he ? *found : nullptr;
}

bool Room::isEmpty() const {
  return std::none_of(m_members.begin(), m_members.end(), [](const Session* p_session) {
    return p_session->state() == Session::State::kPlaying;
  });
}

void Room::say(const std::string& text) const {
  const wire::ServerMessage message = line(text);
  forEachPlaying([&message](Session& session) { session.sendKept(message); });
}

void Room::dismiss(const std::string& sentence) const {
  forEachPlaying([&sentence](Session& session) { session.goodbye(sentence); });
}

// ---- ticks ------------------------------------------------------------------------------------------------

bool Room::beginTick(bool truth) {
  giveTurn();
  applyInputs();
  if (!m_p_port->isReady()) return false;
  const bool watched = !isEmpty();
  if (watched && !m_watched) m_publisher = Publisher();
  m_watched = watched;
  m_ticking = true;
  m_p_port->tick(watched, truth);
  return true;
}

void Room::applyInputs() {
  const std::uint32_t next = m_p_port->nextTick();
  forEachPlaying([this, next](Session& session) {
    session.takeInputs(next, [&](const Input& input) {
      if (!isHeard(session, input)) return;
      if (input.is_mouse) {
        m_p_port->mouse(session.player(), static_cast<df::EventMouseAction>(input.action),
                        static_cast<df::Mouse::Button>(int{input.button} - 1), input.x, input.y,
                        session.viewedTick(input));
      } else {
        m_p_port->key(session.player(), static_cast<df::Keyboard::Key>(input.key),
                      static_cast<df::EventKeyboardAction>(input.action));
      }
    });
  });
}

void Room::publish(TruthWriter* p_truth) {
  m_ticking = false;
  ++m_ticks;
  if (!m_watched) return;
  m_publisher.update(m_p_port->view());
  m_p_port->published(m_publisher);
  const std::vector<df::PlayerFacts>& players = m_p_port->view().players;
  auto found = players.begin();
  forEachPlaying([&](Session& session) {
    while (found != players.end() && found->id < session.player()) ++found;  // both are in order
    if (found == players.end() || found->id != session.player()) return;     // joins with the next tick
    // The truth first: whoever compares must find it once the snapshot has arrived.
    if (p_truth != nullptr) p_truth->write(m_publisher.tick(), found->id, m_p_port->renderPlayer(found->id));
    session.setControls(found->steering.p_table);
    session.sendTick(m_publisher, *found);
  });
  m_sound_news.tick(m_p_port->view(), soundTeller());
  tellNotes();
}

SoundNews::Tell Room::soundTeller() const {
  return [this](std::uint32_t player, const wire::ServerMessage& message, bool lasts) {
    return tellSounds(player, message, lasts);
  };
}

bool Room::tellSounds(std::uint32_t player, const wire::ServerMessage& message, bool lasts) const {
  Session* p_session = find(player);
  if (p_session == nullptr) return false;
  if (!lasts) return p_session->sendFleeting(message);
  p_session->sendKept(message);
  return true;
}

// What the engine itself has to say to the players.
void Room::tellNotes() const {
  for (const std::string& note : m_p_port->view().notes) say(safeText(note, kMaxChatLength));
}

void Room::changeWorld(std::unique_ptr<WorldPort> port) {
  m_p_port = std::move(port);
  m_publisher = Publisher();
  m_sound_news.changeWorld(soundTeller());
  m_watched = m_ticking = false;
  m_ticks = 0;
  forEachPlaying([this](Session& session) {
    session.beginWorld();
    m_p_port->join(session.player(), session.name(), static_cast<df::Color>(session.welcomed().color()));
  });
}

// ---- whose turn it is -------------------------------------------------------------------------------------

// Of those who are there, the one who came first.
void Room::giveTurn() {
  if (!m_first_only) return;
  const Session* p_first = nullptr;
  forEachPlaying([&p_first](const Session& session) {
    if (p_first == nullptr && !session.isDetached()) p_first = &session;
  });
  const std::uint32_t turn = p_first != nullptr ? p_first->player() : 0;
  m_p_port->setHeard(turn);
  if (turn == m_turn) return;
  m_turn_before = std::exchange(m_turn, turn);
  if (p_first != nullptr && m_turn_before != 0) say(p_first->name() + " plays now.");
}

void Room::tellTurn(Session& session) const {
  const Session* p_first = m_turn != 0 ? find(m_turn) : nullptr;
  if (p_first != nullptr)
    session.sendKept(line(p_first->name() + " plays; you watch until it is your turn."));
}

bool Room::isHeard(const Session& session, const Input& input) const {
  if (!m_first_only || session.player() == m_turn) return true;
  const bool lets_go = !input.is_mouse && input.action == df::KEY_RELEASED;
  return lets_go && session.player() == m_turn_before;
}

}  // namespace naiad

#include "client/ui/FrameComposer.h"

#include <algorithm>
#include <cstdio>

#include "client/world/DrawnPlacement.h"
#include "client/world/ExtrapolationClamp.h"

namespace naiad {
namespace {

/// Chat lines that a frame may need: those that the highest terminal shows, and a page for scrolling.
constexpr std::size_t kHistoryRows = 300;

/// Time for which a pointer marks the player's own object when it first appears.
constexpr std::chrono::seconds kPointed{2};

std::int64_t tenthsOfSilence(const ClientSession& session, FrameComposer::Time now) {
  return std::chrono::floor<std::chrono::milliseconds>(session.clock().silence(now)).count() / 100;
}

}  // namespace

void enterChosenRoom(ClientSession* p_session, int choice) {
  if (p_session == nullptr || choice < 0) return;
  const auto line = static_cast<std::size_t>(choice);
  if (line < p_session->rooms().size()) p_session->enterRoom(p_session->rooms()[line].name);
}

FrameComposer::FrameState FrameComposer::currentState(Time now) {
  FrameState state;
  state.connection = m_connection.revision();
  ClientSession* session = m_connection.session();
  if (session == nullptr) return state;
  state.session = session->revision();
  state.tick = session->displayTick(now);
  if (session->isPredicting()) state.predicted = session->predictedTick(now);
  const bool waiting = m_connection.state() == Connection::State::kReconnecting || session->isSilent(now);
  if (waiting) {
    state.silence = tenthsOfSilence(*session, now);
  }
  state.chat_lines = recentChat(now).size();
  state.note = m_sounds.shownNote(now);
  m_status.update(session->welcome().player, session->roundTrip(), now);
  updatePointer(*session, now);
  state.pointer = now < m_point_until;
  state.status = m_controls.status() == StatusMode::kAlways || m_status.isShown(now);
  return state;
}

// The object may appear long after the player has joined, after a title screen.
void FrameComposer::updatePointer(const ClientSession& session, Time now) {
  if (m_joined_as != session.welcome().player) m_pointed = false;
  m_joined_as = session.welcome().player;
  if (m_pointed || session.replica().control().generation == 0) return;
  m_pointed = true;
  m_point_until = now + kPointed;
}

std::vector<ChatEntry> FrameComposer::recentChat(Time now) const {
  std::vector<ChatEntry> recent;
  const ClientSession* session = m_connection.session();
  if (session == nullptr) return recent;
  for (const ChatEntry& entry : session->chat()) {
    if (m_controls.isChatOpen() || now - entry.at < kChatShown) recent.push_back(entry);
  }
  if (!m_notice.text.empty() && now - m_notice.at < kChatShown) recent.push_back(m_notice);
  return recent;
}

std::string FrameComposer::banner(Time now) const {
  if (m_controls.prefixed()) return "Menu: t chat  p players  r rooms  h help  s status  q leave";
  if (m_controls.hasOmittedText()) return "Only Latin, Greek and Cyrillic letters can be shown.";
  ClientSession* session = m_connection.session();
  const bool searching = m_connection.state() == Connection::State::kReconnecting;
  // A session that continues by datagrams while it opens another stream needs no banner.
  if (session == nullptr || !(session->isSilent(now) || (searching && !session->hasDatagrams(now))))
    return "";
  const std::int64_t tenths = tenthsOfSilence(*session, now);
  char text[96];
  std::snprintf(text, sizeof text,
                m_connection.isDeferred() ? "The server asks to wait, retrying: %lld.%lld s"
                : searching               ? "Connection lost, reconnecting: %lld.%lld s"
                                          : "No data from the server for %lld.%lld s",
                static_cast<long long>(tenths / 10), static_cast<long long>(tenths % 10));
  return text;
}

ScreenModel FrameComposer::composeFrame(Time now) {
  m_composed = currentState(now);
  ScreenModel model;
  model.banner = banner(now);
  if (ClientSession* session = m_connection.session()) {
    const Replica& replica = session->replica();
    const ExtrapolationClamp clamp(replica, session->clock().newestTick(), m_composed.tick);
    const DrawnPlacement placement(replica, session->predict(now), clamp);
    model.view = replica.render(m_composed.tick, &placement);
    model.focus = replica.focus(m_composed.tick, &placement);
    model.background = replica.background();
    model.has_view = true;
    model.round_trip = session->roundTrip();
    model.score = session->score();
    const ServerAddress& address = m_connection.address();
    model.server = session->welcome().server + " at " + (m_browser ? address.host : address.text());
    model.game = session->welcome().game;
    model.self = session->welcome().player;
    model.self_name = session->welcome().name;
    model.self_color = session->welcome().color;
    if (m_composed.pointer) model.self_cell = replica.ownCell(m_composed.tick, &placement);
    const auto& chat = session->chat();
    const std::size_t shown = kHistoryRows + static_cast<std::size_t>(m_controls.chatScroll());
    model.history.assign(chat.end() - static_cast<std::ptrdiff_t>(std::min(shown, chat.size())), chat.end());
    model.players = session->players();
    model.rooms = session->rooms();
    model.room = session->welcome().room;
    model.help = session->welcome().help;
    model.chat = recentChat(now);
    model.note = m_composed.note;
  }
  model.browser = m_browser;
  model.menu_letter = m_controls.menuLetter();
  model.key_releases = m_key_releases;
  model.status_shown = m_controls.status() != StatusMode::kNever;
  model.status_over_game = m_composed.status;
  model.panel = m_controls.panel();
  model.scroll = m_controls.scroll();
  model.room_choice = m_controls.roomChoice();
  model.chat_scroll = m_controls.chatScroll();
  model.chat_open = m_controls.isChatOpen();
  model.chat_text = m_controls.chatText();
  return model;
}

}  // namespace naiad

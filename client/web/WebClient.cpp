#include "client/web/WebClient.h"

#include <algorithm>
#include <utility>

#include "shared/net/base/SafeText.h"
#include "shared/replica/Limits.h"

namespace naiad {
namespace {

constexpr std::size_t kMaxToken = 64;

SessionOptions sessionOptions(const WebClient::Options& options) {
  SessionOptions session;
  session.name = options.name;
  session.password = options.password;
  session.program = options.program;
  session.columns = options.columns;
  session.rows = options.rows;
  session.two_streams = true;
  if (isRoomName(options.room)) session.room = options.room;
  session.stays_in_room = true;  // a reloaded page still has its first room in the address
  return session;
}

}  // namespace

TabTokenStore::TabTokenStore(PageBridge& port, std::string_view kept)
    : m_port(port), m_token(kept.size() > 2 * kMaxToken ? "" : bytesOfHex(kept).value_or("")) {}

void TabTokenStore::save(SavedSession session, Time) {
  m_token = session.token;
  m_port.saveToken(hexText(m_token));
}

void TabTokenStore::remove() {
  m_token.clear();
  m_port.saveToken("");
}

WebClient::WebClient(PageBridge& port, const Options& options, Time now)
    : m_port(port),
      m_columns(std::clamp(options.columns, 1, kMaxViewWidth)),
      m_rows(std::clamp(options.rows, 1, kMaxViewHeight)),
      m_tokens(port, options.token),
      m_p_streams(new WebStreamOpener(port)),
      m_connection(std::unique_ptr<StreamOpener>(m_p_streams), ServerAddress{options.server, 0},
                   sessionOptions(options), true) {
  m_connection.setTokenStore(m_tokens);
  m_composer.setBrowser();
  m_player.setRealReleases(true, now);
  m_connection.start();
}

void WebClient::pressKey(std::string_view key, std::string_view code, KeyEvent::Action action,
                         std::uint8_t modifiers, Time now) {
  handleKey(m_keys.translate(key, code, action, modifiers), now);
}

void WebClient::command(char32_t letter, Time now) {
  KeyEvent prefix;
  prefix.key = df::Keyboard::RIGHTBRACKET;
  prefix.modifiers = kControl;
  KeyEvent event;
  event.ch = letter;
  event.key = static_cast<df::Keyboard::Key>(df::Keyboard::A + static_cast<int>(letter - U'a'));
  handleKey(prefix, now);
  handleKey(event, now);
}

void WebClient::handleKey(const KeyEvent& event, Time now) {
  using Result = ClientControls::Result;
  const Result result = m_controls.handleKey(event);
  // There is nothing to suspend in a page.
  if (result == Result::kGame || result == Result::kSuspend) return m_player.pressKey(event, now);
  if (result == Result::kOpened) m_player.releaseKeys(now);
  if (result == Result::kSendChat && m_connection.session() != nullptr)
    m_connection.session()->sendChat(m_controls.popChat());
  if (result == Result::kEnterRoom) enterChosenRoom(m_connection.session(), m_controls.roomChoice());
  if (result == Result::kLeave) m_connection.leave();
  m_dirty = true;
}

void WebClient::releaseKeys(Time now) {
  m_keys.forget();
  m_player.releaseKeys(now);
}

void WebClient::resize(int columns, int rows) {
  columns = std::clamp(columns, 1, kMaxViewWidth);
  rows = std::clamp(rows, 1, kMaxViewHeight);
  if (columns == m_columns && rows == m_rows) return;
  m_columns = columns;
  m_rows = rows;
  m_connection.resize(columns, rows);
  m_dirty = true;
}

void WebClient::update(Time now) {
  m_p_streams->update(now);
  m_connection.update(now);
  m_player.update(now);
  ClientSession* session = m_connection.session();
  if (session == nullptr) return;
  if (m_controls.panel() == Panel::kRooms) session->refreshRooms(now);
  const std::uint32_t self = session->welcome().player;
  for (const SoundLine& sound : session->popSounds()) {
    m_sounds.addSound(sound, self, now);
    m_port.sound(sound, sound.player == 0 || sound.player == self);
  }
}

bool WebClient::compose(Time now) {
  if (!std::exchange(m_dirty, false) && !m_composer.isStale(now)) return false;
  const ScreenModel model = m_composer.composeFrame(now);
  if (model.has_view) {
    m_view_width = model.view.width();
    m_view_height = model.view.height();
  }
  m_layout = composeScreen(model, m_columns, m_rows);
  m_controls.onShown(m_layout.shown);
  return true;
}

WebClient::State WebClient::state() const {
  using S = Connection::State;
  const S state = m_connection.state();
  if (state == S::kRefused || m_p_streams->isRefusalFinal()) return State::kRefused;
  if (state == S::kJoining) return State::kJoining;
  if (!m_connection.isOver()) return State::kPlaying;
  return state == S::kLeft ? State::kLeft : State::kOver;
}

std::string WebClient::message() const {
  if (!m_p_streams->refusal().empty()) return m_p_streams->refusal();
  return m_connection.message();
}

}  // namespace naiad

#include "client/ui/ClientApp.h"

#include <signal.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <utility>

#include "client/terminal/Screen.h"
#include "client/terminal/TerminalGuard.h"
#include "client/world/DrawnPlacement.h"
#include "client/world/ExtrapolationClamp.h"

namespace naiad {
namespace {

constexpr std::chrono::milliseconds kFrame{16};  // at most 60 frames a second
constexpr std::chrono::milliseconds kHousekeeping{100};
constexpr std::chrono::milliseconds kFarewell{500};

SessionOptions withTerminalSize(SessionOptions options) {
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 && size.ws_row > 0) {
    options.columns = size.ws_col;
    options.rows = size.ws_row;
  }
  return options;
}

}  // namespace

ClientApp::ClientApp(Options options)
    : m_options(std::move(options)),
      m_connection(m_context, m_options.address, withTerminalSize(m_options.session), true, m_options.trust),
      m_sounds(m_options.sound) {
  if (m_options.p_session_file != nullptr) m_connection.keepIn(*m_options.p_session_file);
}

ClientApp::~ClientApp() = default;

ClientApp::Outcome ClientApp::run() {
  join();
  if (m_connection.isOver()) return outcome();
  takeTerminal();
  while (!m_leaving && !m_connection.isOver()) {
    // One handler: bytes of the player (readInput), a signal, or a frame of the server (ClientSession).
    m_context.run_one_until(nextDeadline(Clock::now()));
    const Time now = Clock::now();
    m_connection.update(now);
    take(m_decoder.flush(now), now);
    sendKeys(m_held.expire(now), now);
    sendHeld(now);
    sendMove(now);
    hearSounds(now);
    m_dirty = m_dirty || !(look(now) == m_drawn);
    if (m_dirty && now - m_last_frame >= kFrame) drawFrame(now);
  }
  return leaveTerminal();
}

/// Connect before the terminal is touched, so that an error is an ordinary line in an ordinary shell.
void ClientApp::join() {
  m_connection.start();
  while (m_connection.state() == Connection::State::kJoining) {
    m_context.run_one_for(kHousekeeping);
    m_connection.update(Clock::now());
  }
}

void ClientApp::takeTerminal() {
  m_guard = std::make_unique<TerminalGuard>(TerminalGuard::Options{m_options.mouse});
  m_screen = std::make_unique<Screen>(Screen::Options{m_options.ascii, m_options.colors});
  m_guard->onRestore([this] { m_screen->end(); });
  m_guard->installHandlers();
  drawFrame(Clock::now());
  m_guard->enterModes();
  m_input.assign(dup(STDIN_FILENO));
  m_signals.assign(dup(m_guard->signalFd()));
  waitForInput();
  waitForSignal();
}

ClientApp::Outcome ClientApp::leaveTerminal() {
  m_guard->restore();
  m_input.close();
  m_signals.close();
  m_work.reset();
  if (m_leaving) {
    m_connection.leave();
    m_context.restart();
    m_context.run_for(kFarewell);  // ends as soon as the server has heard it
  }
  return outcome();
}

ClientApp::Outcome ClientApp::outcome() const {
  using S = Connection::State;
  const std::string& sentence = m_connection.sentence();
  switch (m_connection.state()) {
    case S::kUnreachable:
      return {kExitUnreachable, sentence, 0};
    case S::kRefused:
      return {kExitRefused, sentence, 0};
    case S::kEnded:
    case S::kLost:
      return {kExitEnded, sentence, 0};
    default:
      return {kExitLeft, "", m_signal};
  }
}

void ClientApp::waitForInput() {
  m_input.async_wait(asio::posix::stream_descriptor::wait_read, [this](const std::error_code& error) {
    if (error) return;
    readInput();
    if (!m_leaving) waitForInput();
  });
}

void ClientApp::waitForSignal() {
  m_signals.async_wait(asio::posix::stream_descriptor::wait_read, [this](const std::error_code& error) {
    if (error) return;
    takeSignals();
    if (!m_leaving) waitForSignal();
  });
}

// The descriptor stays blocking: O_NONBLOCK would hit the shell's side of the terminal, too.
void ClientApp::readInput() {
  std::array<char, 4096> bytes{};
  const ssize_t count = read(STDIN_FILENO, bytes.data(), bytes.size());
  if (count < 0 && (errno == EINTR || errno == EAGAIN)) return;
  if (count <= 0) {
    m_leaving = true;  // the terminal is gone
    return;
  }
  const Time now = Clock::now();
  take(m_decoder.feed({bytes.data(), static_cast<std::size_t>(count)}, now), now);
}

void ClientApp::takeSignals() {
  std::array<unsigned char, 64> signals{};
  const ssize_t count = read(m_guard->signalFd(), signals.data(), signals.size());
  for (ssize_t i = 0; i < count; ++i) {
    switch (signals[static_cast<std::size_t>(i)]) {
      case SIGINT:
        m_leaving = true;
        break;
      case SIGTERM:
      case SIGHUP:
        m_leaving = true;
        m_signal = signals[static_cast<std::size_t>(i)];
        break;
      case SIGTSTP:
        suspend();
        break;
      case SIGCONT:
        resume();
        break;
      case SIGWINCH:
        if (m_screen->readSize()) m_connection.resize(m_screen->columns(), m_screen->rows());
        m_dirty = true;
        break;
      default:
        break;
    }
  }
}

void ClientApp::take(const std::vector<TerminalEvent>& events, Time now) {
  for (const TerminalEvent& event : events) {
    if (const auto* key = std::get_if<KeyEvent>(&event)) takeKey(*key, now);
    if (const auto* mouse = std::get_if<MouseEvent>(&event)) takeMouse(*mouse, now);
    if (std::holds_alternative<KittyAnswer>(event)) takeKittyAnswer(now);
  }
}

void ClientApp::takeKey(const KeyEvent& event, Time now) {
  const ClientControls::Result result = m_controls.take(event);
  if (result == ClientControls::Result::kGame) return sendKeys(m_held.take(event, now), now);
  m_dirty = true;
  switch (result) {
    case ClientControls::Result::kOpened:
      // Text needs what the keyboard layout makes of the keys, and the game must see no key stay down.
      sendKeys(m_held.releaseAll(), now);
      sendKeys(m_held.setRealReleases(false, now), now);
      if (m_guard->kittyPushed()) m_guard->popKitty();
      break;
    case ClientControls::Result::kSay:
      if (m_connection.session() != nullptr) m_connection.session()->sendChat(m_controls.takeChat());
      [[fallthrough]];
    case ClientControls::Result::kClosed:
      m_guard->queryKitty();
      break;
    case ClientControls::Result::kLeave:
      m_leaving = true;
      break;
    case ClientControls::Result::kSuspend:
      suspend();
      break;
    default:
      break;
  }
}

void ClientApp::takeKittyAnswer(Time now) {
  if (m_controls.chatOpen()) return;
  m_guard->pushKitty();
  sendKeys(m_held.setRealReleases(true, now), now);
}

void ClientApp::takeMouse(const MouseEvent& event, Time now) {
  ClientSession* session = m_connection.session();
  if (event.action == MouseEvent::Action::kRelease) m_button = df::Mouse::UNDEFINED_MOUSE_BUTTON;
  const auto cell = m_placement.toView(event.x, event.y);
  if (!cell || session == nullptr) return;
  if (!(*cell == m_pointer)) m_move = m_pointer = *cell;
  if (event.action != MouseEvent::Action::kPress) return;
  m_button = event.button;
  session->sendMouse(df::CLICKED, event.button, cell->x, cell->y, now);
}

void ClientApp::sendKeys(const std::vector<KeyAction>& actions, Time now) {
  ClientSession* session = m_connection.session();
  if (session == nullptr) return;
  for (const KeyAction& action : actions) session->sendKey(action.key, action.action, now);
}

/// Once per tick: keys and the mouse button that are being held.
void ClientApp::sendHeld(Time now) {
  if (now < m_next_key_tick) return;
  m_next_key_tick = std::max(m_next_key_tick + tickLength(), now + tickLength() / 2);
  sendKeys(m_held.tick(), now);
  if (m_button != df::Mouse::UNDEFINED_MOUSE_BUTTON && m_connection.session() != nullptr) {
    m_connection.session()->sendMouse(df::PRESSED, m_button, m_pointer.x, m_pointer.y, now);
  }
}

/// The newest place of the mouse, at most once a frame: more would only fill the server's queue.
void ClientApp::sendMove(Time now) {
  if (!m_move || now - m_last_move < kFrame || m_connection.session() == nullptr) return;
  const CellPosition cell = *std::exchange(m_move, std::nullopt);
  m_last_move = now;
  m_connection.session()->sendMouse(df::MOVED, df::Mouse::UNDEFINED_MOUSE_BUTTON, cell.x, cell.y, now);
}

void ClientApp::hearSounds(Time now) {
  ClientSession* session = m_connection.session();
  if (session == nullptr) return;
  for (const SoundLine& sound : session->takeSounds()) m_sounds.hear(sound, session->welcome().player, now);
  if (m_sounds.takeBell()) m_screen->ring();
}

void ClientApp::suspend() {
  sendKeys(m_held.releaseAll(), Clock::now());
  m_guard->leaveModes();
  m_screen->end();
  m_guard->setOriginal();
  m_guard->stopProcess();
  resume();
}

void ClientApp::resume() {
  const Time now = Clock::now();
  m_guard->setRaw();
  sendKeys(m_held.setRealReleases(false, now), now);
  if (m_screen->readSize()) m_connection.resize(m_screen->columns(), m_screen->rows());
  m_screen->redrawAll();
  drawFrame(now);
  m_guard->enterModes();
}

ClientApp::Seen ClientApp::look(Time now) {
  Seen seen;
  seen.connection = m_connection.revision();
  ClientSession* session = m_connection.session();
  if (session == nullptr) return seen;
  seen.session = session->revision();
  seen.tick = session->displayTick(now);
  if (session->isPredicting()) seen.predicted = session->predictedTick(now);
  const bool waiting = m_connection.state() == Connection::State::kSearching || session->isSilent(now);
  if (waiting) {
    seen.silence = std::chrono::floor<std::chrono::milliseconds>(session->clock().silence(now)).count() / 100;
  }
  seen.chat_lines = recentChat(now).size();
  seen.note = m_sounds.note(now);
  return seen;
}

std::vector<ChatEntry> ClientApp::recentChat(Time now) {
  std::vector<ChatEntry> recent;
  const ClientSession* session = m_connection.session();
  if (session == nullptr) return recent;
  for (const ChatEntry& entry : session->chat()) {
    if (m_controls.chatOpen() || now - entry.at < kChatShown) recent.push_back(entry);
  }
  return recent;
}

std::string ClientApp::banner(Time now) {
  if (m_controls.prefixed()) return "Ctrl-]: t chat  p players  h help  s status  q leave";
  ClientSession* session = m_connection.session();
  const bool searching = m_connection.state() == Connection::State::kSearching;
  // A session may go on by datagrams while its stream is sought again: nobody need know.
  if (session == nullptr || !(session->isSilent(now) || (searching && !session->hasDatagrams(now))))
    return "";
  const auto tenths =
      std::chrono::floor<std::chrono::milliseconds>(session->clock().silence(now)).count() / 100;
  char text[96];
  std::snprintf(text, sizeof text,
                searching ? "Server lost, looking for it again: %lld.%lld s"
                          : "No news from the server for %lld.%lld s",
                static_cast<long long>(tenths / 10), static_cast<long long>(tenths % 10));
  return text;
}

void ClientApp::drawFrame(Time now) {
  m_drawn = look(now);
  m_dirty = false;
  m_last_frame = now;
  ScreenModel model;
  model.banner = banner(now);
  if (ClientSession* session = m_connection.session()) {
    const Replica& replica = session->replica();
    const ExtrapolationClamp clamp(replica, session->clock().newestTick(), m_drawn.tick);
    const DrawnPlacement placement(replica, session->predict(now), clamp);
    model.view = replica.render(m_drawn.tick, &placement);
    model.focus = replica.focus(m_drawn.tick, &placement);
    model.background = replica.background();
    model.has_view = true;
    model.round_trip = session->roundTrip();
    model.tick = m_drawn.tick;
    model.score = session->score();
    model.server = session->welcome().server + " at " + m_connection.address().text();
    model.game = session->welcome().game;
    model.self = session->welcome().player;
    model.players = session->players();
    model.help = session->welcome().help;
    model.chat = recentChat(now);
    model.note = m_drawn.note;
  }
  model.status_shown = m_controls.statusShown();
  model.panel = m_controls.panel();
  model.chat_open = m_controls.chatOpen();
  model.chat_text = m_controls.chatText();
  const ScreenLayout layout = layOut(model, m_screen->columns(), m_screen->rows());
  m_placement = layout.placement;
  m_screen->show(layout.picture);
}

ClientApp::Time ClientApp::nextDeadline(Time now) {
  Time next = std::min(now + kHousekeeping, m_held.deadline());
  if (const auto due = m_decoder.deadline()) next = std::min(next, *due);
  next = std::min(next, m_next_key_tick);
  if (m_connection.session() != nullptr)
    next = std::min(next, m_connection.session()->nextWake().value_or(next));
  if (m_move) next = std::min(next, m_last_move + kFrame);
  if (m_dirty) next = std::min(next, m_last_frame + kFrame);
  // One's own object runs on by a clock of its own.
  if (m_connection.session() != nullptr && m_connection.session()->isPredicting()) {
    next = std::min(next, m_last_frame + kFrame);
  }
  // A tick that passes without news can still change the picture.
  if (m_connection.session() != nullptr) next = std::min(next, m_connection.session()->clock().nextTick(now));
  return next;
}

std::chrono::microseconds ClientApp::tickLength() {
  return m_connection.session() != nullptr ? m_connection.session()->welcome().tick
                                           : std::chrono::microseconds(33333);
}

}  // namespace naiad

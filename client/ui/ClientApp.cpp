#include "client/ui/ClientApp.h"

#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <utility>

#include "client/terminal/Screen.h"
#include "client/terminal/TerminalGuard.h"
#include "client/ui/EarlySignalWatcher.h"

namespace naiad {
namespace {

constexpr std::chrono::milliseconds kFrame{16};  // minimum interval of frames
constexpr std::chrono::milliseconds kHousekeeping{100};
constexpr std::chrono::milliseconds kFarewell{500};
constexpr std::chrono::seconds kPictureNotice{2};  // a notice is shown after this wait for the first picture

SessionOptions withTerminalSize(SessionOptions options) {
  const Screen::Size size = Screen::terminalSize();
  options.columns = size.columns;
  options.rows = size.rows;
  return options;
}

}  // namespace

ClientApp::ClientApp(Options options)
    : m_options(std::move(options)),
      m_connection(m_context, m_options.address, withTerminalSize(m_options.session), true, m_options.trust),
      m_sounds(m_options.sound),
      m_player(m_connection),
      m_composer(m_connection, m_controls, m_sounds) {
  m_controls.setMenuLetter(m_options.menu_letter);
  if (m_options.p_tokens != nullptr) m_connection.setTokenStore(*m_options.p_tokens);
}

ClientApp::~ClientApp() = default;

ClientApp::Outcome ClientApp::run() {
  join();
  if (m_leaving) leaveAndFlush();
  if (m_connection.isOver()) return outcome();
  acquireTerminal();
  while (!m_leaving && !m_connection.isOver()) {
    // Run one handler: bytes of the player (readInput), a signal, or a frame of the server (ClientSession).
    // A ready handler runs even if the deadline has already passed, so that the player can always leave.
    if (m_context.run_one_until(nextDeadline(Clock::now())) == 0) m_context.poll_one();
    const Time now = Clock::now();
    m_connection.update(now);
    handleEvents(m_decoder.flush(now), now);
    m_player.update(now);
    handleSounds(now);
    if (m_controls.panel() == Panel::kRooms && m_connection.session() != nullptr)
      m_connection.session()->refreshRooms(now);
    m_was_idle = isIdle(now);
    m_leaving = m_leaving || m_was_idle;
    m_dirty = m_dirty || m_composer.isStale(now);
    if (m_dirty && now >= m_next_frame && !m_leaving) drawFrame(now);
  }
  return releaseTerminal();
}

/// Connects before the terminal is taken, so that an error is an ordinary line in the shell.
void ClientApp::join() {
  const EarlySignalWatcher ends(m_context, [this](int signal) {
    m_leaving = true;
    m_signal = signal;
  });
  m_connection.start();
  bool said = false;
  bool said_redirect = false;
  std::string refusal;
  while (!m_leaving && m_connection.state() == Connection::State::kJoining) {
    m_context.run_one_for(kHousekeeping);
    const Time now = Clock::now();
    m_connection.update(now);
    if (m_connection.isRedirected() && !std::exchange(said_redirect, true))
      std::fprintf(stderr, "dfclient: Redirected to %s.\n", m_connection.address().text().c_str());
    if (m_connection.isDeferred() && m_connection.message() != refusal) {
      refusal = m_connection.message();
      std::fprintf(stderr, "dfclient: %s (Retrying; Ctrl-C quits.)\n", refusal.c_str());
    }
    if (m_connection.pictureWait(now) < kPictureNotice || std::exchange(said, true)) continue;
    std::fprintf(stderr, "dfclient: Joined; waiting for the first picture. Ctrl-C quits.\n");
  }
}

void ClientApp::acquireTerminal() {
  m_last_input = Clock::now();
  m_guard = std::make_unique<TerminalGuard>(TerminalGuard::Options{m_options.mouse});
  m_screen =
      std::make_unique<Screen>(Screen::Options{m_options.terminal.name, m_options.ascii, m_options.colors});
  m_guard->onRestore([this] { m_screen->end(); });
  m_guard->installHandlers();
  if (!m_options.terminal.notice.empty()) m_composer.addNotice(m_options.terminal.notice, Clock::now());
  drawFrame(Clock::now());
  m_guard->enterModes();
  m_input.assign(dup(STDIN_FILENO));
  m_signals.assign(dup(m_guard->signalFd()));
  waitForInput();
  waitForSignal();
}

ClientApp::Outcome ClientApp::releaseTerminal() {
  m_guard->restore();
  m_input.close();
  m_signals.close();
  if (m_leaving && !m_hung_up) leaveAndFlush();
  return outcome();
}

void ClientApp::leaveAndFlush() {
  m_work.reset();
  m_connection.leave();
  m_context.restart();
  m_context.run_for(kFarewell);  // ends as soon as the channel has closed
}

ClientApp::Outcome ClientApp::outcome() const {
  using S = Connection::State;
  const std::string& message = m_connection.message();
  switch (m_connection.state()) {
    case S::kUnreachable:
      return {kExitUnreachable, message, 0, {}};
    case S::kRefused:
      return {kExitRefused, message, 0, m_connection.isPasswordRefused() ? m_connection.key() : std::nullopt};
    case S::kEnded:
    case S::kLost:
      return {kExitEnded, message, 0, {}};
    default:
      return {kExitLeft, m_was_idle ? "You left: no input for too long (--idle-limit)." : "", m_signal, {}};
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
    handleSignals();
    if (!m_leaving) waitForSignal();
  });
}

// The descriptor stays blocking, because O_NONBLOCK would also affect the shell, which shares the terminal.
void ClientApp::readInput() {
  std::array<char, 4096> bytes{};
  const ssize_t count = read(STDIN_FILENO, bytes.data(), bytes.size());
  if (count < 0 && (errno == EINTR || errno == EAGAIN)) return;
  if (count <= 0) {
    onHangUp();
    return;
  }
  const Time now = Clock::now();
  m_last_input = now;
  handleEvents(m_decoder.feed({bytes.data(), static_cast<std::size_t>(count)}, now), now);
}

void ClientApp::handleSignals() {
  std::array<unsigned char, 64> signals{};
  const ssize_t count = read(m_guard->signalFd(), signals.data(), signals.size());
  for (ssize_t i = 0; i < count; ++i) {
    const int signal = signals[static_cast<std::size_t>(i)];
    if (signal == SIGTSTP && !m_leaving) suspend();
    if (signal == SIGCONT && !m_leaving) resume();
    if (signal == SIGWINCH) {
      if (m_screen->readSize()) m_connection.resize(m_screen->columns(), m_screen->rows());
      m_composer.onResize(Clock::now());
      m_dirty = true;
    }
    if (signal == SIGHUP) onHangUp();
    if (signal == SIGINT || signal == SIGTERM) m_leaving = true;
    if (signal == SIGTERM || signal == SIGHUP) m_signal = signal;
  }
}

void ClientApp::handleEvents(const std::vector<TerminalEvent>& events, Time now) {
  if (m_decoder.hasKeyRecords()) acceptKeyReleases(now);
  for (const TerminalEvent& event : events) {
    if (const auto* key = std::get_if<KeyEvent>(&event)) handleKey(*key, now);
    if (const auto* mouse = std::get_if<MouseEvent>(&event)) m_player.moveMouse(*mouse, m_placement, now);
    if (std::holds_alternative<FocusLost>(event)) m_player.releaseKeys(now);
    if (const auto* paste = std::get_if<PasteEvent>(&event)) {
      m_dirty = m_controls.insertPasted(paste->text) || m_dirty;
    }
    if (std::holds_alternative<KittyReply>(event) && acceptKeyReleases(now)) {
      m_guard->pushKitty();
      m_dirty = true;
    }
  }
}

void ClientApp::handleKey(const KeyEvent& event, Time now) {
  using Result = ClientControls::Result;
  const Result result = m_controls.handleKey(event);
  if (result == Result::kGame) return m_player.pressKey(event, now);
  m_dirty = true;
  if (result == Result::kOpened) {
    // Text needs the characters of the keyboard layout, and no key may stay down in the game.
    m_player.releaseKeys(now);
    m_player.setRealReleases(false, now);
    m_guard->popKitty();
  }
  if (result == Result::kSendChat && m_connection.session() != nullptr)
    m_connection.session()->sendChat(m_controls.popChat());
  if (result == Result::kSendChat || result == Result::kClosed) m_guard->queryKitty();
  if (result == Result::kEnterRoom) enterChosenRoom(m_connection.session(), m_controls.roomChoice());
  if (result == Result::kLeave) m_leaving = true;
  if (result == Result::kSuspend) suspend();
}

bool ClientApp::acceptKeyReleases(Time now) {
  if (m_controls.isChatOpen()) return false;
  m_player.setRealReleases(true, now);
  m_composer.acceptKeyReleases(true);
  return true;
}

void ClientApp::handleSounds(Time now) {
  ClientSession* session = m_connection.session();
  if (session == nullptr) return;
  for (const SoundLine& sound : session->popSounds())
    m_sounds.addSound(sound, session->welcome().player, now);
  if (m_sounds.popBell()) m_screen->ring();
}

/// Leaves because the terminal is gone, as when the player closes its window. A visitor's session is kept,
/// because their connection may have broken and they may return.
void ClientApp::onHangUp() {
  m_leaving = true;
  m_hung_up = m_options.session.proxy.has_value();
}

bool ClientApp::isIdle(Time now) const {
  return m_options.idle_limit.count() > 0 && now - m_last_input > m_options.idle_limit;
}

// A visitor of a door has no shell to resume from.
void ClientApp::suspend() {
  if (m_options.session.proxy) return;
  m_player.releaseKeys(Clock::now());
  m_guard->leaveModes();
  m_screen->end();
  m_guard->setOriginalMode();
  if (m_guard->stopProcess()) {
    resume();
  } else {
    m_leaving = true;
    handleSignals();
  }
}

void ClientApp::resume() {
  const Time now = Clock::now();
  m_guard->setRawMode();
  // Another terminal may have been attached, so enterModes() asks for its protocol again.
  m_player.setRealReleases(false, now);
  m_composer.acceptKeyReleases(false);
  if (m_screen->readSize()) m_connection.resize(m_screen->columns(), m_screen->rows());
  m_screen->redrawAll();
  drawFrame(now);
  m_guard->enterModes();
}

void ClientApp::drawFrame(Time now) {
  m_dirty = false;
  const ScreenLayout layout =
      composeScreen(m_composer.composeFrame(now), m_screen->columns(), m_screen->rows());
  m_placement = layout.placement;
  m_controls.onShown(layout.shown);
  m_screen->show(layout.picture);
  // Leave at least as much time for everything else as drawing took.
  const Time end = Clock::now();
  m_next_frame = std::max(now + kFrame, end + (end - now));
}

ClientApp::Time ClientApp::nextDeadline(Time now) {
  Time next = std::min(now + kHousekeeping, m_player.deadline());
  if (const auto due = m_decoder.deadline()) next = std::min(next, *due);
  const ClientSession* session = m_connection.session();
  // A predicted object also moves between snapshots.
  if (m_dirty || (session != nullptr && session->isPredicting())) next = std::min(next, m_next_frame);
  if (session == nullptr) return next;
  next = std::min(next, session->nextWake().value_or(next));
  // The picture can change with each tick, even without a snapshot.
  return std::min(next, session->clock().nextTick(now));
}

}  // namespace naiad

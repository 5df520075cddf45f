#include "client/ui/ServerChooser.h"

#include <poll.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <iterator>
#include <utility>

#include "client/terminal/Screen.h"
#include "client/terminal/TerminalGuard.h"

namespace naiad {
namespace {

int millisUntil(std::chrono::steady_clock::time_point time) {
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(time - std::chrono::steady_clock::now());
  return std::max(0, static_cast<int>(left.count()));
}

}  // namespace

ServerChooser::ServerChooser(Options options)
    : m_options(std::move(options)),
      m_menu(m_options.fetch ? "Servers in the list" : "Servers in this network") {
  if (m_options.fetch) return;
  m_browser.emplace();
  m_menu.setEmpty({std::begin(kNoServersFound), std::end(kNoServersFound)});
}

ServerChooser::~ServerChooser() = default;

ServerChooser::Outcome ServerChooser::run() {
  acquireTerminal();
  refresh(std::chrono::steady_clock::now());
  while (!m_done) {
    if (m_browser) m_browser->update(std::chrono::steady_clock::now());
    if (m_dirty) draw();
    wait();
  }
  m_guard->restore();
  return m_outcome;
}

void ServerChooser::acquireTerminal() {
  m_guard = std::make_unique<TerminalGuard>(TerminalGuard::Options{.mouse = false});
  m_screen =
      std::make_unique<Screen>(Screen::Options{m_options.terminal.name, m_options.ascii, m_options.colors});
  m_guard->onRestore([this] { m_screen->end(); });
  m_guard->installHandlers();
  draw();
  m_guard->enterModes();
}

/// Waits for keys, signals, answers or the next deadline, and handles them.
void ServerChooser::wait() {
  std::vector<pollfd> waited{{STDIN_FILENO, POLLIN, 0}, {m_guard->signalFd(), POLLIN, 0}};
  std::optional<Time> next = m_decoder.deadline();
  if (m_browser) {
    for (const int descriptor : m_browser->descriptors()) waited.push_back({descriptor, POLLIN, 0});
    next = std::min(next.value_or(Time::max()), m_browser->nextQuery());
    if (m_searching) next = std::min(*next, m_begun + LanBrowser::kResponseTimeout);
  }
  ::poll(waited.data(), waited.size(), next ? millisUntil(*next) : -1);
  const Time now = std::chrono::steady_clock::now();
  if (waited[1].revents != 0) handleSignals();
  if (waited[0].revents != 0 && !m_done) readKeys(now);
  handleEvents(m_decoder.flush(now), now);
  if (m_browser) receiveAnswers(now);
}

void ServerChooser::receiveAnswers(Time now) {
  if (m_browser->receiveAnswers()) {
    m_menu.setServers(m_browser->servers().sorted());
    m_dirty = true;
  }
  if (!m_searching || now < m_begun + LanBrowser::kResponseTimeout) return;
  m_searching = false;
  m_menu.setSearching(false);
  m_dirty = true;
}

void ServerChooser::readKeys(Time now) {
  std::array<char, 4096> bytes{};
  const ssize_t count = ::read(STDIN_FILENO, bytes.data(), bytes.size());
  if (count < 0 && (errno == EINTR || errno == EAGAIN)) return;
  if (count <= 0) m_done = true;  // the terminal is gone
  if (count > 0) handleEvents(m_decoder.feed({bytes.data(), static_cast<std::size_t>(count)}, now), now);
}

void ServerChooser::handleEvents(const std::vector<TerminalEvent>& events, Time now) {
  for (const TerminalEvent& event : events) {
    const auto* p_key = std::get_if<KeyEvent>(&event);
    if (p_key == nullptr || m_done) continue;
    using Result = ServerMenu::Result;
    const Result result = m_menu.handleKey(*p_key);
    if (result == Result::kRefresh) refresh(now);
    if (result == Result::kSuspend) suspend();
    if (result == Result::kJoin) m_outcome.server = *m_menu.chosen();
    m_done = m_done || result == Result::kJoin || result == Result::kLeave;
    m_dirty = m_dirty || result == Result::kRedraw;
  }
}

void ServerChooser::handleSignals() {
  std::array<unsigned char, 64> signals{};
  const ssize_t count = ::read(m_guard->signalFd(), signals.data(), signals.size());
  for (ssize_t i = 0; i < count; ++i) {
    const int signal = signals[static_cast<std::size_t>(i)];
    if (signal == SIGTSTP && !m_done) suspend();
    if (signal == SIGWINCH || signal == SIGCONT) {
      m_screen->readSize();
      m_screen->redrawAll();
      m_dirty = true;
    }
    if (signal != SIGINT && signal != SIGTERM && signal != SIGHUP) continue;
    m_done = true;
    if (signal != SIGINT) m_outcome.signal = signal;
  }
}

void ServerChooser::refresh(Time now) {
  m_menu.setServers({});
  m_menu.setSearching(true);
  m_begun = now;
  m_searching = true;
  m_dirty = true;
  m_browser ? m_browser->restart() : fetch();
}

void ServerChooser::fetch() {
  draw();
  const auto fetched = m_options.fetch();
  if (const auto* p_problem = std::get_if<DownloadError>(&fetched)) {
    m_menu.setEmpty({p_problem->message});
  } else {
    m_menu.setEmpty({"The list has no servers."});
    m_menu.setServers(std::get<DiscoveredServers>(fetched).sorted());
  }
  m_menu.setSearching(false);
  m_dirty = true;
}

void ServerChooser::suspend() {
  m_guard->leaveModes();
  m_screen->end();
  m_guard->setOriginalMode();
  if (!m_guard->stopProcess()) {
    m_done = true;
    return handleSignals();
  }
  m_guard->setRawMode();
  m_screen->readSize();
  m_screen->redrawAll();
  draw();
  m_guard->enterModes();
}

void ServerChooser::draw() {
  m_screen->show(m_menu.compose(m_screen->columns(), m_screen->rows()));
  m_dirty = false;
}

}  // namespace naiad

#include "server/replay/RoundPlayer.h"

#include <langinfo.h>
#include <locale.h>
#include <poll.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "client/terminal/Screen.h"
#include "client/terminal/TerminalGuard.h"
#include "client/terminal/TerminalType.h"

namespace naiad {
namespace {

std::size_t cellsOf(const std::vector<WorldPicture>& pictures) {
  std::size_t cells = 1;
  for (const WorldPicture& picture : pictures)
    cells +=
        static_cast<std::size_t>(picture.canvas.width()) * static_cast<std::size_t>(picture.canvas.height());
  return cells;
}

std::uint32_t countTurns(const RecordedRound& round) {
  const auto reader = round.read();
  std::uint32_t count = 0;
  while (const auto record = reader->next()) count += std::holds_alternative<WorldTurn>(*record) ? 1 : 0;
  return count;
}

/// Minimum time between two shown pictures. At high speeds, some pictures are skipped.
constexpr std::chrono::milliseconds kFrameInterval{16};

}  // namespace

FrameHistory::FrameHistory(const RecordedRound& round, const ReplayEnvironment& environment)
    : m_round(round),
      m_environment(environment),
      m_replay(std::make_unique<Replay>(round, environment)),
      m_count(countTurns(round)) {}

const FrameHistory::Frame* FrameHistory::find(std::uint32_t tick) const {
  if (m_frames.empty() || tick < m_frames.front().tick || tick > m_frames.back().tick) return nullptr;
  return &m_frames[tick - m_frames.front().tick];
}

const std::vector<WorldPicture>& FrameHistory::pictures() const {
  static const std::vector<WorldPicture> none;
  const Frame* p_frame = find(m_tick);
  return p_frame != nullptr ? p_frame->pictures : none;
}

std::uint32_t FrameHistory::seek(std::uint32_t tick) {
  tick = std::max(tick, 1u);
  if (find(tick) == nullptr) executeTo(tick);
  if (find(tick) != nullptr) {
    m_tick = tick;
  } else if (!m_frames.empty()) {
    m_tick = m_frames.back().tick;
  }
  return m_tick;
}

void FrameHistory::executeTo(std::uint32_t tick) {
  if (tick <= m_replay->tick()) {
    m_replay = std::make_unique<Replay>(m_round, m_environment);
    m_frames.clear();
    m_cells = 0;
  }
  while (m_replay->tick() < tick) {
    const bool wanted = m_replay->tick() + kRewindTicks >= tick || m_replay->tick() + kRewindTicks >= m_count;
    if (!m_replay->step(wanted)) return;
    if (wanted) storeFrame();
  }
}

void FrameHistory::storeFrame() {
  if (!m_frames.empty() && m_frames.back().tick + 1 != m_replay->tick()) {
    m_frames.clear();
    m_cells = 0;
  }
  m_frames.push_back({m_replay->tick(), m_replay->pictures()});
  m_cells += cellsOf(m_frames.back().pictures);
  for (; m_cells > kMaxCells && m_frames.size() > 1; m_frames.pop_front())
    m_cells -= cellsOf(m_frames.front().pictures);
}

RoundControls::RoundControls(FrameHistory& history, std::uint64_t frame_nanos, std::uint32_t player, Time now,
                             std::uint32_t from)
    : m_history(history),
      m_frame_nanos(std::max<std::uint64_t>(frame_nanos, 1'000'000)),
      m_player(player),
      m_since(now) {
  m_from = std::max(m_history.seek(std::max(from, 1u)), 1u);
}

double RoundControls::ticksPerNano() const {
  return std::ldexp(1.0, m_speed) / static_cast<double>(m_frame_nanos);
}

bool RoundControls::update(Time now) {
  if (m_paused) return false;
  const std::chrono::nanoseconds passed = now - m_since;
  const auto wanted =
      m_from + static_cast<std::uint32_t>(static_cast<double>(passed.count()) * ticksPerNano());
  if (wanted <= m_history.tick()) return false;
  const std::uint32_t before = m_history.tick();
  m_history.seek(std::min(wanted, std::max(m_history.count(), 1u)));
  if (m_history.tick() >= m_history.count() || m_history.tick() < wanted) m_paused = true;  // the end
  return m_history.tick() != before || m_paused;
}

RoundControls::Time RoundControls::deadline(Time now) const {
  if (m_paused) return now + std::chrono::hours(1);
  const double ticks = m_history.tick() + 1.0 - m_from;
  const auto due = m_since + std::chrono::nanoseconds(static_cast<std::int64_t>(ticks / ticksPerNano()));
  return std::max(due, now + std::chrono::milliseconds(1));
}

bool RoundControls::handleKey(const KeyEvent& key, Time now) {
  if (key.action == KeyEvent::Action::kRelease) return true;
  const auto five = static_cast<std::int64_t>(kJumpNanos / m_frame_nanos);
  if (key.ch == U'q' || key.key == df::Keyboard::ESCAPE) return false;
  if (key.key == df::Keyboard::C && (key.modifiers & kControl) != 0) return false;
  if (key.key == df::Keyboard::SPACE || key.ch == U' ') {
    m_paused = !m_paused;
    seekTo(m_history.tick(), now);
  } else if (key.key == df::Keyboard::LEFTARROW) {
    jump(-five, now);
  } else if (key.key == df::Keyboard::RIGHTARROW) {
    jump(five, now);
  } else if (key.ch == U'.' || key.ch == U',') {
    m_paused = true;
    jump(key.ch == U'.' ? 1 : -1, now);
  } else if (key.ch == U'+' || key.ch == U'=') {
    changeSpeed(1, now);
  } else if (key.ch == U'-') {
    changeSpeed(-1, now);
  } else if (key.key == df::Keyboard::TAB) {
    switchPlayer();
  }
  return true;
}

void RoundControls::jump(std::int64_t ticks, Time now) {
  const std::int64_t last = std::max<std::int64_t>(m_history.count(), 1);
  seekTo(static_cast<std::uint32_t>(std::clamp<std::int64_t>(m_history.tick() + ticks, 1, last)), now);
}

void RoundControls::seekTo(std::uint32_t tick, Time now) {
  m_from = m_history.seek(tick);
  m_since = now;
}

void RoundControls::changeSpeed(int by, Time now) {
  m_speed = std::clamp(m_speed + by, kMinSpeed, kMaxSpeed);
  m_from = m_history.tick();
  m_since = now;
}

void RoundControls::switchPlayer() {
  const WorldPicture* p_shown = shown();
  if (p_shown == nullptr) return;
  const std::vector<WorldPicture>& all = m_history.pictures();
  const auto at = static_cast<std::size_t>(p_shown - all.data());
  m_player = all[(at + 1) % all.size()].player;
}

const WorldPicture* RoundControls::shown() const {
  const std::vector<WorldPicture>& all = m_history.pictures();
  for (const WorldPicture& picture : all) {
    if (picture.player == m_player) return &picture;
  }
  return all.empty() ? nullptr : &all.front();
}

std::string RoundControls::status() const {
  const double seconds = static_cast<double>(m_frame_nanos) * m_history.tick() / 1e9;
  const auto whole = static_cast<long>(seconds);
  char text[200];
  const WorldPicture* p_shown = shown();
  const std::string eyes = p_shown != nullptr ? "player " + std::to_string(p_shown->player) : "no player";
  const std::string speed = m_speed < 0 ? "1/" + std::to_string(1 << -m_speed) : std::to_string(1 << m_speed);
  std::snprintf(text, sizeof text, " %s  %ld:%02ld  tick %u of %u  x%s  %s%s",
                m_paused ? "paused" : "playing", whole / 60, whole % 60, m_history.tick(), m_history.count(),
                speed.c_str(), eyes.c_str(), m_history.firstDifference() != 0 ? "  (not as recorded)" : "");
  return text;
}

ScreenBuffer RoundControls::compose(int columns, int rows) const {
  ScreenBuffer picture(columns, rows);
  const int line = rows - 1;
  if (const WorldPicture* p_shown = shown()) {
    const df::Canvas& canvas = p_shown->canvas;
    for (int y = 0; y < std::min(canvas.height(), line); ++y) {
      for (int x = 0; x < std::min(canvas.width(), columns); ++x)
        picture.put(x, y, {canvas.at(x, y).ch, canvas.at(x, y).color});
    }
  }
  picture.fill(0, line, columns, 1, Style::kReverse);
  picture.write(0, line, status(), columns, df::COLOR_DEFAULT, Style::kReverse);
  return picture;
}

// ---- RoundPlayer, which uses the terminal -----------------------------------------------------------------

bool RoundPlayer::hasTerminal() {
  return TerminalGuard::isTerminal();
}

void RoundPlayer::run() {
  using Clock = std::chrono::steady_clock;
  setlocale(LC_CTYPE, "");
  const TerminalType type = chooseTerminalType(std::getenv("TERM"));
  FrameHistory history(m_round, m_environment);
  TerminalGuard guard(TerminalGuard::Options{false});
  Screen screen(
      {type.name, std::strcmp(nl_langinfo(CODESET), "UTF-8") != 0, std::getenv("NO_COLOR") == nullptr});
  guard.onRestore([&screen] { screen.end(); });
  guard.installHandlers();
  guard.enterModes();
  InputDecoder decoder;
  RoundControls controls(history, m_round.header().frame_nanos, m_player, Clock::now(), m_from);
  Clock::time_point shown_at;
  bool is_running = true;
  bool changed = true;
  while (is_running) {
    Clock::time_point now = Clock::now();
    changed = controls.update(now) || changed;
    if (changed && now - shown_at >= kFrameInterval) {
      screen.show(controls.compose(screen.columns(), screen.rows()));
      shown_at = now;
      changed = false;
    }
    Clock::time_point until = controls.deadline(now);
    if (changed) until = std::min(until, shown_at + kFrameInterval);
    if (const auto due = decoder.deadline()) until = std::min(until, *due);
    const auto wait = std::chrono::ceil<std::chrono::milliseconds>(until - now).count();
    pollfd either[2] = {{STDIN_FILENO, POLLIN, 0}, {guard.signalFd(), POLLIN, 0}};
    poll(either, 2, static_cast<int>(std::clamp<long>(wait, 0, 1000)));
    now = Clock::now();
    std::vector<TerminalEvent> events = decoder.flush(now);
    if (either[0].revents != 0) {
      std::array<char, 256> bytes{};
      const ssize_t count = read(STDIN_FILENO, bytes.data(), bytes.size());
      if (count <= 0) break;
      const auto more = decoder.feed({bytes.data(), static_cast<std::size_t>(count)}, now);
      events.insert(events.end(), more.begin(), more.end());
    }
    for (const TerminalEvent& event : events) {
      const auto* p_key = std::get_if<KeyEvent>(&event);
      if (p_key == nullptr) continue;
      is_running = is_running && controls.handleKey(*p_key, now);
      changed = true;
    }
    if (either[1].revents != 0) {
      char signal = 0;
      if (read(guard.signalFd(), &signal, 1) == 1) is_running = is_running && signal == SIGWINCH;
    }
    if (screen.readSize()) changed = true;
  }
  guard.restore();
}

}  // namespace naiad

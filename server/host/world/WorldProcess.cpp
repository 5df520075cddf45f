#include "host/world/WorldProcess.h"

#include <poll.h>
#include <signal.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <asio/buffer.hpp>
#include <asio/read.hpp>
#include <asio/write.hpp>
#include <cstdio>
#include <utility>

#include "host/world/ActivityReader.h"
#include "host/world/BuildId.h"
#include "host/world/TurnRecord.h"
#include "shared/program/ProcessSetup.h"
#include "shared/values/FastHash.h"

namespace naiad {

namespace {

/// Maximum time that one check adds. If more has passed, the host itself was late, not the world.
constexpr std::chrono::milliseconds kMaxBetweenChecks{100};

/// Reason of the end if the game called exit() in a handler, instead of GM.setGameOver().
constexpr const char* kExited = "called exit()";

/// Time limit for a supervisor to end a world and its descendants.
constexpr int kKillMillis = 5'000;

std::string nameOf(int signal) {
  const char* p_name = sigabbrev_np(signal);
  return p_name != nullptr ? "SIG" + std::string(p_name) : std::to_string(signal);
}

/// Returns a text like "1" or "0.25".
std::string secondsText(std::chrono::nanoseconds time) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", std::chrono::duration<double>(time).count());
  return text;
}

/// Maps the page read-only, and closes `file`. Returns null if there is no page.
const df::ActivityPage* mapPage(int file) {
  if (file < 0) return nullptr;
  void* p_memory = mmap(nullptr, sizeof(df::ActivityPage), PROT_READ, MAP_SHARED, file, 0);
  ::close(file);
  return p_memory != MAP_FAILED ? static_cast<const df::ActivityPage*>(p_memory) : nullptr;
}

}  // namespace

std::uint64_t hashAnswer(std::string_view fields) {
  FastHash hash;
  hash.bytes(fields);
  return hash.value();
}

WorldProcess::WorldProcess(asio::io_context& home, const StartedWorld& started, OutputRelay::Line print)
    : m_socket(home, asio::local::stream_protocol(), started.socket),
      m_supervisor(started.supervisor),
      m_print(std::move(print)),
      m_output(started.output,
               [this](const std::string& line) {
                 if (m_print && !m_repeats) m_print(line);
               }),
      m_p_page(mapPage(started.page)),
      m_hang_time(started.hang_time),
      m_checked_at(Clock::now()),
      m_hashes(started.hashes),
      m_checkpoints(started.copies),
      m_repeats(started.repeats) {
  readHead();
}

WorldProcess::~WorldProcess() {
  waitForSupervisor();
  ::close(m_supervisor);
  if (m_p_page != nullptr) munmap(const_cast<df::ActivityPage*>(m_p_page), sizeof *m_p_page);
}

// Ends the world and all copies: the supervisor handles this like the end of the host.
void WorldProcess::kill() {
  ::shutdown(m_supervisor, SHUT_WR);
}

/// Returns nullopt without a message. If the supervisor has ended, a world without a status counts as killed.
template <class Message>
std::optional<Message> WorldProcess::receiveFromSupervisor(int timeout_millis) {
  pollfd readable{m_supervisor, POLLIN, 0};
  if (::poll(&readable, 1, timeout_millis) <= 0) return std::nullopt;
  Message message;
  if (::recv(m_supervisor, &message, sizeof message, MSG_DONTWAIT) == sizeof message) return message;
  if (!m_status) m_status = SIGKILL;  // as if it had been killed
  m_supervisor_state = SupervisorState::kEnded;
  return std::nullopt;
}

void WorldProcess::readSupervisor(int timeout_millis) {
  if (m_supervisor_state == SupervisorState::kStarting) {
    const auto start = receiveFromSupervisor<WorldStartReport>(timeout_millis);
    if (!start) return;
    m_supervisor_state = SupervisorState::kWatching;
    m_process = start->process;
    if (start->error != 0) {
      m_failure = WorldEnd{WorldEnd::kCrashed, "could not be started: " + errorText(start->error)};
    }
  }
  if (m_supervisor_state == SupervisorState::kEnded) return;
  const auto end = receiveFromSupervisor<WorldExitReport>(timeout_millis);
  if (!end) return;
  if (end->kind == WorldExitReport::kRest) {
    m_supervisor_state = SupervisorState::kWatching;
    return;
  }
  if (!m_status) m_status = end->status;
  if (end->kind == WorldExitReport::kAll) m_supervisor_state = SupervisorState::kEnded;
}

void WorldProcess::waitForSupervisor() {
  if (m_supervisor_state == SupervisorState::kEnded) return;
  kill();
  const auto end = Clock::now() + std::chrono::milliseconds(kKillMillis);
  while (m_supervisor_state != SupervisorState::kEnded && Clock::now() < end) {
    const auto rest = std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now());
    readSupervisor(static_cast<int>(std::max<std::int64_t>(rest.count(), 0)));
  }
}

// ---- sending turns ----------------------------------------------------------------------------------------

void WorldProcess::tick(const SentTurn& turn) {
  if (m_state >= State::kEnding) return;  // one of the turns sent ahead has failed
  if (!std::exchange(m_began, true)) {
    m_tick_offset = m_next_tick - 1;
    m_views.emplace(m_tick_offset);
  }
  ++m_next_tick;
  if (turn.record.empty()) return fail(WorldEnd::kBroken, "was sent too many inputs in one tick");
  appendTurnMessage(turn.record, m_copied && m_unanswered == 0, m_unsent);
  if (m_unanswered++ == 0) beginTick();
  sendTurns();
}

void WorldProcess::beginTick() {
  m_state = State::kTicking;
  m_waited = {};
  m_stall.restart();
  m_slow_tick.beginTick(m_process);
  m_warned = m_stop_noted = false;
}

// Ignores errors of writing, because reading the answer then fails, too.
void WorldProcess::sendTurns() {
  if (m_unsent.empty() || std::exchange(m_sending, true)) return;
  m_out.swap(m_unsent);
  m_unsent.clear();
  asio::async_write(m_socket, asio::buffer(m_out),
                    [self = std::weak_ptr(m_self)](const asio::error_code& error, std::size_t) {
                      const auto p_self = self.lock();
                      if (p_self == nullptr || error) return;
                      (*p_self)->m_sending = false;
                      (*p_self)->sendTurns();
                    });
}

std::uint32_t WorldProcess::currentTick() const {
  return m_next_tick - std::max(m_unanswered, 1u);
}

// ---- reading answers --------------------------------------------------------------------------------------

void WorldProcess::readHead() {
  m_in.resize(kWorldFrameHead);
  asio::async_read(m_socket, asio::buffer(m_in),
                   [self = std::weak_ptr(m_self)](const asio::error_code& error, std::size_t) {
                     const auto p_self = self.lock();
                     if (p_self == nullptr) return;
                     error ? (*p_self)->closeSocket() : (*p_self)->readFields();
                   });
}

void WorldProcess::readFields() {
  const auto size = loadLittleEndian<std::uint32_t>(m_in.data());
  if (size > kMaxWorldFrame) return fail(WorldEnd::kBroken, "sent a frame that is too long");
  m_in.resize(size);
  asio::async_read(m_socket, asio::buffer(m_in),
                   [self = std::weak_ptr(m_self)](const asio::error_code& error, std::size_t) {
                     const auto p_self = self.lock();
                     if (p_self == nullptr) return;
                     error ? (*p_self)->closeSocket() : (*p_self)->onFrame();
                   });
}

void WorldProcess::onFrame() {
  if (m_state >= State::kEnding) return;
  const bool starts = m_state == State::kStarting;
  if (m_state == State::kReady) return fail(WorldEnd::kBroken, "sent an unexpected frame");
  if (starts) {
    handleReady();
    if (!m_ready) return;
  } else {
    auto answer = readAnswer(m_in, *m_views, m_view);
    if (!answer) return fail(WorldEnd::kBroken, "sent a malformed answer");
    m_answer = *std::move(answer);
    m_answer.hash = m_hashes ? hashAnswer(m_in) : 0;
    if (std::exchange(m_copied, false)) m_checkpoints.add({currentTick() + 1, *m_views, m_view});
    --m_unanswered;
  }
  m_state = State::kReady;
  m_waited = {};
  m_was_slow = m_warned;
  if (m_unanswered > 0) beginTick();
  readHead();
  if (m_answer.game_over) {
    m_state = State::kEnding;
    m_expected = true;
  }
  if (!starts) reportTick();
}

// Refuses a world of another build: after an upgrade, worlds run the new build and this process the old one.
void WorldProcess::handleReady() {
  const auto build = readBuild(m_in);
  if (build && *build != ownBuildId())
    return fail(WorldEnd::kForeign, "has another build (" + build->substr(0, kShownBuildId) + ")");
  m_ready = readReady(m_in);
  if (!m_ready) fail(WorldEnd::kBroken, "sent a malformed answer");
}

// ---- its end ----------------------------------------------------------------------------------------------

void WorldProcess::close(const WorldTurn& /*rest*/) {
  m_expected = true;
  closeSocket();
}

void WorldProcess::closeSocket() {
  if (m_state >= State::kEnding) return;
  m_state = State::kEnding;
  m_waited = {};
  asio::error_code ignored;
  m_socket.shutdown(asio::local::stream_protocol::socket::shutdown_both, ignored);
}

void WorldProcess::fail(WorldEnd::Why why, const std::string& text) {
  if (!m_failure) m_failure = WorldEnd{why, text};
  closeSocket();
  killWorld();
}

// Kills only the world's process if there may be copies, because one of them may take over.
void WorldProcess::killWorld() {
  if (!m_checkpoints.isOn()) return kill();
  const SupervisorCommand request{SupervisorCommand::kEndWorld};
  ::send(m_supervisor, &request, sizeof request, MSG_NOSIGNAL | MSG_DONTWAIT);
}

std::chrono::nanoseconds WorldProcess::answerTimeout() const {
  const std::chrono::nanoseconds most = m_hang_time * kAnswerTimeoutFactor;
  switch (m_state) {
    case State::kStarting:
      return kStartTime;
    case State::kTicking:
      return isInFirstTick() ? std::max<std::chrono::nanoseconds>(most, kStartTime) : most;
    case State::kEnding:
      return kEndTime;
    case State::kReady:
      if (m_supervisor_state == SupervisorState::kStarting) return kStartTime;
      break;
    case State::kEnded:
      break;
  }
  return std::chrono::nanoseconds::max();
}

bool WorldProcess::isFailedEarly() const {
  return m_state == State::kTicking && m_fast_failover && !isInFirstTick() && m_stall.own() > m_hang_time &&
         m_checkpoints.hasCheckpoint();
}

void WorldProcess::checkProcess(std::uint32_t tick) {
  if (!m_began) m_next_tick = std::max(tick, 1u);
  if (m_state == State::kEnded) return;
  const Clock::time_point now = Clock::now();
  m_output.update(now);
  countTime(now);
  if (m_checkpoints.isOn()) m_checkpoints.update();
  if (!m_status) {
    readSupervisor(0);
    if (m_status) m_waited = {};
  }
  // Finishes only when the last frames of the world have been read, or after kEndTime.
  if (m_status && (m_state == State::kEnding || m_waited > kEndTime)) return finish(*m_status);
  warnOfHang();
  if (isFailedEarly())
    return fail(WorldEnd::kHung, "did not answer within " + secondsText(m_hang_time) + " s");
  if (m_waited <= answerTimeout()) return;
  if (m_state == State::kEnding) return kill();
  fail(WorldEnd::kHung, m_state == State::kStarting ? "did not start" : "did not answer in time");
}

void WorldProcess::countTime(Clock::time_point now) {
  const auto passed = std::min<std::chrono::nanoseconds>(now - m_checked_at, kMaxBetweenChecks);
  m_checked_at = now;
  if (m_state != State::kTicking) {
    m_waited += passed;
    return;
  }
  m_stall.add(passed, [this] { return readProcessRunState(m_process); });
  m_waited = m_stall.counted();
}

void WorldProcess::warnOfHang() {
  if (m_state != State::kTicking) return;
  if (m_print && !m_repeats && !isInFirstTick() && m_ready) {
    const std::string line =
        m_slow_tick.check(m_process, currentTick(), m_waited,
                          std::chrono::milliseconds(m_ready->frame_millis), activity("handles"));
    if (!line.empty()) m_print(line);
  }
  const std::string tick = "tick " + std::to_string(currentTick());
  if (m_stall.stopped() >= m_hang_time && !std::exchange(m_stop_noted, true))
    m_warning = "the game is stopped in " + tick + ", by a debugger or a signal, and all players wait";
  if (m_waited < m_hang_time || std::exchange(m_warned, true)) return;
  m_warning = "the game has not finished " + tick + " for " + secondsText(m_hang_time) +
              " s: it hangs, and all players wait" + activity("handles");
}

void WorldProcess::finish(int status) {
  m_state = State::kEnded;
  m_output.finish(Clock::now());
  asio::error_code ignored;
  m_socket.close(ignored);
  m_end = m_failure ? *m_failure : endOf(status);
  if (m_end->why != WorldEnd::kCrashed && m_end->why != WorldEnd::kHung) waitForSupervisor();
  if (m_end->why == WorldEnd::kGameOver || m_end->why == WorldEnd::kForeign) return;
  m_end->when = when();
  m_end->last_lines = lastLines();
}

// ---- copies -----------------------------------------------------------------------------------------------

bool WorldProcess::requestCheckpoint() {
  m_copied = m_state == State::kReady && canRequestCheckpoint() && m_checkpoints.request(m_process);
  return m_copied;
}

std::chrono::nanoseconds WorldProcess::cpuTime() const {
  const auto look = readProcessRunState(m_process);
  return look ? look->cpu : std::chrono::nanoseconds(0);
}

std::optional<std::uint32_t> WorldProcess::resumeFromCheckpoint() {
  if (m_state != State::kEnded) return std::nullopt;
  readSupervisor(0);  // the supervisor may have been killed
  while (auto copy =
             m_supervisor_state == SupervisorState::kEnded ? std::nullopt : m_checkpoints.popNewest()) {
    if (!commandResume(*copy)) {
      ::close(copy->socket);
      continue;
    }
    switchTo(*std::move(copy));
    return m_next_tick - 1 - m_tick_offset;
  }
  waitForSupervisor();
  return std::nullopt;
}

bool WorldProcess::commandResume(const WorldCheckpoint& copy) {
  SupervisorCommand request{SupervisorCommand::kResume, copy.process};
  std::size_t at = 0;
  for (const pid_t other : m_checkpoints.processes()) {
    if (at < request.kept.size()) request.kept[at++] = other;
  }
  return ::send(m_supervisor, &request, sizeof request, MSG_NOSIGNAL | MSG_DONTWAIT) == sizeof request;
}

void WorldProcess::switchTo(WorldCheckpoint copy) {
  m_self = std::make_shared<WorldProcess*>(this);  // ignores handlers of the old socket
  m_socket.assign(asio::local::stream_protocol(), copy.socket);
  m_process = copy.process;
  m_supervisor_state = SupervisorState::kClearing;
  m_next_tick = copy.state.next_tick;
  m_views = std::move(copy.state.views);
  m_view = std::move(copy.state.view);
  m_answer = {};
  m_status.reset();
  m_failure.reset();
  m_end.reset();
  m_warning.reset();
  m_expected = m_copied = m_sending = m_fast_failover = false;
  m_unanswered = 0;
  m_unsent.clear();
  m_repeats = true;
  m_waited = {};
  m_state = State::kReady;
  readHead();
}

void WorldProcess::endReplay() {
  m_output.update(Clock::now());
  m_repeats = false;
}

WorldEnd WorldProcess::endOf(int status) const {
  if (WIFSIGNALED(status) && !(m_expected && WTERMSIG(status) == SIGKILL))
    return {WorldEnd::kCrashed, "crashed (" + nameOf(WTERMSIG(status)) + ")"};
  if (WIFEXITED(status) && WEXITSTATUS(status) != 0)
    return {WorldEnd::kCrashed, "ended with code " + std::to_string(WEXITSTATUS(status)),
            WEXITSTATUS(status)};
  return {WorldEnd::kGameOver, m_unanswered > 0 && !m_expected && WIFEXITED(status) ? kExited : "is over"};
}

// Returns the time with the host's tick numbers, like other lines of the log.
std::string WorldProcess::when() const {
  if (!m_began) return {};
  const std::string number = std::to_string(currentTick());
  return m_unanswered > 0 ? "in tick " + number + activity("handled") : "after tick " + number;
}

std::string WorldProcess::activity(std::string_view verb) const {
  return m_p_page != nullptr ? std::string(describeActivity(*m_p_page, verb).view()) : std::string();
}

std::vector<std::string> WorldProcess::lastLines() const {
  std::vector<std::string> lines;
  for (std::size_t back = df::ActivityPage::kLines; m_p_page != nullptr && back-- > 0;) {
    if (const ActivityText line = logLine(*m_p_page, back); !line.empty()) lines.emplace_back(line.view());
  }
  return lines;
}

}  // namespace naiad

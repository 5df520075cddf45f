#include "server/replay/Replay.h"

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <utility>

#include "host/rounds/RoundJournals.h"
#include "host/world/WorldFrame.h"
#include "host/world/WorldProcess.h"
#include "shared/net/base/SafeText.h"

namespace naiad {
namespace {

constexpr std::size_t kMaxPrinted = 4096;

constexpr const char* kEnded = "ended";

/// Time limit for the supervisor's report of the world's end. The supervisor first ends all processes that
/// the world has started.
constexpr int kExitReportTimeoutMillis = 2000;

}  // namespace

ReplayWorld::ReplayWorld(const WorldLauncher& launcher, const WorldStartOptions& order)
    : m_started(launcher.start(order)) {
  if (receiveFrame()) m_ready = readReady(m_answer);
  // The supervisor sends this before the world's program is executed.
  WorldStartReport begun;
  if (m_ready && recv(m_started.supervisor, &begun, sizeof begun, MSG_WAITALL) == sizeof begun)
    m_process = begun.process;
  if (!m_ready && m_failure.empty()) m_failure = "sent a malformed answer";
}

ReplayWorld::~ReplayWorld() {
  for (const int one : {m_started.socket, m_started.supervisor, m_started.output, m_started.page}) close(one);
}

std::optional<std::string_view> ReplayWorld::step(const WorldTurn& turn) {
  if (!m_failure.empty()) return std::nullopt;
  std::string record;
  std::string message;
  m_turns.write(turn, record);  // cannot fail, because a turn of a file is never too long
  appendTurnMessage(record, false, message);
  if (!send(message) || !receiveFrame()) return std::nullopt;
  return m_answer;
}

// Also reads the world's output, because the world blocks when the pipe is full.
bool ReplayWorld::wait(short events) {
  const auto end = std::chrono::steady_clock::now() + kResponseTimeout;
  while (true) {
    pollfd any[3] = {
        {m_started.socket, events, 0}, {m_started.output, POLLIN, 0}, {m_cancel_descriptor, POLLIN, 0}};
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
    if (m_cancel_descriptor < 0 && left.count() <= 0) break;
    if (poll(any, 3, m_cancel_descriptor < 0 ? static_cast<int>(left.count()) : -1) < 0) continue;
    if (any[1].revents != 0) readOutput();
    if (any[0].revents != 0) return true;
    if (any[2].revents != 0) break;
  }
  m_failure = "stopped answering";
  return false;
}

std::optional<int> ReplayWorld::popExitStatus() {
  pollfd supervisor{m_started.supervisor, POLLIN, 0};
  WorldExitReport end;
  if (m_failure != kEnded || poll(&supervisor, 1, kExitReportTimeoutMillis) <= 0) return std::nullopt;
  if (recv(m_started.supervisor, &end, sizeof end, MSG_WAITALL) != sizeof end) return std::nullopt;
  return end.status;
}

void ReplayWorld::readOutput() {
  std::array<char, 4096> part{};
  const ssize_t count = read(m_started.output, part.data(), part.size());
  if (count < 0 && (errno == EAGAIN || errno == EINTR)) return;
  if (count <= 0) {
    close(std::exchange(m_started.output, -1));
    return;
  }
  m_printed.append(part.data(), static_cast<std::size_t>(count));
  if (m_printed.size() > kMaxPrinted) m_printed.erase(0, m_printed.size() - kMaxPrinted);
}

bool ReplayWorld::send(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::send(m_started.socket, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (count >= 0) {
      bytes.remove_prefix(static_cast<std::size_t>(count));
    } else if (errno == EAGAIN) {
      if (!wait(POLLOUT)) return false;
    } else if (errno != EINTR) {
      m_failure = kEnded;
      return false;
    }
  }
  return true;
}

bool ReplayWorld::receive(char* p_to, std::size_t count) {
  while (count > 0) {
    const ssize_t got = recv(m_started.socket, p_to, count, MSG_DONTWAIT);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0 && errno == EAGAIN) {
      if (!wait(POLLIN)) return false;
      continue;
    }
    if (got <= 0) {
      m_failure = kEnded;
      return false;
    }
    p_to += got;
    count -= static_cast<std::size_t>(got);
  }
  return true;
}

bool ReplayWorld::receiveFrame() {
  char head[kWorldFrameHead];
  if (!receive(head, sizeof head)) return false;
  const auto size = loadLittleEndian<std::uint32_t>(head);
  if (size > kMaxWorldFrame) {
    m_failure = "sent an oversized frame";
    return false;
  }
  m_answer.resize(size);
  return receive(m_answer.data(), size);
}

Replay::Replay(const RecordedRound& round, const ReplayEnvironment& environment)
    : m_reader(round.read()), m_world(environment.launcher(), environment.order()) {
  if (!m_world.ready())
    throw RoundError("The game " + m_world.failure() + " before it was ready. " +
                     safeText(m_world.printed(), 500));
  compareFiles(round);
  readAhead();
}

void Replay::compareFiles(const RecordedRound& round) {
  for (const ReadFile& file : m_world.ready()->files) {
    const std::string recorded = round.fact(kFactFile + file.name);
    char now[17];
    std::snprintf(now, sizeof now, "%016llx", static_cast<unsigned long long>(file.hash));
    if (recorded != now) m_changed_files.push_back(file.name);
  }
}

// Skips sessions, which only a server that resumes the round needs.
void Replay::readAhead() {
  do m_next = m_reader->next();
  while (m_next && std::holds_alternative<PersistedSession>(*m_next));
}

bool Replay::nextTurn() {
  while (m_next && !std::holds_alternative<WorldTurn>(*m_next)) readAhead();
  if (!m_next) return false;
  m_turn = std::get<WorldTurn>(std::move(*m_next));
  readAhead();
  if (m_next && std::holds_alternative<InputsDropped>(*m_next)) {
    if (m_tick + 1 != m_restored_tick) dropKeys(m_turn);
    readAhead();
  }
  return true;
}

bool Replay::step(bool pictures) {
  if (!m_failure.empty() || !nextTurn()) return false;
  ++m_tick;
  m_differs = false;
  m_pictures.clear();
  m_scores.clear();
  m_recorded.reset();
  const bool exact = !pictures || (m_turn.wants_truth && m_turn.rendered_player == 0);
  WorldTurn turn = m_turn;
  if (!exact) {
    turn.wants_truth = true;
    turn.rendered_player = 0;
  }
  const auto answer = m_world.step(turn);
  if (!answer) {
    // If the file has no result of this turn, the recorded world ended here, too.
    if (m_next) {
      recordDifference("the world's end");
      m_failure = m_world.failure();
    }
    return false;
  }
  consumeTickRecords(*answer, exact);
  if (turn.wants_truth || m_reads_scores) {
    if (auto head = readAnswerHead(*answer)) {
      m_pictures = std::move(head->pictures);
      m_scores = std::move(head->scores);
    }
  }
  return true;
}

/// Handles the records that follow the turn in the file: its result and picture.
void Replay::consumeTickRecords(std::string_view answer, bool exact) {
  for (; m_next && !std::holds_alternative<WorldTurn>(*m_next); readAhead()) {
    if (const auto* p_result = std::get_if<TickResult>(&*m_next)) compare(*p_result, answer, exact);
    if (auto* p_picture = std::get_if<RecordedPicture>(&*m_next)) m_recorded = std::move(*p_picture);
  }
}

void Replay::compare(const TickResult& result, std::string_view answer, bool exact) {
  if (exact && result.has_check && checkOf(hashAnswer(answer)) != result.check)
    recordDifference("the world's answer");
  if (!result.state_hash) return;
  const auto head = readAnswerHead(answer);
  if (!head || head->state_hash != result.state_hash) recordDifference("the state");
}

void Replay::recordDifference(const char* what) {
  m_differs = true;
  if (m_first_difference != 0) return;
  m_first_difference = m_tick;
  m_difference_text = what;
}

}  // namespace naiad

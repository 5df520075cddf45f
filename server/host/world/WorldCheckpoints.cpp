#include "host/world/WorldCheckpoints.h"

#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

#include "host/world/DescriptorMessage.h"

namespace naiad {

namespace {

/// Returns the number of threads; 0 if they cannot be counted.
std::size_t countThreads(pid_t process) {
  constexpr nlink_t kOwnLinks = 2;  // "." and the entry in the parent folder
  struct stat facts {};
  if (stat(("/proc/" + std::to_string(process) + "/task").c_str(), &facts) != 0) return 0;
  return facts.st_nlink > kOwnLinks ? facts.st_nlink - kOwnLinks : 0;
}

}  // namespace

WorldCheckpoints::~WorldCheckpoints() {
  stop();
}

void WorldCheckpoints::clear() {
  dropRequested();
  while (!m_checkpoints.empty()) drop(m_checkpoints.size() - 1);
}

void WorldCheckpoints::stop() {
  clear();
  if (m_request_socket >= 0) ::close(std::exchange(m_request_socket, -1));
}

void WorldCheckpoints::drop(std::size_t at) {
  ::close(m_checkpoints[at].socket);
  m_checkpoints.erase(m_checkpoints.begin() + static_cast<std::ptrdiff_t>(at));
}

void WorldCheckpoints::dropRequested() {
  if (m_requested >= 0) ::close(std::exchange(m_requested, -1));
}

bool WorldCheckpoints::send(int descriptor) const {
  const char byte = 0;
  return sendDescriptors(m_request_socket, &byte, 1, {&descriptor, 1}, MSG_DONTWAIT);
}

// A copy has only one thread, and locks that other threads held stay locked in it. So copies of a game with
// threads are useless, and those made before the threads were noticed are dropped, too.
bool WorldCheckpoints::request(pid_t world) {
  update();
  dropRequested();
  if (!isOn()) return false;
  if (m_failures >= kMaxFailures) m_problem = "creating them fails";
  if (countThreads(world) > 1) m_problem = "the game has threads, which a copy of its process would lack";
  if (m_problem) {
    stop();
    return false;
  }
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) return false;
  const bool sent = send(ends[1]);
  ::close(ends[1]);
  ++m_failures;  // reset when the copy reports
  sent ? m_requested = ends[0] : ::close(ends[0]);
  return sent;
}

void WorldCheckpoints::add(CheckpointState state) {
  if (m_requested < 0) return;
  m_checkpoints.push_back({std::exchange(m_requested, -1), -1, std::move(state)});
}

/// Reads a copy's message. Returns false if the copy has ended, was never made, or sent anything unexpected.
bool WorldCheckpoints::receive(WorldCheckpoint& copy) {
  std::int32_t process = 0;
  const bool is_known = copy.process > 0;
  char* p_to = reinterpret_cast<char*>(&process);
  const ssize_t got = ::recv(copy.socket, p_to, sizeof process, MSG_DONTWAIT | (is_known ? MSG_PEEK : 0));
  if (got < 0) return errno == EAGAIN || errno == EINTR;
  if (is_known || got != sizeof process || process <= 0) return false;  // an unexpected message
  copy.process = process;
  m_failures = 0;
  return true;
}

// Drops older copies when kMaxCheckpoints newer ones are ready.
void WorldCheckpoints::update() {
  for (std::size_t i = m_checkpoints.size(); i-- > 0;) {
    if (!receive(m_checkpoints[i])) drop(i);
  }
  std::size_t there = 0;
  for (std::size_t i = m_checkpoints.size(); i-- > 0;) {
    if (there >= kMaxCheckpoints) {
      drop(i);
    } else if (m_checkpoints[i].process > 0) {
      ++there;
    }
  }
}

std::optional<WorldCheckpoint> WorldCheckpoints::popNewest() {
  update();
  dropRequested();
  while (!m_checkpoints.empty() && m_checkpoints.back().process <= 0) drop(m_checkpoints.size() - 1);
  if (m_checkpoints.empty()) return std::nullopt;
  WorldCheckpoint newest = std::move(m_checkpoints.back());
  m_checkpoints.pop_back();
  return newest;
}

std::vector<pid_t> WorldCheckpoints::processes() const {
  std::vector<pid_t> found;
  for (const WorldCheckpoint& copy : m_checkpoints) {
    if (copy.process > 0) found.push_back(copy.process);
  }
  return found;
}

}  // namespace naiad

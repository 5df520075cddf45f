#include "host/world/WorldCopies.h"

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

WorldCopies::~WorldCopies() {
  stop();
}

void WorldCopies::clear() {
  dropOrdered();
  while (!m_copies.empty()) drop(m_copies.size() - 1);
}

void WorldCopies::stop() {
  clear();
  if (m_orders >= 0) ::close(std::exchange(m_orders, -1));
}

void WorldCopies::drop(std::size_t at) {
  ::close(m_copies[at].socket);
  m_copies.erase(m_copies.begin() + static_cast<std::ptrdiff_t>(at));
}

void WorldCopies::dropOrdered() {
  if (m_ordered >= 0) ::close(std::exchange(m_ordered, -1));
}

bool WorldCopies::send(int descriptor) const {
  const char byte = 0;
  return sendDescriptors(m_orders, &byte, 1, {&descriptor, 1}, MSG_DONTWAIT);
}

// A copy has one thread, and locks of the others stay locked. So a game with threads has no usable copies,
// and those made before the threads were noticed are dropped, too.
bool WorldCopies::order(pid_t world) {
  update();
  dropOrdered();
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
  ++m_failures;  // until the copy reports
  sent ? m_ordered = ends[0] : ::close(ends[0]);
  return sent;
}

void WorldCopies::add(CopiedState state) {
  if (m_ordered < 0) return;
  m_copies.push_back({std::exchange(m_ordered, -1), -1, std::move(state)});
}

/// Reads a copy's message. Returns false if the copy has ended, or was never made.
bool WorldCopies::hear(WorldCopy& copy) {
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

// Drops older copies when kKept newer ones are ready.
void WorldCopies::update() {
  for (std::size_t i = m_copies.size(); i-- > 0;) {
    if (!hear(m_copies[i])) drop(i);
  }
  std::size_t there = 0;
  for (std::size_t i = m_copies.size(); i-- > 0;) {
    if (there >= kKept) {
      drop(i);
    } else if (m_copies[i].process > 0) {
      ++there;
    }
  }
}

std::optional<WorldCopy> WorldCopies::takeNewest() {
  update();
  dropOrdered();
  while (!m_copies.empty() && m_copies.back().process <= 0) drop(m_copies.size() - 1);
  if (m_copies.empty()) return std::nullopt;
  WorldCopy newest = std::move(m_copies.back());
  m_copies.pop_back();
  return newest;
}

std::vector<pid_t> WorldCopies::processes() const {
  std::vector<pid_t> found;
  for (const WorldCopy& copy : m_copies) {
    if (copy.process > 0) found.push_back(copy.process);
  }
  return found;
}

}  // namespace naiad

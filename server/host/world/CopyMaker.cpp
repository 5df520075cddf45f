#include "host/world/CopyMaker.h"

#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdint>

#include "host/world/DescriptorMessage.h"
#include "host/world/WorldStart.h"

namespace naiad {

namespace {

bool isSocket(int descriptor) {
  struct stat facts {};
  return fstat(descriptor, &facts) == 0 && S_ISSOCK(facts.st_mode);
}

/// Below 0: there is none. Does not wait: the front has sent it before the turn that speaks of it.
int receiveDescriptor(int from) {
  char byte = 0;
  int number = -1;
  return receiveDescriptors(from, &byte, 1, {&number, 1}, MSG_DONTWAIT) == 1 ? number : -1;
}

// Not by fork(): what a library has asked to be called then is for programs that go on in both. The front
// looks for threads before it orders a copy, so no lock is held by one that is missing in it.
long forkBesideItself() {
  return syscall(SYS_clone, static_cast<unsigned long>(CLONE_PARENT | SIGCHLD), nullptr, nullptr, nullptr,
                 nullptr);
}

/// False: it is not wanted any more.
bool waitForTurn(int socket) {
  char byte = 0;
  ssize_t got = 0;
  while ((got = recv(socket, &byte, 1, MSG_PEEK)) < 0 && errno == EINTR) continue;
  return got == 1;
}

void beCopy(int socket, int world_socket, pid_t keeper) {
  constexpr std::size_t kLongestName = 16;
  char name[kLongestName] = {};
  prctl(PR_GET_NAME, name);
  prctl(PR_SET_NAME, "df-copy");  // for who looks at the list of processes
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != keeper) _exit(0);
  setsid();  // what ends the world's group leaves its copies; in a sandbox, where it is refused, it does not
  close(world_socket);
  const std::int32_t self = getpid();
  if (send(socket, &self, sizeof self, MSG_NOSIGNAL) != sizeof self || !waitForTurn(socket)) _exit(0);
  prctl(PR_SET_NAME, name);
}

}  // namespace

CopyMaker::CopyMaker() {
  if (isSocket(kWorldCopies)) m_orders = kWorldCopies;
}

CopyMaker::~CopyMaker() {
  if (m_orders >= 0) close(m_orders);
}

// A world that died before it could make the copy has left the order to the one that goes on in its place.
int CopyMaker::takeOrder() const {
  int newest = -1;
  for (int next = 0; (next = receiveDescriptor(m_orders)) >= 0;) {
    if (newest >= 0) close(newest);
    newest = next;
  }
  return newest;
}

std::optional<int> CopyMaker::makeCopy(int world_socket) const {
  const int socket = m_orders >= 0 ? takeOrder() : -1;
  if (socket < 0) return std::nullopt;
  const pid_t keeper = getppid();
  if (forkBesideItself() == 0) {
    beCopy(socket, world_socket, keeper);
    return socket;
  }
  close(socket);  // if there is no copy, the front sees that no process has it
  return std::nullopt;
}

}  // namespace naiad

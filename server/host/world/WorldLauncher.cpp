#include "host/world/WorldLauncher.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <span>
#include <system_error>
#include <utility>

#include "engine/world/ActivityPage.h"
#include "host/world/DescriptorMessage.h"
#include "host/world/WorldSupervisor.h"

namespace naiad {

namespace {

constexpr int kStartMillis = 10'000;  ///< time limit for the launcher's start

void require(bool good, const char* what) {
  if (!good) throw std::system_error(errno, std::generic_category(), what);
}

/// A descriptor that is closed at the end of its block.
class Descriptor {
 public:
  explicit Descriptor(int number = -1) : m_number(number) {}
  ~Descriptor() {
    if (m_number >= 0) close(m_number);
  }
  Descriptor(Descriptor&& other) noexcept : m_number(std::exchange(other.m_number, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(m_number, other.m_number);
    return *this;
  }
  int get() const { return m_number; }
  int release() { return std::exchange(m_number, -1); }

 private:
  int m_number;
};

std::pair<Descriptor, Descriptor> socketPair(int type, const char* what) {
  int ends[2];
  require(socketpair(AF_UNIX, type | SOCK_CLOEXEC, 0, ends) == 0, what);
  return {Descriptor(ends[0]), Descriptor(ends[1])};
}

/// Makes the pipe for a world's output. When it is full, the world's writes block; our reads never do. The
/// world does not get our output, which may be a file or terminal that it could truncate or read.
std::pair<Descriptor, Descriptor> outputPipe(const char* what) {
  int ends[2];
  require(pipe2(ends, O_CLOEXEC) == 0, what);
  std::pair<Descriptor, Descriptor> pair{Descriptor(ends[0]), Descriptor(ends[1])};
  require(fcntl(ends[0], F_SETFL, O_NONBLOCK) == 0, what);
  return pair;
}

/// Makes sealed memory for an ActivityPage, so no world can shrink it and kill its reader by SIGBUS.
Descriptor sharedPage(const char* what) {
  Descriptor page(memfd_create("df-activity", MFD_CLOEXEC | MFD_ALLOW_SEALING));
  require(page.get() >= 0 && ftruncate(page.get(), sizeof(df::ActivityPage)) == 0 &&
              fcntl(page.get(), F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL) == 0,
          what);
  return page;
}

bool sendOrder(int to, const WorldStartOptions& order, const WorldDescriptors& descriptors) {
  const WorldDescriptors::List list = descriptors.list();
  return sendDescriptors(to, &order, sizeof order, std::span(list).first(descriptors.count()));
}

/// Returns false after a timeout, or if the other end was closed.
template <class Message>
bool receive(int from, Message& message) {
  pollfd readable{from, POLLIN, 0};
  while (true) {
    const int count = poll(&readable, 1, kStartMillis);
    if (count < 0 && errno == EINTR) continue;
    errno = count == 0 ? ETIMEDOUT : ECONNRESET;
    return count > 0 && recv(from, &message, sizeof message, MSG_WAITALL) == sizeof message;
  }
}

}  // namespace

WorldLauncher::WorldLauncher(WorldProgram program) : m_program(std::move(program)) {
  launch();
}

WorldLauncher::~WorldLauncher() {
  endLauncher();
}

void WorldLauncher::launch() const {
  constexpr const char* kWhat = "cannot start the launcher of game processes";
  auto [ours, theirs] = socketPair(SOCK_SEQPACKET, kWhat);
  m_process = fork();
  require(m_process >= 0, kWhat);
  if (m_process == 0) runLauncher(theirs.get(), m_program);
  theirs = Descriptor();
  m_socket = ours.release();
  if (receive(m_socket, m_support)) return;
  endLauncher();
  throw std::system_error(ECHILD, std::generic_category(), kWhat);
}

void WorldLauncher::endLauncher() const {
  if (m_socket >= 0) close(std::exchange(m_socket, -1));
  if (m_process <= 0) return;
  ::kill(m_process, SIGKILL);  // needed, because a copy of this process may hold the socket, too
  while (waitpid(m_process, nullptr, 0) < 0 && errno == EINTR) continue;
  m_process = -1;
}

StartedWorld WorldLauncher::start(const WorldStartOptions& order) const {
  constexpr const char* kWhat = "cannot start a game process";
  auto [our_world, their_world] = socketPair(SOCK_STREAM, kWhat);
  auto [our_keeper, their_keeper] = socketPair(SOCK_STREAM, kWhat);
  auto [our_output, their_output] = outputPipe(kWhat);
  Descriptor page = sharedPage(kWhat);
  std::pair<Descriptor, Descriptor> copies;
  if (order.copies) copies = socketPair(SOCK_SEQPACKET, kWhat);
  const WorldDescriptors theirs{their_world.get(), their_keeper.get(), their_output.get(), page.get(),
                                copies.second.get()};
  if (!sendOrder(m_socket, order, theirs)) {  // the launcher has ended
    endLauncher();
    launch();
    require(sendOrder(m_socket, order, theirs), kWhat);
  }
  StartedWorld started{our_world.release(), our_keeper.release(), our_output.release(), page.release()};
  started.copies = copies.first.release();
  started.hang_time = m_program.hang_time;
  started.hashes = order.repeatable;
  started.repeats = order.again;
  return started;
}

}  // namespace naiad

#include "host/world/Succession.h"

#include <poll.h>
#include <signal.h>
#include <sys/signalfd.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <set>

#include "host/world/Descendants.h"

namespace naiad {

namespace {

/// Alive or not: it has not been waited for.
bool isChild(pid_t process) {
  siginfo_t facts{};
  return process > 0 && waitid(P_PID, static_cast<id_t>(process), &facts, WEXITED | WNOHANG | WNOWAIT) == 0;
}

/// Has it ended? Others that have are waited for.
bool takeEnd(pid_t world, int& status) {
  int how = 0;
  for (pid_t child = 0; (child = waitpid(-1, &how, WNOHANG)) > 0;) {
    if (child != world) continue;
    status = how;
    return true;
  }
  return false;
}

}  // namespace

pid_t Succession::run() {
  while (waitForEnd()) {
    m_world = 0;
    KeeperOrder next;
    if (!report(KeeperEnd::kWorld) || !waitForWord(next) || !isChild(next.process)) return 0;
    std::set<pid_t> kept{next.process};
    kept.insert(next.kept.begin(), next.kept.end());
    if (!endOthers(kept) || !report(KeeperEnd::kRest)) return 0;
    m_world = next.process;
  }
  return m_world;
}

bool Succession::report(KeeperEnd::Kind what) const {
  const KeeperEnd end{m_status, what};
  return send(m_front, &end, sizeof end, MSG_NOSIGNAL) == sizeof end;
}

/// False: the front has closed its end.
bool Succession::takeOrder(KeeperOrder& order) const {
  return recv(m_front, &order, sizeof order, MSG_DONTWAIT) == sizeof order;
}

bool Succession::waitForWord(KeeperOrder& order) const {
  do {
    pollfd readable{m_front, POLLIN, 0};
    if (poll(&readable, 1, kWordMillis) <= 0 || !takeOrder(order)) return false;
  } while (order.kind == KeeperOrder::kEndWorld);  // it had just ended
  return true;
}

/// False: the front wants no world any more.
bool Succession::waitForEnd() {
  pollfd either[2] = {{m_front, POLLIN | POLLRDHUP, 0}, {m_children, POLLIN, 0}};
  while (!takeEnd(m_world, m_status)) {
    if (poll(either, 2, -1) < 0) continue;
    if (either[0].revents != 0) {
      KeeperOrder order;
      if (!takeOrder(order) || order.kind != KeeperOrder::kEndWorld) return false;
      kill(m_world, SIGKILL);
    }
    signalfd_siginfo facts{};
    if (either[1].revents != 0) {
      [[maybe_unused]] const ssize_t got = read(m_children, &facts, sizeof facts);
    }
  }
  return true;
}

}  // namespace naiad

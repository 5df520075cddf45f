#include "ForkingWorld.h"

#include <signal.h>
#include <sys/prctl.h>

#include <algorithm>
#include <thread>

#include "ProcessTree.h"

namespace bench::attack {

namespace {

using namespace std::chrono_literals;

constexpr const char* kChild = "attack-fork";  // as the game calls them
constexpr int kNetwork = 9;
constexpr std::chrono::milliseconds kEndTime = 3s;  // for the children of a world that has ended

}  // namespace

ForkingWorld::ForkingWorld() {
  prctl(PR_SET_CHILD_SUBREAPER, 1);
}

ServerSetup ForkingWorld::setup() const {
  const std::string game = std::string(NAIAD_BINARY_DIR) + "/../lib/naiad_attack_forker.so";
  return {.arguments = {"--game", game, "--players", "private"}, .password = {}};
}

// The world ends in the middle, and what is left is counted when it has had time to go.
void ForkingWorld::begin(const Target& target) {
  m_p_context = &target.context;
  m_port = target.server.port();
  m_leave_at = std::chrono::steady_clock::now() + target.duration / 2;
  m_patience = std::min<std::chrono::milliseconds>(kEndTime, target.duration / 4);
  m_guest = std::make_unique<Guest>(*m_p_context, m_port, addressIn(kNetwork, 0), guestOptions("forker", ""));
}

void ForkingWorld::update(Time now) {
  if (m_guest) m_guest->update(now);
  if (!m_asked && m_guest && m_guest->hasPicture(now)) {
    m_asked = m_guest->session()->sendKey(df::Keyboard::F, df::KEY_PRESSED, now);
  }
  if (!m_left) m_forked = std::max(m_forked, descendantsNamed(kChild).size());
  if (!m_left && now >= m_leave_at) {
    m_left = true;
    m_count_at = now + m_patience;
    if (m_guest && m_guest->state() == Guest::State::kPlaying) m_guest->session()->leave();
  }
  if (m_left && !m_counted && now >= m_count_at) {
    m_counted = true;
    m_after_world = descendantsNamed(kChild).size();
  }
}

void ForkingWorld::end() {
  m_guest.reset();
}

void ForkingWorld::addFindings(Findings& findings) {
  std::this_thread::sleep_for(1s);
  const std::vector<pid_t> left = descendantsNamed(kChild);
  for (const pid_t process : left) kill(process, SIGKILL);
  findings.figures.emplace_back("forked", static_cast<long long>(m_forked));
  findings.figures.emplace_back("processes_left", static_cast<long long>(m_after_world));
  findings.figures.emplace_back("processes_left_by_server", static_cast<long long>(left.size()));
  if (m_after_world > 0 || left.size() > 0) findings.faults.emplace_back("processes_left");
  if (!m_asked || !m_counted) findings.faults.emplace_back("forked");
}

}  // namespace bench::attack

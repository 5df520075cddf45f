// fork300: counts the children of a game, and those that outlive it.
#pragma once

#include <signal.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <algorithm>
#include <thread>

#include "Attack.h"
#include "Guest.h"
#include "tests/support/Processes.h"

namespace bench::attack {
using namespace std::chrono_literals;

inline constexpr const char* kChild = "attack-fork";  // name that the game gives to its children
inline constexpr std::chrono::milliseconds kEndTime =
    3s;  // time that the children have to end after their world

/// Returns the children of the game that have not ended.
inline std::vector<pid_t> forkedChildren() {
  std::vector<pid_t> found = naiad::test::processesBelow(getpid(), kChild);
  std::erase_if(found, [](pid_t process) {
    const char state = naiad::test::stateOf(process);
    return state == 'Z' || state == 'X';
  });
  return found;
}

class ForkingWorld : public Attack {
 public:
  ForkingWorld() { prctl(PR_SET_CHILD_SUBREAPER, 1); }

  ServerSetup setup() const override {
    const std::string game = std::string(NAIAD_BINARY_DIR) + "/../lib/naiad_attack_forker.so";
    return {.arguments = {"--game", game, "--input-mode", "private"}, .password = {}};
  }
  // Lets the world end in the middle of the attack. Children that still exist kEndTime later are counted.
  void begin(const Target& target) override {
    m_leave_at = std::chrono::steady_clock::now() + target.duration / 2;
    m_patience = std::min<std::chrono::milliseconds>(kEndTime, target.duration / 4);
    m_guest = std::make_unique<Guest>(target.context, target.server.port(), addressIn(9, 0), "forker", "");
  }
  void update(Time now) override {
    if (m_guest) m_guest->update(now);
    if (!m_asked && m_guest && m_guest->hasPicture(now)) {
      m_asked = m_guest->session()->sendKey(df::Keyboard::F, df::KEY_PRESSED, now);
    }
    if (!m_left && now >= m_look_at) {
      m_look_at = now + 100ms;
      m_forked = std::max(m_forked, forkedChildren().size());
    }
    if (!m_left && now >= m_leave_at) {
      m_left = true;
      m_count_at = now + m_patience;
      if (m_guest && m_guest->state() == Guest::State::kPlaying) m_guest->session()->leave();
    }
    if (m_left && !m_counted && now >= m_count_at) {
      m_counted = true;
      m_after_world = forkedChildren().size();
    }
  }
  void end() override { m_guest.reset(); }
  void addFigures(Figures& figures) override {
    std::this_thread::sleep_for(1s);
    const std::vector<pid_t> left = forkedChildren();
    for (const pid_t process : left) kill(process, SIGKILL);
    figures.push_back({"forked", static_cast<double>(m_forked), !m_asked || !m_counted});
    figures.push_back(
        {"processes_left", static_cast<double>(m_after_world), m_after_world > 0 || !left.empty()});
    figures.push_back({"processes_left_by_server", static_cast<double>(left.size())});
  }

 private:
  std::unique_ptr<Guest> m_guest;
  bool m_asked = false;
  bool m_left = false;
  bool m_counted = false;
  Time m_look_at{};
  Time m_leave_at{};
  Time m_count_at{};
  std::chrono::milliseconds m_patience{0};
  std::size_t m_forked = 0;
  std::size_t m_after_world = 0;
};

}  // namespace bench::attack

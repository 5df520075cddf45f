// fork300: counts the children of a game, and those that outlive it.
#include <signal.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <thread>

#include "Attack.h"
#include "Guest.h"

namespace bench::attack {
namespace {

using namespace std::chrono_literals;

constexpr const char* kChild = "attack-fork";  // name that the game gives to its children
constexpr int kNetwork = 9;
constexpr std::chrono::milliseconds kEndTime = 3s;  // time that the children have to end after their world

struct Process {
  pid_t parent = 0;
  char state = '?';
  std::string name;
};

/// Returns all processes listed in /proc.
std::map<pid_t, Process> allProcesses() {
  std::map<pid_t, Process> all;
  std::error_code gone;
  for (const auto& entry : std::filesystem::directory_iterator("/proc", gone)) {
    const std::string number = entry.path().filename();
    if (!std::all_of(number.begin(), number.end(), [](char c) { return c >= '0' && c <= '9'; })) continue;
    std::ifstream file(entry.path() / "stat");
    std::string line;
    if (!std::getline(file, line)) continue;
    const std::size_t open = line.find('(');
    const std::size_t shut = line.rfind(')');
    if (open == std::string::npos || shut == std::string::npos) continue;
    Process process;
    process.name = line.substr(open + 1, shut - open - 1);
    std::istringstream words(line.substr(shut + 1));
    words >> process.state >> process.parent;
    all[std::stoi(number)] = process;
  }
  return all;
}

bool descends(const std::map<pid_t, Process>& all, pid_t process, pid_t from) {
  for (auto at = all.find(process); at != all.end(); at = all.find(at->second.parent)) {
    if (at->second.parent == from) return true;
  }
  return false;
}

/// Returns the descendants of this process with this name (/proc/PID/comm), except zombies.
std::vector<pid_t> descendantsNamed(const std::string& name) {
  const std::map<pid_t, Process> all = allProcesses();
  std::vector<pid_t> found;
  for (const auto& [id, process] : all) {
    if (process.name == name && process.state != 'Z' && descends(all, id, getpid())) found.push_back(id);
  }
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
    m_guest = std::make_unique<Guest>(target.context, target.server.port(), addressIn(kNetwork, 0),
                                      guestOptions("forker", ""));
  }
  void update(Time now) override {
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
  void end() override { m_guest.reset(); }
  void addFindings(Findings& findings) override {
    std::this_thread::sleep_for(1s);
    const std::vector<pid_t> left = descendantsNamed(kChild);
    for (const pid_t process : left) kill(process, SIGKILL);
    findings.figures.emplace_back("forked", m_forked);
    findings.figures.emplace_back("processes_left", m_after_world);
    findings.figures.emplace_back("processes_left_by_server", left.size());
    if (m_after_world > 0 || !left.empty()) findings.faults.emplace_back("processes_left");
    if (!m_asked || !m_counted) findings.faults.emplace_back("forked");
  }

 private:
  std::unique_ptr<Guest> m_guest;
  bool m_asked = false;
  bool m_left = false;
  bool m_counted = false;
  Time m_leave_at{};
  Time m_count_at{};
  std::chrono::milliseconds m_patience{0};
  std::size_t m_forked = 0;
  std::size_t m_after_world = 0;
};

}  // namespace

AttackPtr makeForkingWorld() {
  return std::make_unique<ForkingWorld>();
}

}  // namespace bench::attack

// naiad_attack: attacks the real programs with default settings while honest players play, and prints the
// results on one line. docs/bench.md explains the keys.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <exception>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "Attack.h"
#include "ChatResume.h"
#include "Company.h"
#include "ForkingWorld.h"
#include "Guest.h"
#include "GuestAttacks.h"
#include "HardPile.h"
#include "HostAttacks.h"
#include "SilentCrowd.h"
#include "shared/options/Options.h"
#include "shared/program/ProcessSetup.h"
#include "tests/bench/Guarded.h"
#include "tests/support/TempFolder.h"

namespace {

using namespace bench::attack;
using namespace std::chrono_literals;

struct PhaseResult {
  Fate fate;
  double seconds = 0;
  double ticks = -1;       ///< number of the server's ticks; -1: it ended without its last log line
  double late_ticks = -1;  ///< ticks that began more than 5 ms late
  double cpu_percent = 0;  ///< the server's share of one core in the second half
  bool died = false;       ///< the server ended by itself
};

/// Runs the attack in its own thread.
class Assault {
 public:
  Assault(Attack& attack, ServerProcess& server, std::chrono::seconds duration)
      : m_thread([this, &attack, &server, duration] {
          try {
            attack.begin({m_context, server, duration});
            while (!m_over) serve(attack);
          } catch (...) {
            m_failure = std::current_exception();
          }
          attack.end();
          m_context.restart();
          m_context.poll();
        }) {}
  ~Assault() {
    m_over = true;
    if (m_thread.joinable()) m_thread.join();
  }

  /// Waits for the end of the thread, and throws the thread's exception if it had one.
  void finish() {
    m_over = true;
    m_thread.join();
    if (m_failure) std::rethrow_exception(m_failure);
  }

 private:
  using Clock = std::chrono::steady_clock;
  void serve(Attack& attack) {
    constexpr std::chrono::milliseconds kTurn{10};
    m_context.restart();
    m_context.run_one_for(kTurn);
    for (const auto enough = Clock::now() + kTurn; Clock::now() < enough && m_context.poll_one() > 0;) {
    }
    attack.update(Clock::now());
  }

  asio::io_context m_context{1};
  std::atomic<bool> m_over{false};
  std::exception_ptr m_failure;
  std::thread m_thread;  // last member, because it uses the others
};

/// Runs a phase with the server that `attack` needs. Attacks only if `hostile`. Throws std::runtime_error if
/// nothing could be measured.
PhaseResult runPhase(Attack& attack, bool hostile, std::chrono::seconds duration) {
  using Clock = std::chrono::steady_clock;
  const naiad::test::TempFolder folder;
  PhaseResult result;
  if (hostile) attack.prepare(folder.string());
  ServerProcess server(attack.setup(), folder.string());
  Company company({.port = server.port(),
                   .fingerprint = server.fingerprint(),
                   .password = server.password(),
                   .known_servers = folder / "known_servers"},
                  kHeldName);
  company.join();
  const Clock::time_point begin = Clock::now();
  const std::chrono::seconds lead = hostile ? attack.leadTime() : std::chrono::seconds(0);
  // The time in the second half is measured, when an attack has used up its initial burst.
  auto half =
      std::async(std::launch::async, [&server, time = std::chrono::milliseconds(lead + duration) / 2] {
        std::this_thread::sleep_for(time);
        return std::pair(Clock::now(), server.cpuMicros());
      });
  const auto play = [&] {
    company.play(lead, duration);
    const Clock::time_point end = Clock::now();
    result.seconds = std::chrono::duration<double>(end - begin).count();
    const auto [since, used] = half.get();
    const std::chrono::duration<double, std::micro> elapsed = end - since;
    result.cpu_percent = 100 * std::max(0.0, server.cpuMicros() - used) / elapsed.count();
  };
  if (hostile) {
    Assault assault(attack, server, duration);
    play();
    assault.finish();
  } else {
    play();
  }
  result.died = !server.isRunning();
  result.fate = company.leave();
  auto counters = server.stop();
  if (counters.contains("ticks")) {
    result.ticks = counters["ticks"];
    result.late_ticks = counters["late_ticks"];
  }
  company.compare(server.truthFile(), result.fate);
  return result;
}

/// Limit of a newcomer's wait, and of the world's pauses, in ms.
constexpr double kMaxWaitMillis = 1000;
/// On a slow machine, the worst time during an attack may be this factor times the one without, because an
/// attack lasts four times as long.
constexpr double kBusyFactor = 4;
/// Minimum number of compared ticks per second for the three honest players together, which receive about 90.
constexpr double kMinComparedPerSecond = 5;
/// Allowed increase of the late ticks' share. Not checked if it is above kMaxCalmLateShare without the
/// attack.
constexpr double kMaxLateShare = 0.1;
constexpr double kMaxCalmLateShare = 0.05;

/// Percent of one core that the attacking player may add to the server's load, on a quiet machine.
constexpr double kMaxCpuPercent = 2;
/// Minimum length of an attack in seconds for checking kMaxCpuPercent. A shorter one has not used up its
/// initial burst.
constexpr double kMinCpuSeconds = 30;

struct Effort {
  std::chrono::seconds calm{15};
  std::chrono::seconds attack{60};
};

const std::vector<std::string> kNetworks6 = {"2001:db8:7:1::1", "2001:db8:7:2::1", "2001:db8:7:3::1",
                                             "2001:db8:7:4::1"};

using Make = std::function<AttackPtr()>;

template <class Kind>
AttackPtr make() {
  return std::make_unique<Kind>();
}

/// All attacks except hard_pile, which attacks a client. chat_detached runs twice.
const std::map<std::string, std::vector<Make>>& attacks() {
  static const std::vector<std::string> s_networks4 = {addressIn(3, 0), addressIn(3, 1), addressIn(3, 2),
                                                       addressIn(3, 3)};
  static const std::map<std::string, std::vector<Make>> s_attacks = {
      {"silent4", {[] { return std::make_unique<SilentCrowd>(s_networks4, "127.0.0.1"); }}},
      {"silent6", {[] { return std::make_unique<SilentCrowd>(kNetworks6, "::1"); }}},
      {"chat_resume", {make<ChatResume>}},
      {"chat_detached", {[] { return makeChatters(1); }, [] { return makeChatters(8); }}},
      {"held_places", {makeHeldPlaces}},
      {"log_stall", {[] { return makeLogReader(true); }}},
      {"log_gone", {[] { return makeLogReader(false); }}},
      {"password80", {makePasswordCrowd}},
      {"fork300", {make<ForkingWorld>}},
      {"restart8", {make<LateRestart>}},
      {"rounds5", {make<HostileRounds>}},
      {"door3000", {make<LargeTerminals>}},
      {"idle64", {makeIdleCrowd}},
      {"password2000", {makeKnockingNetworks}},
      {"bus20k", {make<BusFlood>}}};
  return s_attacks;
}

double lateShare(const PhaseResult& phase) {
  return phase.ticks > 0 ? phase.late_ticks / phase.ticks : 0;
}

bool isQuietMachine(const PhaseResult& calm) {
  return lateShare(calm) <= kMaxCalmLateShare;
}

bool isTooLong(double millis, double calm_millis) {
  return millis > std::max(kMaxWaitMillis, kBusyFactor * calm_millis);
}

Figures figuresOf(const PhaseResult& calm, const PhaseResult& hot) {
  const Fate& fate = hot.fate;
  const auto compared = static_cast<double>(fate.compared_ticks);
  const bool is_late = isQuietMachine(calm) && lateShare(hot) > lateShare(calm) + kMaxLateShare;
  return {{"seconds", hot.seconds},
          {"wrong_cells", static_cast<double>(fate.wrong_cells), fate.wrong_cells > 0},
          {"compared_ticks", compared, compared < kMinComparedPerSecond * hot.seconds},
          {"thrown_out", 1.0 * fate.thrown_out, fate.thrown_out > 0},
          {"newcomer_ms", fate.newcomer_ms, isTooLong(fate.newcomer_ms, calm.fate.newcomer_ms)},
          {"late_ticks", hot.late_ticks, is_late},
          {"ticks", hot.ticks},
          {"pause_ms", fate.pause_ms, isTooLong(fate.pause_ms, calm.fate.pause_ms)},
          {"newcomers", 1.0 * fate.newcomers},
          {"newcomers_out", 1.0 * fate.newcomers_out, fate.newcomers_out > 0},
          {"chat_lines", static_cast<double>(fate.chat)},
          {"server_died", hot.died ? 1.0 : 0.0, hot.died},
          {"cpu_percent", hot.cpu_percent},
          {"calm_newcomer_ms", calm.fate.newcomer_ms},
          {"calm_late_ticks", calm.late_ticks},
          {"calm_ticks", calm.ticks},
          {"calm_pause_ms", calm.fate.pause_ms},
          {"calm_cpu_percent", calm.cpu_percent}};
}

/// Prints a line. `because` are faults without a figure.
void print(const std::string& name, const Figures& figures, std::string because = "") {
  std::printf("attack name=%s", name.c_str());
  for (const Figure& figure : figures) {
    std::printf(" %s=%.*f", figure.key.c_str(), figure.key.ends_with("percent") ? 1 : 0, figure.value);
    if (figure.is_fault) because += (because.empty() ? "" : ",") + figure.key;
  }
  std::printf(" failed=%d%s\n", because.empty() ? 0 : 1,
              because.empty() ? "" : (" because=" + because).c_str());
  std::fflush(stdout);
}

void runAttack(const std::string& name, const Make& make, const Effort& effort) {
  const AttackPtr attack = make();
  const PhaseResult calm = runPhase(*attack, false, effort.calm);
  const PhaseResult hot = runPhase(*attack, true, effort.attack);
  Figures own;
  attack->addFigures(own);
  Figures figures = figuresOf(calm, hot);
  figures.insert(figures.end(), own.begin(), own.end());
  if (name == "chat_resume" && hot.seconds >= kMinCpuSeconds) {
    const double limit = kMaxCpuPercent * (isQuietMachine(calm) ? 1 : kBusyFactor);
    std::ranges::find(figures, std::string("cpu_percent"), &Figure::key)->is_fault =
        hot.cpu_percent - calm.cpu_percent > limit;
  }
  if (name == "held_places")
    figures.push_back({"held", static_cast<double>(hot.fate.crowd), hot.fate.crowd > kHeldAllowed});
  figures.push_back({"valid", isQuietMachine(calm) ? 1.0 : 0.0});
  const bool is_calm_bad =
      calm.fate.thrown_out > 0 || calm.fate.newcomers_out > 0 || calm.fate.wrong_cells > 0;
  print(name, figures, is_calm_bad ? "calm" : "");
}

void sayUnknown(const std::string& name) {
  std::vector<std::string> names{"--quick", "hard_pile"};
  for (const auto& [attack, makes] : attacks()) names.push_back(attack);
  const std::string near = naiad::nearestName(name, names);
  std::fprintf(stderr, "naiad_attack: there is no attack '%s'%s\n", name.c_str(),
               near.empty() ? "" : ("; '" + near + "' is the nearest").c_str());
}

int run(const std::string& name, const Effort& effort) {
  if (name == "hard_pile") {
    print(name, runHardPile(effort.attack, kMaxWaitMillis));
    return 0;
  }
  const auto found = attacks().find(name);
  if (found == attacks().end()) {
    sayUnknown(name);
    return 2;
  }
  if (name == "silent6") {
    const std::string reason = enterLoopbackNamespace(kNetworks6);
    if (!reason.empty()) {
      std::printf("attack name=%s skipped=%s\n", name.c_str(), reason.c_str());
      return 0;
    }
  }
  for (const Make& make : found->second) runAttack(name, make, effort);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  Effort effort;
  std::string name;
  for (const std::string& argument : arguments) {
    if (argument == "--quick") {
      effort = {3s, 6s};
    } else {
      name = argument;
    }
  }
  if (name.empty()) {
    std::fprintf(stderr, "usage: naiad_attack [--quick] NAME\n");
    return 2;
  }
  naiad::raiseOpenFileLimit(SIZE_MAX);
  return bench::guarded("naiad_attack", [&] { return run(name, effort); });
}

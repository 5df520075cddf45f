// naiad_attack: attacks the real programs with default settings while honest players play, and prints the
// results on one line. docs/bench.md explains the keys.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
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

bool isDear(const PhaseResult& calm, const PhaseResult& hot) {
  const double limit = kMaxCpuPercent * (isQuietMachine(calm) ? 1 : kBusyFactor);
  return hot.cpu_percent - calm.cpu_percent > limit;
}

/// Returns the keys of the results whose values are a failure.
std::vector<std::string> faultsOf(const PhaseResult& calm, const PhaseResult& hot) {
  std::vector<std::string> faults;
  if (hot.fate.wrong_cells > 0) faults.emplace_back("wrong_cells");
  if (static_cast<double>(hot.fate.compared_ticks) < kMinComparedPerSecond * hot.seconds)
    faults.emplace_back("compared_ticks");
  if (hot.fate.thrown_out > 0) faults.emplace_back("thrown_out");
  const auto isTooLong = [](double millis, double calm_millis) {
    return millis > std::max(kMaxWaitMillis, kBusyFactor * calm_millis);
  };
  if (hot.fate.newcomers_out > 0) faults.emplace_back("newcomers_out");
  if (isTooLong(hot.fate.newcomer_ms, calm.fate.newcomer_ms)) faults.emplace_back("newcomer_ms");
  if (isTooLong(hot.fate.pause_ms, calm.fate.pause_ms)) faults.emplace_back("pause_ms");
  if (isQuietMachine(calm) && lateShare(hot) > lateShare(calm) + kMaxLateShare)
    faults.emplace_back("late_ticks");
  if (hot.died) faults.emplace_back("server_died");
  if (calm.fate.thrown_out > 0 || calm.fate.newcomers_out > 0 || calm.fate.wrong_cells > 0)
    faults.emplace_back("calm");
  return faults;
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ",") + word;
  return text;
}

void printFaults(const std::vector<std::string>& faults) {
  std::printf(" failed=%d", faults.empty() ? 0 : 1);
  if (!faults.empty()) std::printf(" because=%s", joined(faults).c_str());
  std::printf("\n");
  std::fflush(stdout);
}

void runAttack(const std::string& name, const Make& make, const Effort& effort) {
  const AttackPtr attack = make();
  const PhaseResult calm = runPhase(*attack, false, effort.calm);
  const PhaseResult hot = runPhase(*attack, true, effort.attack);
  Findings findings;
  attack->addFindings(findings);
  std::vector<std::string> faults = faultsOf(calm, hot);
  faults.insert(faults.end(), findings.faults.begin(), findings.faults.end());
  if (name == "chat_resume" && hot.seconds >= kMinCpuSeconds && isDear(calm, hot))
    faults.emplace_back("cpu_percent");
  if (name == "held_places") {
    findings.figures.emplace_back("held", static_cast<long long>(hot.fate.crowd));
    if (hot.fate.crowd > kHeldAllowed) faults.emplace_back("held");
  }
  std::printf(
      "attack name=%s seconds=%.0f wrong_cells=%llu compared_ticks=%llu thrown_out=%d newcomer_ms=%.0f "
      "late_ticks=%.0f",
      name.c_str(), hot.seconds, static_cast<unsigned long long>(hot.fate.wrong_cells),
      static_cast<unsigned long long>(hot.fate.compared_ticks), hot.fate.thrown_out, hot.fate.newcomer_ms,
      hot.late_ticks);
  std::printf(" ticks=%.0f pause_ms=%.0f newcomers=%d newcomers_out=%d chat_lines=%llu server_died=%d",
              hot.ticks, hot.fate.pause_ms, hot.fate.newcomers, hot.fate.newcomers_out,
              static_cast<unsigned long long>(hot.fate.chat), hot.died ? 1 : 0);
  std::printf(" cpu_percent=%.1f", hot.cpu_percent);
  std::printf(
      " calm_newcomer_ms=%.0f calm_late_ticks=%.0f calm_ticks=%.0f calm_pause_ms=%.0f "
      "calm_cpu_percent=%.1f",
      calm.fate.newcomer_ms, calm.late_ticks, calm.ticks, calm.fate.pause_ms, calm.cpu_percent);
  for (const auto& [key, value] : findings.figures) std::printf(" %s=%lld", key.c_str(), value);
  std::printf(" valid=%d", isQuietMachine(calm) ? 1 : 0);
  printFaults(faults);
}

void runPile(const Effort& effort) {
  const PileResult result = runHardPile(effort.attack);
  std::vector<std::string> faults;
  if (result.sigterm_ms > kMaxWaitMillis) faults.emplace_back("sigterm_ms");
  if (result.ctrl_c_ms > kMaxWaitMillis) faults.emplace_back("ctrl_c_ms");
  std::printf(
      "attack name=hard_pile seconds=%lld sigterm_ms=%.0f ctrl_c_ms=%.0f objects=%lld client_ended=%d",
      static_cast<long long>(effort.attack.count()), result.sigterm_ms, result.ctrl_c_ms, result.objects,
      result.ended ? 1 : 0);
  printFaults(faults);
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
    runPile(effort);
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
  try {
    naiad::raiseOpenFileLimit(SIZE_MAX);
    return run(name, effort);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "naiad_attack: %s: %s\n", name.c_str(), error.what());
    return 1;
  }
}

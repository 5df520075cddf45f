#include "Phase.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <future>
#include <thread>

#include "ServerProcess.h"
#include "tests/support/TempFolder.h"

namespace bench::attack {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

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
  void serve(Attack& attack) {
    m_context.restart();
    m_context.run_one_for(10ms);
    for (const auto enough = Clock::now() + 10ms; Clock::now() < enough && m_context.poll_one() > 0;) {
    }
    attack.update(Clock::now());
  }

  asio::io_context m_context{1};
  std::atomic<bool> m_over{false};
  std::exception_ptr m_failure;
  std::thread m_thread;  // last member, because it uses the others
};

/// Measures the server's CPU time in the second half, when an attack has used up its initial burst.
class CpuMeter {
 public:
  CpuMeter(const ServerProcess& server, std::chrono::milliseconds duration)
      : m_server(server), m_half(std::async(std::launch::async, [&server, duration] {
          std::this_thread::sleep_for(duration / 2);
          return Reading{Clock::now(), server.cpuSeconds()};
        })) {}

  /// Returns the share of one core that the server used in the second half so far, in percent.
  double percent() {
    const Reading half = m_half.get();
    const std::chrono::duration<double> elapsed = Clock::now() - half.time;
    return 100 * std::max(0.0, m_server.cpuSeconds() - half.cpu_seconds) / elapsed.count();
  }

 private:
  struct Reading {
    Clock::time_point time;
    double cpu_seconds;
  };

  const ServerProcess& m_server;
  std::future<Reading> m_half;
};

/// Returns the middle five sixths of the duration, for example 50 s of 60 s.
Company::Absence absenceIn(std::chrono::milliseconds duration) {
  return {duration / 12, duration * 11 / 12};
}

}  // namespace

PhaseResult runPhase(Attack& attack, bool hostile, std::chrono::seconds duration) {
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
  CpuMeter cpu(server, lead + duration);
  const auto play = [&] {
    company.play(lead, duration, absenceIn(duration));
    result.seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    result.cpu_percent = cpu.percent();
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
  const ServerProcess::Counters counters = server.stop();
  if (const auto ticks = counters.find("ticks"); ticks != counters.end()) {
    result.ticks = ticks->second;
    const auto late = counters.find("late_ticks");
    result.late_ticks = late != counters.end() ? late->second : 0;
  }
  company.compare(server.truthFile(), result.fate);
  return result;
}

}  // namespace bench::attack

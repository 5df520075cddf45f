// Runs a server with honest players for some time, with or without an attack.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <future>
#include <string>
#include <thread>

#include "Attack.h"
#include "Company.h"
#include "tests/support/TempFolder.h"

namespace bench::attack {

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
inline PhaseResult runPhase(Attack& attack, bool hostile, std::chrono::seconds duration) {
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

}  // namespace bench::attack

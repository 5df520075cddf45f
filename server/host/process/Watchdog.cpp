#include "host/process/Watchdog.h"

#include <pthread.h>

#include <optional>
#include <string>
#include <utility>

#include "host/process/CrashReport.h"
#include "host/process/HangWatch.h"

namespace naiad {

namespace {

constexpr std::chrono::milliseconds kBetweenLooks{100};

}  // namespace

Watchdog::Watchdog(const StopSignals& signals, LogLine log, std::function<void(const ForcedEnd&)> end)
    : m_signals(signals), m_log(std::move(log)), m_end(std::move(end)) {
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);  // signals are for the threads that were there before
  m_thread = std::thread([this] { run(); });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

Watchdog::~Watchdog() {
  {
    const std::lock_guard lock(m_mutex);
    m_stopping = true;
  }
  m_changed.notify_one();
  m_thread.join();
}

void Watchdog::beginTick(std::uint64_t number) {
  m_tick.store(number, std::memory_order_relaxed);
  m_since.store(Clock::now().time_since_epoch().count(), std::memory_order_release);
}

void Watchdog::run() {
  HangWatch watch;
  for (;;) {
    std::unique_lock lock(m_mutex);
    if (m_changed.wait_for(lock, kBetweenLooks, [this] { return m_stopping; })) return;
    lock.unlock();
    const Clock::rep since = m_since.load(std::memory_order_acquire);
    const std::uint64_t number = m_tick.load(std::memory_order_relaxed);
    const auto tick = since != 0 ? std::optional(number) : std::nullopt;
    const HangWatch::Time began{Clock::duration(since)};
    switch (watch.check(tick, began, m_signals.count(), Clock::now())) {
      case HangWatch::Step::kNothing:
        break;
      case HangWatch::Step::kReport:
        m_log("the game has not finished tick " + std::to_string(number) + " for " +
              std::to_string(HangWatch::kHang.count()) + " s: it hangs, and all players wait" +
              crash::activity("handles"));
        break;
      case HangWatch::Step::kEndHung:
      case HangWatch::Step::kEndAtOnce:
        m_end({.hung = tick && Clock::now() - began >= HangWatch::kHang,
               .tick = tick.value_or(0),
               .signal = m_signals.signal()});
    }
  }
}

}  // namespace naiad

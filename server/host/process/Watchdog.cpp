#include "host/process/Watchdog.h"

#include <unistd.h>

#include <future>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "host/process/CrashReport.h"
#include "shared/program/ProcessSetup.h"

namespace naiad {

namespace {

constexpr std::chrono::milliseconds kCheckInterval{100};
constexpr std::chrono::milliseconds kCheckIntervalInTick{10};

}  // namespace

void AsyncLog::waitUntilLogged(std::chrono::milliseconds most) {
  const auto logged = std::make_shared<std::promise<void>>();
  m_thread.enqueue([logged] { logged->set_value(); });
  logged->get_future().wait_for(most);
}

Watchdog::Watchdog(const StopSignals& signals, std::chrono::nanoseconds frame, LogLine log,
                   std::function<void(const ForcedExit&)> end)
    : m_signals(signals), m_frame(frame), m_log(std::move(log)), m_end(std::move(end)) {
  m_thread = startWithoutSignals([this] { run(); });
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
  m_slow_tick.beginTick(getpid());
  m_tick.store(number, std::memory_order_relaxed);
  m_since.store(Clock::now().time_since_epoch().count(), std::memory_order_release);
}

void Watchdog::run() {
  HangDetector watch;
  for (;;) {
    std::unique_lock lock(m_mutex);
    if (m_changed.wait_for(lock, m_since != 0 ? kCheckIntervalInTick : kCheckInterval,
                           [this] { return m_stopping; }))
      return;
    lock.unlock();
    const Clock::rep since = m_since.load(std::memory_order_acquire);
    const std::uint64_t number = m_tick.load(std::memory_order_relaxed);
    const auto tick = since != 0 ? std::optional(number) : std::nullopt;
    const HangDetector::Time began{Clock::duration(since)};
    if (tick) {
      const std::string line =
          m_slow_tick.check(getpid(), number, Clock::now() - began, m_frame, crash::activity("handles"));
      if (!line.empty()) m_log(line);
    }
    switch (watch.check(tick, began, m_signals.count(), Clock::now())) {
      case HangDetector::Step::kNothing:
        break;
      case HangDetector::Step::kReport:
        m_log("the game has not finished tick " + std::to_string(number) + " for " +
              std::to_string(HangDetector::kHangTime.count()) + " s: it hangs, and all players wait" +
              crash::activity("handles"));
        break;
      case HangDetector::Step::kExitHung:
      case HangDetector::Step::kExitNow:
        m_end({.hung = tick && Clock::now() - began >= HangDetector::kHangTime,
               .tick = tick.value_or(0),
               .signal = m_signals.signal()});
    }
  }
}

}  // namespace naiad

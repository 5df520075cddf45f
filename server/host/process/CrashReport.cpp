#include "host/process/CrashReport.h"

#include <poll.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstring>
#include <ctime>
#include <string_view>

#include "engine/world/ActivityPage.h"
#include "engine/world/World.h"
#include "host/world/ActivityReader.h"
#include "shared/program/LineLog.h"

namespace naiad::crash {

namespace {

// The handler may call only async-signal-safe functions, so it reads only plain data set before.
constexpr std::size_t kStack = std::size_t{64} << 10;
constexpr std::chrono::milliseconds kForLog{200};
constexpr int kSignals[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};

char g_name[64];
int g_files[2] = {STDERR_FILENO, -1};
long g_utc_offset = 0;  ///< seconds east of UTC
std::atomic<df::World*> g_p_world = nullptr;
constinit df::ActivityPage g_page{};
std::atomic<std::uint64_t> g_tick = 0;       ///< running tick; 0: none
std::atomic<std::uint64_t> g_last_tick = 0;  ///< last tick that has begun
std::atomic_flag g_reported;

const char* nameOf(int signal) {
  switch (signal) {
    case SIGSEGV:
      return "SIGSEGV";
    case SIGBUS:
      return "SIGBUS";
    case SIGFPE:
      return "SIGFPE";
    case SIGILL:
      return "SIGILL";
    default:
      return "SIGABRT";
  }
}

/// A line in a fixed buffer.
class Line {
 public:
  Line& add(std::string_view text) {
    const std::size_t size = std::min(text.size(), sizeof m_text - m_size);
    std::memcpy(m_text + m_size, text.data(), size);
    m_size += size;
    return *this;
  }
  Line& add(std::uint64_t number, int digits = 1) {
    char reversed[20];
    int count = 0;
    for (; number > 0 || count < digits; number /= 10)
      reversed[count++] = static_cast<char>('0' + number % 10);
    std::reverse(reversed, reversed + count);
    return add(std::string_view(reversed, static_cast<std::size_t>(count)));
  }
  /// Adds "2025-01-31 23:59:59 " (days to dates as in Howard Hinnant's "chrono-compatible low-level
  /// algorithms").
  Line& addTime(std::int64_t seconds) {
    const std::int64_t of_day = seconds % 86400;
    const std::int64_t days = seconds / 86400 + 719468;
    const std::int64_t era = days / 146097;
    const std::int64_t day_of_era = days % 146097;
    const std::int64_t year_of_era =
        (day_of_era - day_of_era / 1460 + day_of_era / 36524 - day_of_era / 146096) / 365;
    const std::int64_t day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    const std::int64_t month = (5 * day_of_year + 2) / 153;  // counted from March
    const auto part = [this](std::int64_t value, const char* end) {
      add(static_cast<std::uint64_t>(value), 2).add(end);
    };
    part(era * 400 + year_of_era + (month >= 10 ? 1 : 0), "-");
    part(month < 10 ? month + 3 : month - 9, "-");
    part(day_of_year - (153 * month + 2) / 5 + 1, " ");
    part(of_day / 3600, ":");
    part(of_day / 60 % 60, ":");
    part(of_day % 60, " ");
    return *this;
  }
  /// Writes to all files that accept it at once, because a file that stalls must not keep the process alive.
  void write() const {
    for (const int file : g_files) {
      pollfd ready{file, POLLOUT, 0};
      if (file < 0 || poll(&ready, 1, 0) <= 0) continue;
      [[maybe_unused]] const ssize_t written = ::write(file, m_text, m_size);
    }
  }

 private:
  char m_text[768];
  std::size_t m_size = 0;
};

void addWhere(Line& line) {
  if (const std::uint64_t tick = g_tick; tick != 0) {
    line.add(" in tick ").add(tick);
  } else if (const std::uint64_t last = g_last_tick; last != 0) {
    line.add(" after tick ").add(last);
  } else {
    line.add(" before the first tick");
  }
}

void writeLine(int signal) {
  Line line;
  line.addTime(time(nullptr) + g_utc_offset).add(g_name).add(": crashed (").add(nameOf(signal)).add(")");
  addWhere(line);
  if (g_tick != 0) line.add(describeActivity(g_page, "handled").view());
  line.add("\n").write();
}

void writeLog() {
  for (std::size_t back = df::ActivityPage::kLines; back-- > 0;) {
    const ActivityText text = logLine(g_page, back);
    if (!text.empty()) Line().add(g_name).add(": the game's log: ").add(text.view()).add("\n").write();
  }
}

void writeHint() {
  Line()
      .add(g_name)
      .add(": to see where: gdb -ex run -ex bt --args ")
      .add(g_name)
      .add(" (docs/when-it-goes-wrong.md)\n")
      .write();
}

void onCrash(int signal, siginfo_t* p_info, void* /*context*/) {
  if (!g_reported.test_and_set()) {
    LineLog::waitUntilWritten(kForLog);  // safe here: only reads atomics and sleeps
    writeLine(signal);
    writeLog();
    writeHint();
  }
  struct sigaction action {};
  action.sa_handler = SIG_DFL;
  sigaction(signal, &action, nullptr);
  // A fault happens again when this handler returns. A sent signal (abort(), kill) must be raised again.
  if (p_info->si_code <= 0) raise(signal);
}

// Gives the calling thread, which runs the game, a signal stack, unless it has one.
void useOwnStack() {
  stack_t before{};
  if (sigaltstack(nullptr, &before) != 0 || (before.ss_flags & SS_DISABLE) == 0) return;
  static char* const p_memory = new char[kStack];  // never freed
  stack_t stack{};
  stack.ss_sp = p_memory;
  stack.ss_size = kStack;
  sigaltstack(&stack, nullptr);
}

bool isSameFile(int a, int b) {
  struct stat facts_a {};
  struct stat facts_b {};
  return fstat(a, &facts_a) == 0 && fstat(b, &facts_b) == 0 && facts_a.st_dev == facts_b.st_dev &&
         facts_a.st_ino == facts_b.st_ino;
}

}  // namespace

Report::Report(const std::string& name, int log) {
  std::strncpy(g_name, name.c_str(), sizeof g_name - 1);
  g_files[1] = log >= 0 && !isSameFile(log, STDERR_FILENO) ? log : -1;
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  if (localtime_r(&now, &parts) != nullptr) g_utc_offset = parts.tm_gmtoff;
  useOwnStack();
  for (const int signal : kSignals) {
    struct sigaction before {};
    if (sigaction(signal, nullptr, &before) != 0 || before.sa_handler != SIG_DFL) continue;
    struct sigaction action {};
    action.sa_sigaction = onCrash;
    action.sa_flags = SA_SIGINFO | SA_ONSTACK | SA_NODEFER;
    sigaction(signal, &action, nullptr);
  }
}

Report::~Report() {
  g_files[1] = -1;
}

void setWorld(df::World& world) {
  df::World* p_before = nullptr;
  if (g_p_world.compare_exchange_strong(p_before, &world) || p_before == &world)
    world.setActivityPage(&g_page);
}

void clearWorld(df::World& world) {
  df::World* p_before = &world;
  if (g_p_world.compare_exchange_strong(p_before, nullptr)) world.setActivityPage(nullptr);
}

std::string activity(std::string_view verb) {
  return std::string(describeActivity(g_page, verb).view());
}

bool inTick() {
  return g_tick != 0;
}

std::string where() {
  return " in tick " + std::to_string(g_tick) + activity("handled");
}

void setTick(std::uint64_t number) {
  g_tick.store(number, std::memory_order_relaxed);
  if (number != 0) g_last_tick.store(number, std::memory_order_relaxed);
}

}  // namespace naiad::crash

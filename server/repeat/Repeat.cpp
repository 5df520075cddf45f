// libdragonfly-repeat.so: clocks and entropy of a world that can be replayed.
//
// It is loaded before all other libraries (LD_PRELOAD) of a world's process, whose game needs no change for
// it. With NAIAD_REPEAT="SEED START FRAME AGAIN" in the environment, each clock shows START plus the world's
// ticks of FRAME nanoseconds, and advances by a microsecond each time it is read, so that a game that waits
// for it does not hang. Random devices give numbers from the seed, in the order of the calls. Files that are
// opened for reading before the first tick are recorded. Without that variable every function behaves
// like the system's.
//
// It does not cover instructions (rdtsc, rdrand), system calls that a game makes without the C library, and
// threads. If a game uses these, its round may differ when it is replayed, and dfreplay notices that.
#include <dlfcn.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <initializer_list>

namespace {

constexpr std::uint64_t kSecond = 1'000'000'000;
constexpr std::uint64_t kStep = 1'000;            ///< nanoseconds by which reading a clock advances it
constexpr std::uint64_t kBoot = 1'000 * kSecond;  ///< nanoseconds that monotonic clocks show at the start
constexpr std::size_t kMaxPaths = std::size_t{64} << 10;

struct Repeat {
  bool on = false;
  bool again = false;
  std::uint64_t start = 0;
  std::uint64_t frame = 0;
  std::atomic<std::uint64_t> now{0};  ///< nanoseconds since the world's start
  std::atomic<std::uint64_t> random{0};
  std::atomic<bool> notes{true};
  std::atomic<std::size_t> noted{0};
  char paths[kMaxPaths + 1] = {};
};

std::uint64_t readNumber(const char*& p) {
  char* p_end = nullptr;
  const std::uint64_t number = strtoull(p, &p_end, 10);
  p = p_end;
  return number;
}

// Removes the variables from the environment, because programs that the game starts are not worlds.
Repeat* makeRepeat() {
  static Repeat repeat;
  const char* p = getenv("NAIAD_REPEAT");
  if (p == nullptr) return &repeat;
  repeat.random = readNumber(p);
  repeat.start = readNumber(p);
  repeat.frame = readNumber(p);
  repeat.again = readNumber(p) != 0;
  repeat.on = true;
  unsetenv("NAIAD_REPEAT");
  unsetenv("LD_PRELOAD");
  return &repeat;
}

// Created at the first call, because constructors of other libraries may run before this one's.
Repeat& repeat() {
  static Repeat* const p_repeat = makeRepeat();
  return *p_repeat;
}

[[gnu::constructor]] void begin() {
  repeat();
}

template <class Function>
Function* next(Function* /*same*/, const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

std::uint64_t sinceStart() {
  return repeat().now.fetch_add(kStep, std::memory_order_relaxed) + kStep;
}

std::uint64_t clockNanos(clockid_t clock) {
  const std::uint64_t since = sinceStart();
  switch (clock) {
    case CLOCK_REALTIME:
    case CLOCK_REALTIME_COARSE:
    case CLOCK_TAI:
      return repeat().start + since;
    case CLOCK_PROCESS_CPUTIME_ID:
    case CLOCK_THREAD_CPUTIME_ID:
      return since;
    default:
      return kBoot + since;
  }
}

std::uint64_t nextRandom() {
  std::uint64_t z =
      repeat().random.fetch_add(0x9e3779b97f4a7c15u, std::memory_order_relaxed) + 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

void fill(void* p_to, std::size_t count) {
  for (auto* p = static_cast<char*>(p_to); count > 0;) {
    const std::uint64_t number = nextRandom();
    const std::size_t part = count < sizeof number ? count : sizeof number;
    memcpy(p, &number, part);
    p += part;
    count -= part;
  }
}

/// Advances the world's clock at once. Sleeps in real time, too, unless the world is a replay (AGAIN).
template <class Sleep>
int sleepFor(std::uint64_t nanos, Sleep sleep) {
  repeat().now.fetch_add(nanos, std::memory_order_relaxed);
  return repeat().again ? 0 : sleep();
}

std::uint64_t nanosOf(const timespec& time) {
  return static_cast<std::uint64_t>(time.tv_sec) * kSecond + static_cast<std::uint64_t>(time.tv_nsec);
}

void recordPath(const char* path) {
  Repeat& all = repeat();
  if (!all.on || !all.notes || path == nullptr || strchr(path, '\n') != nullptr) return;
  for (const char* p_system : {"/proc/", "/sys/", "/dev/", "/etc/", "/usr/", "/lib"})
    if (strncmp(path, p_system, strlen(p_system)) == 0) return;
  const std::size_t size = strlen(path) + 1;
  const std::size_t at = all.noted.load();
  if (at + size > kMaxPaths) return;
  memcpy(all.paths + at, path, size - 1);
  all.paths[at + size - 1] = '\n';
  all.noted = at + size;
}

bool reads(int flags) {
  return (flags & O_ACCMODE) == O_RDONLY && (flags & (O_DIRECTORY | O_CREAT)) == 0;
}

int recordOpen(int file, const char* path, int flags) {
  if (file >= 0 && reads(flags)) recordPath(path);
  return file;
}

FILE* recordOpen(FILE* p_file, const char* path, const char* mode) {
  if (p_file != nullptr && mode != nullptr && mode[0] == 'r' && strchr(mode, '+') == nullptr)
    recordPath(path);
  return p_file;
}

mode_t modeOf(va_list arguments, int flags) {
  return (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(arguments, mode_t) : 0;
}

}  // namespace

extern "C" {

// ---- functions that the world calls -----------------------------------------------------------------------

void naiad_repeat_tick(std::uint32_t tick) {
  Repeat& all = repeat();
  if (!all.on) return;
  all.notes = false;
  const std::uint64_t begin = all.frame * tick;
  if (all.now.load(std::memory_order_relaxed) < begin) all.now = begin;
}

const char* naiad_repeat_files() {
  repeat().notes = false;
  return repeat().paths;
}

// ---- clocks -----------------------------------------------------------------------------------------------

int clock_gettime(clockid_t clock, timespec* p_time) {
  static auto* const p_next = next(&clock_gettime, "clock_gettime");
  if (!repeat().on) return p_next(clock, p_time);
  const std::uint64_t nanos = clockNanos(clock);
  p_time->tv_sec = static_cast<time_t>(nanos / kSecond);
  p_time->tv_nsec = static_cast<long>(nanos % kSecond);
  return 0;
}

time_t time(time_t* p_time) {
  static auto* const p_next = next(&time, "time");
  if (!repeat().on) return p_next(p_time);
  const auto now = static_cast<time_t>(clockNanos(CLOCK_REALTIME) / kSecond);
  if (p_time != nullptr) *p_time = now;
  return now;
}

int gettimeofday(timeval* p_time, void* p_zone) {
  static auto* const p_next = reinterpret_cast<int (*)(timeval*, void*)>(dlsym(RTLD_NEXT, "gettimeofday"));
  if (!repeat().on) return p_next(p_time, p_zone);
  const std::uint64_t nanos = clockNanos(CLOCK_REALTIME);
  p_time->tv_sec = static_cast<time_t>(nanos / kSecond);
  p_time->tv_usec = static_cast<suseconds_t>(nanos % kSecond / 1000);
  return 0;
}

int timespec_get(timespec* p_time, int base) {
  static auto* const p_next = next(&timespec_get, "timespec_get");
  if (!repeat().on) return p_next(p_time, base);
  return clock_gettime(CLOCK_REALTIME, p_time) == 0 ? base : 0;
}

clock_t clock() {
  static auto* const p_next = next(&clock, "clock");
  if (!repeat().on) return p_next();
  return static_cast<clock_t>(clockNanos(CLOCK_PROCESS_CPUTIME_ID) / 1000);
}

int nanosleep(const timespec* p_time, timespec* p_left) {
  static auto* const p_next = next(&nanosleep, "nanosleep");
  if (!repeat().on) return p_next(p_time, p_left);
  return sleepFor(nanosOf(*p_time), [&] { return p_next(p_time, p_left); });
}

int clock_nanosleep(clockid_t clock, int flags, const timespec* p_time, timespec* p_left) {
  static auto* const p_next = next(&clock_nanosleep, "clock_nanosleep");
  if (!repeat().on) return p_next(clock, flags, p_time, p_left);
  if ((flags & TIMER_ABSTIME) == 0)
    return sleepFor(nanosOf(*p_time), [&] { return p_next(clock, flags, p_time, p_left); });
  // The clock is not the machine's, so the absolute time becomes a duration.
  const std::uint64_t until = nanosOf(*p_time);
  const std::uint64_t now = clockNanos(clock);
  if (until <= now) return 0;
  const timespec rest{static_cast<time_t>((until - now) / kSecond),
                      static_cast<long>((until - now) % kSecond)};
  return sleepFor(until - now, [&] { return p_next(CLOCK_MONOTONIC, 0, &rest, nullptr); });
}

int usleep(useconds_t micros) {
  const timespec time{static_cast<time_t>(micros / 1'000'000), static_cast<long>(micros % 1'000'000 * 1000)};
  return nanosleep(&time, nullptr);
}

unsigned sleep(unsigned seconds) {
  const timespec time{static_cast<time_t>(seconds), 0};
  return nanosleep(&time, nullptr) == 0 ? 0 : seconds;
}

// ---- entropy ----------------------------------------------------------------------------------------------

ssize_t getrandom(void* p_to, std::size_t count, unsigned flags) {
  static auto* const p_next = next(&getrandom, "getrandom");
  if (!repeat().on) return p_next(p_to, count, flags);
  fill(p_to, count);
  return static_cast<ssize_t>(count);
}

int getentropy(void* p_to, std::size_t count) {
  static auto* const p_next = next(&getentropy, "getentropy");
  if (!repeat().on) return p_next(p_to, count);
  fill(p_to, count);
  return 0;
}

std::uint32_t arc4random() {
  static auto* const p_next = next(&arc4random, "arc4random");
  return repeat().on ? static_cast<std::uint32_t>(nextRandom()) : p_next();
}

void arc4random_buf(void* p_to, std::size_t count) {
  static auto* const p_next = next(&arc4random_buf, "arc4random_buf");
  repeat().on ? fill(p_to, count) : p_next(p_to, count);
}

std::uint32_t arc4random_uniform(std::uint32_t bound) {
  static auto* const p_next = next(&arc4random_uniform, "arc4random_uniform");
  if (!repeat().on) return p_next(bound);
  return bound < 2 ? 0 : static_cast<std::uint32_t>(nextRandom() % bound);
}

/// Replaces std::random_device::_M_getval(), for all kinds of random devices.
unsigned _ZNSt13random_device9_M_getvalEv(void* p_device) {
  static auto* const p_next = next(&_ZNSt13random_device9_M_getvalEv, "_ZNSt13random_device9_M_getvalEv");
  return repeat().on ? static_cast<unsigned>(nextRandom()) : p_next(p_device);
}

// ---- files ------------------------------------------------------------------------------------------------

FILE* fopen(const char* path, const char* mode) {
  static auto* const p_next = next(&fopen, "fopen");
  return recordOpen(p_next(path, mode), path, mode);
}

FILE* fopen64(const char* path, const char* mode) {
  static auto* const p_next = next(&fopen64, "fopen64");
  return recordOpen(p_next(path, mode), path, mode);
}

int open(const char* path, int flags, ...) {
  static auto* const p_next = next(&open, "open");
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = modeOf(arguments, flags);
  va_end(arguments);
  return recordOpen(p_next(path, flags, mode), path, flags);
}

int open64(const char* path, int flags, ...) {
  static auto* const p_next = next(&open64, "open64");
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = modeOf(arguments, flags);
  va_end(arguments);
  return recordOpen(p_next(path, flags, mode), path, flags);
}

int openat(int folder, const char* path, int flags, ...) {
  static auto* const p_next = next(&openat, "openat");
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = modeOf(arguments, flags);
  va_end(arguments);
  return recordOpen(p_next(folder, path, flags, mode), path, flags);
}

int openat64(int folder, const char* path, int flags, ...) {
  static auto* const p_next = next(&openat64, "openat64");
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = modeOf(arguments, flags);
  va_end(arguments);
  return recordOpen(p_next(folder, path, flags, mode), path, flags);
}

}  // extern "C"

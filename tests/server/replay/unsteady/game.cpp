// A game that differs in each run from tick 47 on, in the way that its module's name says.
// unsteady_instruction.so, _entropy, _clock, _thread and _file cannot be replayed; unsteady_time.so, _device
// and _pointers can, because the server controls their sources. unsteady_frail.so reacts to keys: Q crashes,
// D crashes in draw(), H hangs, S is slow, T starts a thread, P moves by the process id.
#include <dlfcn.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <fstream>
#include <random>
#include <set>
#include <string>
#include <thread>

#include "DisplayManager.h"
#include "EventKeyboard.h"
#include "EventStep.h"
#include "GameManager.h"
#include "Object.h"
#include "WorldManager.h"

#if defined(__x86_64__)
#include <x86intrin.h>
#endif

namespace {

constexpr int kTick = 47;

std::string modulePath() {
  Dl_info facts{};
  dladdr(reinterpret_cast<void*>(&modulePath), &facts);
  return facts.dli_fname;
}

std::string wayOf(const std::string& path) {
  const std::size_t begin = path.rfind('_') + 1;
  return path.substr(begin, path.rfind('.') - begin);
}

std::uint64_t byInstruction() {
#if defined(__x86_64__)
  return __rdtsc();
#else
  std::uint64_t count;
  asm volatile("mrs %0, cntvct_el0" : "=r"(count));
  return count;
#endif
}

std::uint64_t byThread() {
  std::atomic<bool> ends{false};
  std::atomic<std::uint64_t> count{0};
  std::thread other([&] {
    while (!ends) ++count;
  });
  while (count < 1000) std::this_thread::yield();
  for (int i = 0; i < 100'000; ++i) asm volatile("");
  ends = true;
  other.join();
  return count;
}

std::uint64_t byPointers() {
  std::set<std::uintptr_t> places;
  std::uint64_t sum = 0;
  for (int i = 1; i < 20; ++i) {
    auto* p_object = new df::Object;
    sum = sum * 31 + reinterpret_cast<std::uintptr_t>(p_object);
    WM.markForDelete(p_object);
  }
  return sum + reinterpret_cast<std::uintptr_t>(&sum) + reinterpret_cast<std::uintptr_t>(&modulePath);
}

std::uint64_t number() {
  const std::string path = modulePath();
  const std::string way = wayOf(path);
  std::uint64_t value = 0;
  if (way == "instruction") return byInstruction();
  if (way == "thread") return byThread();
  if (way == "pointers") return byPointers();
  if (way == "entropy" && syscall(SYS_getrandom, &value, sizeof value, 0) == sizeof value) return value;
  if (way == "clock") {
    timespec now{};
    syscall(SYS_clock_gettime, CLOCK_REALTIME, &now);
    return static_cast<std::uint64_t>(now.tv_sec) * 1'000'000'000 + static_cast<std::uint64_t>(now.tv_nsec);
  }
  if (way == "file") std::ifstream(path + ".txt") >> value;
  if (way == "device") return std::random_device()();
  if (way == "time")
    return static_cast<std::uint64_t>(time(nullptr)) ^
           static_cast<std::uint64_t>(std::chrono::system_clock::now().time_since_epoch().count());
  return value;
}

/// Uses 0.45 s of processor time. Reads it by a system call, because a game's clocks stop within a tick.
void takeTime() {
  const auto now = [] {
    timespec time{};
    syscall(SYS_clock_gettime, CLOCK_THREAD_CPUTIME_ID, &time);
    return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
  };
  const auto end = now() + std::chrono::milliseconds(450);
  while (now() < end) continue;
}

/// Moves with each key, except the keys that crash or hang the game.
class Frail : public df::Object {
 public:
  Frail() {
    setType("Frail");
    setPosition(df::Vector(5, 5));
    registerInterest(df::KEYBOARD_EVENT);
  }
  int eventHandler(const df::Event* p_event) override {
    const auto* p_key = dynamic_cast<const df::EventKeyboard*>(p_event);
    if (p_key == nullptr || p_key->getKeyboardAction() != df::KEY_PRESSED) return 0;
    if (p_key->getKey() == df::Keyboard::Q) std::raise(SIGSEGV);
    if (p_key->getKey() == df::Keyboard::T) std::thread([] { pause(); }).detach();
    m_crashes = p_key->getKey() == df::Keyboard::D;
    while (p_key->getKey() == df::Keyboard::H) std::atomic_signal_fence(std::memory_order_seq_cst);
    if (p_key->getKey() == df::Keyboard::S) takeTime();
    if (p_key->getKey() == df::Keyboard::P) m_keys = getpid();
    setPosition(df::Vector(5 + static_cast<float>(++m_keys % 60), 5));
    return 1;
  }
  int draw() override {
    if (m_crashes) std::raise(SIGSEGV);
    return DM.drawCh(getPosition(), 'F', df::RED);
  }

 private:
  bool m_crashes = false;
  int m_keys = 0;
};

class Wanderer : public df::Object {
 public:
  Wanderer() {
    setType("Wanderer");
    setPosition(df::Vector(10, 10));
    registerInterest(df::STEP_EVENT);
  }
  int eventHandler(const df::Event* p_event) override {
    if (p_event->getType() != df::STEP_EVENT || ++m_ticks != kTick) return 0;
    // Depends on all bits of the number and stays in the window.
    const std::uint64_t value = number() * 0x9e3779b97f4a7c15u;
    const double unit = static_cast<double>(value >> 32) / 4294967296.0;
    setPosition(df::Vector(5 + 60 * unit, 10));
    m_text = std::to_string(value);
    return 1;
  }
  // Draws the number itself, because different numbers may give equal columns.
  int draw() override { return DM.drawString(df::Vector(5, 10), m_text, df::LEFT_JUSTIFIED, df::YELLOW); }

 private:
  int m_ticks = 0;
  std::string m_text = "@";
};

}  // namespace

int main() {
  if (GM.startUp() != 0) return 1;
  wayOf(modulePath()) == "frail" ? static_cast<void>(new Frail) : static_cast<void>(new Wanderer);
  GM.run();
  GM.shutDown();
  return 0;
}

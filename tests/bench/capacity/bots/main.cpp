// naiad_capacity_bots: thousands of players on one core.
//
//   naiad_capacity_bots CORE HOST PORT FINGERPRINT FOLDER
//
// Commands on stdin, each answered by a line on stdout:
//   go N      be N players, 1 % of them checked            ready N, or failed
//   begin     a measurement starts                         begun
//   end       it ends                                      figures …, a line for each picture, done
//   sink      receive datagrams without answering; write   sunk
//             their sizes to FOLDER/sizes and the bots' addresses to FOLDER/endpoints
#include <sys/epoll.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "../Common.h"
#include "Bots.h"
#include "shared/net/stream/TlsContext.h"
#include "shared/program/ProcessSetup.h"
#include "tests/bench/Guarded.h"
#include "tests/bench/Worker.h"

namespace {

using namespace bench::capacity;
using Clock = std::chrono::steady_clock;

/// Limit of simultaneous handshakes. A server allows 64 per address.
constexpr int kLoggingIn = 32;
constexpr std::size_t kSizes = 8192;
constexpr std::chrono::seconds kPatience{180};

class Crowd {
 public:
  Crowd(const std::string& host, std::uint16_t port, const naiad::Fingerprint& fingerprint,
        std::string folder)
      : m_harbour{m_context, naiad::TlsContext::forClient(), host, port},
        m_fingerprint(fingerprint),
        m_folder(std::move(folder)),
        m_epoll(epoll_create1(EPOLL_CLOEXEC)) {}

  void run() {
    while (!m_ended) {
      serve();
      const Clock::time_point now = Clock::now();
      if (now - m_checkers_updated >= std::chrono::milliseconds(5)) {
        m_checkers_updated = now;
        for (auto& checker : m_checkers) checker->update(now);
      }
      if (now - m_updated < std::chrono::milliseconds(50)) continue;
      m_updated = now;
      update(now);
      readCommands();
    }
  }

 private:
  void serve() {
    const int ready = epoll_wait(m_epoll, m_events.data(), static_cast<int>(m_events.size()), 2);
    const Clock::time_point now = Clock::now();
    for (int i = 0; i < ready; ++i) {
      const std::size_t size =
          static_cast<LightBot*>(m_events[static_cast<std::size_t>(i)].data.ptr)->receive(now);
      if (size > 0 && m_measuring && m_sizes.size() < kSizes) m_sizes.push_back(size);
    }
    m_context.restart();
    for (int i = 0; i < 256 && m_context.poll_one() > 0; ++i) {
    }
  }

  void update(Clock::time_point now) {
    if (m_sinking || m_joined) return;
    const std::size_t checked = (m_wanted + 99) / 100;
    int under_way = 0;
    for (auto& bot : m_bots) {
      bot->update(now);
      if (bot->isOver()) return fail("a bot was not let in");
      if (bot->descriptor() < 0) ++under_way;
    }
    for (std::size_t i = m_watched; i < m_bots.size(); ++i) watch(*m_bots[i]);
    const bool come = std::all_of(m_bots.begin(), m_bots.end(), [](auto& bot) { return bot->isReady(); });
    while (m_bots.size() < m_wanted - checked && under_way < kLoggingIn) {
      m_bots.push_back(std::make_unique<LightBot>(m_harbour, next()));
      m_bots.back()->start();
      ++under_way;
    }
    if (m_bots.size() < m_wanted - checked || !come) return;
    const bool all =
        std::all_of(m_checkers.begin(), m_checkers.end(), [now](auto& c) { return c->isReady(now); });
    if (m_checkers.size() < checked && all) {
      const int index = next();
      m_checkers.push_back(
          std::make_unique<Checker>(m_context, naiad::ServerAddress{m_harbour.host, m_harbour.port},
                                    m_fingerprint, addressOf(index), index, m_folder + "/known"));
    } else if (all) {
      m_joined = true;
      say("ready " + std::to_string(m_bots.size() + m_checkers.size()));
    }
    if (!m_joined && now > m_deadline) fail("not all came in time");
  }

  void watch(LightBot& bot) {
    if (bot.descriptor() < 0 || &bot != m_bots[m_watched].get()) return;
    epoll_event event{};
    event.events = EPOLLIN;
    event.data.ptr = &bot;
    epoll_ctl(m_epoll, EPOLL_CTL_ADD, bot.descriptor(), &event);
    ++m_watched;
  }

  int next() { return m_next++; }

  void go(std::size_t wanted) {
    m_wanted = wanted;
    m_joined = false;
    m_deadline = Clock::now() + kPatience;
    const std::size_t checked = (wanted + 99) / 100;
    if (m_bots.size() > wanted - checked) m_bots.resize(wanted - checked);  // disconnects the removed bots
    m_watched = std::min(m_watched, m_bots.size());
    if (m_checkers.size() > checked) m_checkers.resize(checked);
  }

  void begin() {
    m_measuring = true;
    m_sizes.clear();
    for (auto& bot : m_bots) bot->resetFigures();
    for (auto& checker : m_checkers) checker->forget();
    m_cpu = cpuMicros();
    m_began = Clock::now();
    say("begun");
  }

  void end() {
    m_measuring = false;
    const double micros = cpuMicros() - m_cpu;
    const double wall = std::chrono::duration<double, std::micro>(Clock::now() - m_began).count();
    std::uint64_t received = 0, missing = 0, bytes = 0, silent = 0;
    for (const auto& bot : m_bots) {
      received += bot->received;
      missing += bot->missing();
      bytes += bot->bytes;
      silent += bot->received == 0 ? 1 : 0;
    }
    std::printf("figures bots=%zu checked=%zu received=%llu missing=%llu bytes=%llu silent=%llu busy=%.4f\n",
                m_bots.size(), m_checkers.size(), static_cast<unsigned long long>(received),
                static_cast<unsigned long long>(missing), static_cast<unsigned long long>(bytes),
                static_cast<unsigned long long>(silent), micros / wall);
    for (const auto& checker : m_checkers) {
      if (m_sinking) break;
      for (const Checker::Picture& picture : checker->pictures()) {
        std::printf("picture %u %u %llx\n", picture.tick, checker->player(),
                    static_cast<unsigned long long>(picture.sum));
      }
    }
    say("done");
  }

  void sink() {
    m_sinking = true;
    std::ofstream sizes(m_folder + "/sizes");
    for (const std::size_t size : m_sizes) sizes << size << "\n";
    std::ofstream endpoints(m_folder + "/endpoints");
    for (auto& bot : m_bots) {
      bot->sink();
      endpoints << bot->endpoint() << "\n";
    }
    say("sunk");
  }

  void readCommands() {
    if (!bench::readInput(m_input)) m_ended = true;
    while (const auto line = bench::popLine(m_input)) {
      if (line->starts_with("go ")) go(std::stoul(line->substr(3)));
      if (*line == "begin") begin();
      if (*line == "end") end();
      if (*line == "sink") sink();
    }
  }

  static void say(const std::string& line) {
    std::printf("%s\n", line.c_str());
    std::fflush(stdout);
  }
  void fail(const std::string& why) {
    std::cerr << "naiad_capacity_bots: " << why << "\n";
    say("failed");
    m_ended = true;
  }

  asio::io_context m_context{1};
  Harbour m_harbour;
  naiad::Fingerprint m_fingerprint;
  std::string m_folder;
  int m_epoll;
  std::array<epoll_event, 512> m_events{};
  std::vector<std::unique_ptr<LightBot>> m_bots;
  std::vector<std::unique_ptr<Checker>> m_checkers;
  std::size_t m_watched = 0;  ///< number of bots that m_epoll watches, from the first on
  std::size_t m_wanted = 1;
  int m_next = 0;
  bool m_joined = true;
  bool m_measuring = false;
  bool m_sinking = false;
  bool m_ended = false;
  Clock::time_point m_updated{};
  Clock::time_point m_checkers_updated{};
  Clock::time_point m_deadline{};
  Clock::time_point m_began{};
  double m_cpu = 0;
  std::vector<std::size_t> m_sizes;
  std::string m_input;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 6) return 2;
  if (!pinTo(std::stoi(argv[1]))) return 3;
  naiad::raiseOpenFileLimit(SIZE_MAX);
  return bench::guarded("naiad_capacity_bots", [&]() -> int {
    const auto port = static_cast<std::uint16_t>(std::stoi(argv[3]));
    Crowd crowd(argv[2], port, *naiad::Fingerprint::parse(argv[4]), argv[5]);
    crowd.run();
    std::quick_exit(0);  // faster than closing thousands of streams
  });
}

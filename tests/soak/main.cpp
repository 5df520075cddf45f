// naiad_soak: a server and bots over bad links in virtual time. Compares every client's screen with the
// server's.
//
// Exit codes: 0 success, 1 a failure (the last lines describe it), 2 invalid command line.
#include <malloc.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "Bot.h"
#include "Judge.h"
#include "Tally.h"
#include "VirtualHost.h"
#include "engine/world/World.h"
#include "engine/world/WorldLog.h"

namespace naiad::soak {

namespace {

constexpr std::uint64_t kTicksPerSecond = 30;
constexpr std::uint64_t kSeed = 1;
constexpr int kCreatures = 200;
constexpr int kParts = 4;  ///< parts of a tick, in each of which bots check timeouts
/// Seconds without events at the end: the time in which streams recover from earlier events, and 5 s more.
constexpr std::uint64_t kQuietSeconds = 20;
/// Warm-up time. In it memory grows until all buffers and tables have had their maximum sizes: with 8 bots
/// from 2 MB to 9 MB. After it memory stays constant.
constexpr double kWarmUpMinutes = 10;
/// Minimum run time for judging memory growth.
constexpr double kJudgedMinutes = 30;
/// Memory is averaged over this fraction of the time after the warm-up, at its start and at its end, because
/// clients join and leave. The two means are compared.
constexpr double kCompared = 0.2;
/// Number of right pictures in a row that each client must have had at the end.
constexpr std::uint64_t kRightInTheEnd = 10;

double mean(const std::vector<double>& values) {
  return values.empty()
             ? 0
             : std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

struct SoakOptions {
  int bots = 64;
  double minutes = 60;
  double haste = 1;          ///< factor for the rate of events
  std::uint32_t stride = 5;  ///< every `stride`-th tick of each player is compared
};

class Soak {
 public:
  explicit Soak(const SoakOptions& options);
  ~Soak();

  /// Runs the test, prints progress on stderr and the result on stdout. True if nothing went wrong.
  bool run();

 private:
  void tick();
  void hear(const Heard& heard);
  void report() const;
  void finish();
  bool isQuiet(Bot& bot) const;
  void measureMemory(double minute);
  /// Returns the growth of memory after the warm-up, in percent; nullopt if the run was too short.
  std::optional<double> memoryGrowth() const;
  bool conclude();

  SoakOptions m_options;
  VirtualClock m_clock;
  VirtualNetwork m_network;
  test::Census m_census;
  df::World m_world;
  df::World::Scope m_scope;
  VirtualHost m_host;
  Tally m_tally;
  Judge m_judge;
  std::vector<std::unique_ptr<Bot>> m_bots;
  std::uint64_t m_ticks = 0;
  int m_unwell = 0;             ///< clients with a wrong picture, or without datagrams, at the end
  std::vector<double> m_early;  ///< samples of the bytes in use, soon after the warm-up
  std::vector<double> m_late;
};

Soak::Soak(const SoakOptions& options)
    : m_options(options),
      m_network(m_clock, LinkConditions{}, kSeed),
      m_scope(m_world),
      m_host(m_world, m_clock, m_network, *makeEndpoint("10.0.0.1", 9876), kSeed + 1),
      m_judge(m_world, m_host, m_tally, options.stride) {
  m_world.log().setSink([](const std::string&) {});
  m_census.on_heard = [this](const Heard& heard) { hear(heard); };
  // A map three screens wide.
  test::populateBusyWorld(m_world, kCreatures, &m_census,
                          {.width = 240, .height = 60, .is_rich = true, .seed = kSeed + 2});
  SplitMix64 seeds(kSeed + 3);
  const Bot::Place place{m_clock, m_network, m_host, *makeEndpoint("10.0.0.1", 9876), m_tally};
  for (int i = 0; i < options.bots; ++i) {
    m_bots.push_back(
        std::make_unique<Bot>(place, i, seeds.next(), options.haste,
                              [this](Bot& bot, const SnapshotHeader& header, const AckWindow& acks) {
                                m_judge.look(bot, header, acks);
                              }));
  }
}

Soak::~Soak() {
  m_bots.clear();
  m_world.shutDown();
}

void Soak::hear(const Heard& heard) {
  for (const auto& bot : m_bots) {
    if (bot->player() == heard.player) return bot->heard(heard);
  }
}

void Soak::tick() {
  ++m_ticks;
  const VirtualClock::Time begin{static_cast<VirtualClock::Time::rep>(m_ticks * 1'000'000 / kTicksPerSecond)};
  const VirtualClock::Time before = m_clock.now();
  for (int i = 1; i <= kParts; ++i) {
    m_clock.advanceTo(before + (begin - before) * i / kParts);
    for (const auto& bot : m_bots) bot->update();
  }
  for (const auto& bot : m_bots) bot->tick();
  m_host.tick([this] { m_judge.keepTruths(); });
  m_judge.judge();
}

bool Soak::run() {
  const auto ticks =
      static_cast<std::uint64_t>(m_options.minutes * 60 * static_cast<double>(kTicksPerSecond));
  for (std::uint64_t i = 1; i <= ticks; ++i) {
    tick();
    if (i % (5 * kTicksPerSecond) == 0) measureMemory(static_cast<double>(i) / (60.0 * kTicksPerSecond));
    if (i % ((m_options.minutes > 20 ? 300u : 60u) * kTicksPerSecond) == 0) report();
  }
  finish();
  return conclude();
}

void Soak::measureMemory(double minute) {
  if (m_options.minutes < kJudgedMinutes || minute <= kWarmUpMinutes) return;
  const struct mallinfo2 info = mallinfo2();
  const double bytes =
      static_cast<double>(info.uordblks + info.hblkhd) - static_cast<double>(m_judge.bytesKept());
  const double share = (minute - kWarmUpMinutes) / (m_options.minutes - kWarmUpMinutes);
  if (share <= kCompared) m_early.push_back(bytes);
  if (share > 1 - kCompared) m_late.push_back(bytes);
}

std::optional<double> Soak::memoryGrowth() const {
  if (m_early.empty()) return std::nullopt;
  return 100 * (mean(m_late) / mean(m_early) - 1);
}

void Soak::finish() {
  for (const auto& bot : m_bots) bot->rest();
  m_judge.lookAtAll();
  for (std::uint64_t i = 0; i < kQuietSeconds * kTicksPerSecond; ++i) tick();
  for (const auto& bot : m_bots) {
    m_tally.inputs_lost += bot->unheard();
    if (isQuiet(*bot)) continue;
    ++m_unwell;
    std::fprintf(stderr, "not well in the end: %s, %llu pictures right in a row\n", bot->describe().c_str(),
                 static_cast<unsigned long long>(m_judge.rightInARow(bot->player())));
  }
}

bool Soak::isQuiet(Bot& bot) const {
  ClientSession* session = bot.session();
  if (session == nullptr || session->state() != ClientSession::State::kPlaying) return false;
  if (session->isDetached() || !session->hasDatagrams(timeOf(m_clock))) return false;
  const Session* far = m_host.find(bot.player());
  return far != nullptr && far->transport().isOpen(timeOf(m_clock)) &&
         m_judge.rightInARow(bot.player()) >= kRightInTheEnd;
}

unsigned long long number(std::uint64_t value) {
  return value;
}

void Soak::report() const {
  std::fprintf(
      stderr,
      "%3.0f min: players=%zu snapshots=%llu compared=%llu wrong_cells=%llu divergences=%llu stuck=%llu "
      "resumed=%llu lost_sessions=%llu bytes_in_use=%.0f\n",
      static_cast<double>(m_clock.now().count()) / 60e6, m_host.playing(), number(m_tally.snapshots),
      number(m_tally.compared), number(m_tally.wrong_cells),
      number(m_host.counters().divergences + m_tally.wrong_checksums), number(m_tally.stuck),
      number(m_tally.resumed), number(m_tally.lost_sessions),
      static_cast<double>(mallinfo2().uordblks) - static_cast<double>(m_judge.bytesKept()));
}

bool Soak::conclude() {
  std::uint64_t blocked = 0;
  std::uint64_t outages = 0;
  for (const auto& bot : m_bots) {
    blocked += bot->weather().blockades();
    outages += bot->weather().outages();
  }
  const std::uint64_t divergences = m_host.counters().divergences + m_tally.wrong_checksums;
  std::printf("soak bots=%d minutes=%g snapshots=%llu compared=%llu compared_cells=%llu wrong_cells=%llu ",
              m_options.bots, m_options.minutes, number(m_tally.snapshots), number(m_tally.compared),
              number(m_tally.compared_cells), number(m_tally.wrong_cells));
  std::printf(
      "divergences=%llu stuck=%llu unwell=%d thrown_out=%llu joins=%llu resumed=%llu lost_sessions=%llu ",
      number(divergences), number(m_tally.stuck), m_unwell, number(m_tally.thrown_out), number(m_tally.joins),
      number(m_tally.resumed), number(m_tally.lost_sessions));
  std::printf("outages=%llu blocked=%llu rebound=%llu broken=%llu killed=%llu left=%llu ", number(outages),
              number(blocked), number(m_tally.rebound), number(m_tally.broken), number(m_tally.killed),
              number(m_tally.left));
  std::printf("inputs=%llu inputs_lost=%llu inputs_wrong=%llu inputs_dropped=%llu", number(m_tally.inputs),
              number(m_tally.inputs_lost), number(m_tally.inputs_wrong), number(m_tally.inputs_dropped));
  if (const auto growth = memoryGrowth()) std::printf(" memory_growth_percent=%.2f", *growth);
  std::printf("\n");
  std::fprintf(stderr, "server: %s\n", m_host.counters().summary().c_str());
  return m_tally.wrong_cells == 0 && divergences == 0 && m_tally.stuck == 0 && m_unwell == 0 &&
         m_tally.thrown_out == 0 && m_tally.lost_sessions == 0 && m_tally.inputs_lost == 0 &&
         m_tally.inputs_wrong == 0 && m_tally.compared > 0 && memoryGrowth().value_or(0) < 10;
}

bool parse(int argc, char** argv, SoakOptions& options) {
  if (argc == 2 && std::strcmp(argv[1], "--quick") == 0) {
    options = {.bots = 12, .minutes = 1.5, .haste = 8, .stride = 1};
    return true;
  }
  for (int i = 1; i < argc; i += 2) {
    const std::string name = argv[i];
    char* end = nullptr;
    const double value = i + 1 < argc ? std::strtod(argv[i + 1], &end) : -1;
    if (value < 0 || *end != '\0' || (name != "--bots" && name != "--minutes")) return false;
    if (name == "--minutes") options.minutes = value;
    if (name == "--bots") options.bots = std::clamp(static_cast<int>(value), 1, 1000);
  }
  return true;
}

}  // namespace
}  // namespace naiad::soak

int main(int argc, char** argv) {
  naiad::soak::SoakOptions options;
  if (!naiad::soak::parse(argc, argv, options)) {
    std::fprintf(stderr,
                 "usage: naiad_soak [--bots N] [--minutes M]\n"
                 "       naiad_soak --quick    12 bots, 1.5 minutes, every tick, 8 times as many events\n");
    return 2;
  }
  naiad::soak::Soak soak(options);
  return soak.run() ? 0 : 1;
}

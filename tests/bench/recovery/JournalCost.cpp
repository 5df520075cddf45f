#include "JournalCost.h"

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "host/journal/DeterminismCheck.h"
#include "host/journal/JournalWriter.h"
#include "host/journal/RoundRecovery.h"
#include "host/rounds/Round.h"
#include "host/world/WorldProcess.h"
#include "shared/values/SplitMix64.h"
#include "tests/bench/ElapsedTime.h"

namespace bench {
namespace {

using naiad::Journal;
using naiad::Round;

constexpr int kTicks = 20'000;
constexpr int kRuns = 5;
constexpr std::size_t kAnswer = 400;  ///< bytes in a world's answer, for a busy scene

struct Nowhere : naiad::JournalSink {
  void write(std::string_view /*bytes*/) override {}
  void sync() override {}
  void setFlags(std::uint16_t /*flags*/) override {}
};

/// A world that answers at once. If `hashes` is true, it hashes its answers like a journaled world.
class StubWorld : public naiad::WorldPort {
 public:
  explicit StubWorld(bool hashes) : m_hashes(hashes) {}
  bool isReady() const override { return true; }
  void tick(const naiad::SentTurn& /*turn*/) override {
    ++m_ticks;
    if (m_hashes) m_answer.hash = naiad::hashAnswer(m_fields);
    reportTick();
  }
  std::uint32_t nextTick() const override { return m_ticks + 1; }
  const df::WorldView& view() const override { return m_view; }

 private:
  const bool m_hashes;
  std::uint32_t m_ticks = 0;
  std::string m_fields = std::string(kAnswer, 'x');
  df::WorldView m_view;
};

double nanosPerTick(Round& round, int players) {
  naiad::SplitMix64 random(3);
  const double began = cpuNanoseconds();
  for (int tick = 0; tick < kTicks; ++tick) {
    for (int player = 1; player <= players; ++player) {
      if (random.below(10) >= 3) continue;
      df::InputQueue::Input key{.kind = df::InputQueue::kKey, .player = static_cast<std::uint32_t>(player)};
      key.key = static_cast<df::Keyboard::Key>(random.below(12));
      key.key_action = static_cast<df::EventKeyboardAction>(random.below(3));
      round.addInput(key);
    }
    round.tick(true, false);
  }
  return (cpuNanoseconds() - began) / kTicks;
}

double plain(int players) {
  Round round(std::make_unique<StubWorld>(false));
  return nanosPerTick(round, players);
}

double journaled(int players) {
  Round::JournalBinding book;
  book.writer = std::make_shared<naiad::JournalWriter>();
  book.journal = std::make_shared<Journal>(std::make_unique<Nowhere>(), naiad::DfrHeader(), naiad::DfrFacts(),
                                           std::size_t{4} << 20, false);
  book.writer->add(book.journal);
  Round round(std::make_unique<StubWorld>(true), std::move(book));
  return nanosPerTick(round, players);
}

}  // namespace

// Returns the minimum of several measurements, because other load only adds time.
double journalNanos(int players) {
  double least = 1e12;
  double without = 1e12;
  for (int run = 0; run < kRuns; ++run) {
    least = std::min(least, journaled(players));
    without = std::min(without, plain(players));
  }
  return least - without;
}

}  // namespace bench

// The cost of a journal for the thread that ticks.
#pragma once

#include <algorithm>
#include <memory>
#include <string>

#include "host/journal/DeterminismCheck.h"
#include "host/journal/JournalWriter.h"
#include "host/journal/RoundRecovery.h"
#include "host/rounds/Round.h"
#include "host/world/WorldProcess.h"
#include "shared/values/SplitMix64.h"
#include "tests/bench/ElapsedTime.h"

namespace bench {

inline constexpr int kTicks = 20'000;

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
  /// A world's answer, as long as for a busy scene.
  std::string m_fields = std::string(400, 'x');
  df::WorldView m_view;
};

inline double nanosPerTick(naiad::Round&& round, int players) {
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

/// Returns the nanoseconds per tick that a journal adds to a Round with this many players, each with nine
/// keys a second. Includes hashing an answer of typical size, but not the world. It is the minimum of several
/// measurements, because other load only adds time.
inline double journalNanos(int players) {
  double least = 1e12;
  double without = 1e12;
  for (int run = 0; run < 5; ++run) {
    naiad::Round::JournalBinding book;
    book.writer = std::make_shared<naiad::JournalWriter>();
    book.journal = std::make_shared<naiad::Journal>(std::make_unique<Nowhere>(), naiad::DfrHeader(),
                                                    naiad::DfrFacts(), std::size_t{4} << 20, false);
    book.writer->add(book.journal);
    least = std::min(least,
                     nanosPerTick(naiad::Round(std::make_unique<StubWorld>(true), std::move(book)), players));
    without = std::min(without, nanosPerTick(naiad::Round(std::make_unique<StubWorld>(false)), players));
  }
  return least - without;
}

}  // namespace bench

// A second world gets the turns of the first. A difference is reported once, with its tick and kind.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "host/journal/DeterminismCheck.h"

namespace naiad {
namespace {

df::WorldView viewOf(double x) {
  df::WorldView view;
  df::ObjectFacts facts;
  facts.order = 3;
  facts.position = {static_cast<df::Fixed>(x * static_cast<double>(df::kFixedOne)), 0};
  view.changed.push_back(facts);
  return view;
}

/// Answers at once; from tick `strays_at` on, its Object is elsewhere.
class QuickWorld : public WorldPort {
 public:
  QuickWorld(std::vector<WorldTurn>& turns, std::uint32_t strays_at)
      : m_turns(turns), m_strays_at(strays_at) {}
  bool isReady() const override { return true; }
  void tick(const SentTurn& turn) override {
    m_turns.push_back(turn.turn);
    ++m_tick;
    m_answer.hash = m_tick < m_strays_at ? 7 : 8;
    m_view = viewOf(m_tick < m_strays_at ? 1 : 2.5);
    reportTick();
  }
  std::uint32_t nextTick() const override { return m_tick + 1; }
  const df::WorldView& view() const override { return m_view; }

 private:
  std::vector<WorldTurn>& m_turns;
  std::uint32_t m_strays_at;
  std::uint32_t m_tick = 0;
  df::WorldView m_view;
};

struct Checked {
  std::vector<WorldTurn> turns;  ///< turns of the second world
  std::vector<std::string> said;
  std::uint32_t updates = 0;  ///< updates until the check was over

  explicit Checked(std::uint32_t strays_at) {
    DeterminismCheck check([&] { return std::make_unique<QuickWorld>(turns, strays_at); },
                           [this](const std::string& sentence) { said.push_back(sentence); });
    for (; updates < 5000; ++updates) {
      WorldTurn turn;
      turn.watched = true;
      turn.input_player = updates + 1;
      if (updates == 4) turn.inputs.push_back({.kind = df::InputQueue::kLeave, .player = 5});
      check.add({turn, {}}, 7, viewOf(1));
      if (!check.update()) break;
    }
  }
};

TEST(DeterminismCheck, DeterministicGameReportsNothingAndTheCheckEnds) {
  const Checked checked(UINT32_MAX);
  EXPECT_TRUE(checked.said.empty());
  ASSERT_EQ(checked.turns.size(), DeterminismCheck::kTicks);
  EXPECT_LT(checked.updates, DeterminismCheck::kTicks + DeterminismCheck::kDelay) << "it catches up";
  EXPECT_EQ(checked.turns[0].input_player, 1u) << "the same turns, from the first on";
  EXPECT_EQ(checked.turns[899].input_player, 900u);
  EXPECT_EQ(checked.turns[4].inputs.size(), 1u);
}

TEST(DeterminismCheck, DifferenceIsReportedOnceWithTickAndObject) {
  const Checked checked(300);
  EXPECT_EQ(checked.said, (std::vector<std::string>{"the game is not repeatable: when replayed, in tick 300 "
                                                    "Object 3 is at (2.50, 0.00), not at (1.00, 0.00)"}));
  EXPECT_EQ(checked.turns.size(), 300u) << "and nothing is compared any more";
}

}  // namespace
}  // namespace naiad

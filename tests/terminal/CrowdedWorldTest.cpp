// The real dfclient with worlds whose pictures would take minutes: it continues to draw, handles keys and
// quits on request. Hostile servers can send such worlds, and so can games that pile up their objects.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>

#include <chrono>
#include <vector>

#include "FakeServer.h"
#include "shared/values/Keyboard.h"
#include "shared/values/SplitMix64.h"
#include "tests/support/CellsAt.h"

namespace naiad::test {
namespace {

using namespace std::chrono_literals;

constexpr std::uint32_t kTick = 100;  // tick of FakeServer's snapshots
/// Time from a key or signal to the end, on a busy machine. Without the work limit it would take minutes.
constexpr auto kSoon = 20s;

/// Returns small, HARD, moving objects in one cell.
std::vector<ObjectState> pileOf(int count) {
  SplitMix64 rng(3);
  std::vector<ObjectState> pile;
  for (int i = 0; i < count; ++i) {
    ObjectState state;
    state.order = static_cast<std::uint64_t>(i) + 100;
    state.motion = {kTick,
                    cellsAt(40 + rng.unit(), 12 + rng.unit()),
                    cellsAt(rng.unit() * 0.4 - 0.2, rng.unit() * 0.2 - 0.1),
                    {}};
    state.look.sequence = {{Glyph{0, 0, U'*', df::RED}}};
    state.body.box = {{0, 0}, {df::kFixedOne / 50, df::kFixedOne / 50}};
    pile.push_back(state);
  }
  return pile;
}

class CrowdedWorldTest : public FakeServerFixture {
 protected:
  /// Sends the objects and checks that the client still handles a key.
  void show(PtyTerminal& terminal, const std::vector<ObjectState>& objects,
            const df::ControlTable* p_table = nullptr, const ControlRecord* p_control = nullptr) {
    ASSERT_TRUE(terminal.waitFor("NAIAD-HERE")) << terminal.output();
    ASSERT_TRUE(terminal.waitFor("\033[?u"));
    const std::uint32_t last = server.sendWorld(objects, p_table, p_control);
    ASSERT_TRUE(server.heardAcknowledged(last));
    // The client now predicts beyond the last snapshot, which is the costly part.
    ASSERT_TRUE(terminal.waitFor("No data from the server"));
    terminal.type("x");
    ASSERT_TRUE(server.heardKey(df::Keyboard::X, df::KEY_PRESSED));
  }
};

TEST_F(CrowdedWorldTest, ControlCLeavesAWorldOf48000Objects) {
  PtyTerminal terminal(options());
  show(terminal, pileOf(48'000));
  const auto asked = std::chrono::steady_clock::now();
  terminal.type("\x03");
  EXPECT_EQ(WEXITSTATUS(terminal.waitForExit()), 0);
  EXPECT_LT(std::chrono::steady_clock::now() - asked, kSoon);
}

TEST_F(CrowdedWorldTest, SignalEndsPredictionAmong20000LargeObjects) {
  // All objects block the player's own object, and each has a look that fills the view.
  std::vector<ObjectState> objects = pileOf(20'000);
  Appearance look;
  for (int i = 0; i < 80 * 24; ++i) {
    look.push_back({(i % 80 - 40) << kGlyphUnitBits, (i / 80 - 12) << kGlyphUnitBits, U'#', df::GREEN});
  }
  objects.front().look.sequence = {look};
  for (ObjectState& object : objects) object.motion.acceleration = {1, 0};
  df::ControlTable table;
  table.rows = {{df::Keyboard::X, df::KEY_PRESSED, df::ControlEffect::kVelocity, true, true, cellsAt(1, 0)}};
  ControlRecord control;
  control.tick = kTick;
  control.slot = 100;
  control.generation = 1;
  control.position = objects.front().motion.position;
  control.velocity = cellsAt(0.1, 0);
  control.state.steering = true;

  PtyTerminal terminal(options());
  show(terminal, objects, &table, &control);
  const auto asked = std::chrono::steady_clock::now();
  terminal.signal(SIGTERM);
  EXPECT_TRUE(diesOf(terminal, SIGTERM));
  EXPECT_LT(std::chrono::steady_clock::now() - asked, kSoon);
  EXPECT_TRUE(sameModes(terminal.originalModes(), terminal.currentModes()));
}

}  // namespace
}  // namespace naiad::test

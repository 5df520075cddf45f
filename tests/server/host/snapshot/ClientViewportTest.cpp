#include <gtest/gtest.h>

#include <deque>
#include <map>
#include <vector>

#include "DirectSender.h"
#include "SimulatedWorld.h"
#include "host/snapshot/ClientViewport.h"
#include "shared/replica/ViewCrop.h"
#include "tests/support/CellsAt.h"

namespace naiad {
namespace {

using test::cellsAt;
/// A ship in a large world and a view of 80 by 24 cells at (100, 50) that follows it.
class Scene {
 public:
  Scene() {
    m_view.boundary = {cellsAt(0, 0), cellsAt(400, 200)};
    m_ship.key = {0, 1};
    m_ship.order = 1;
    player.id = 1;
    player.view_corner = cellsAt(100, 50);
    put(140, 62, 0);
  }
  void put(double x, double y, double speed) {
    m_ship.position = cellsAt(x, y);
    m_ship.velocity = cellsAt(speed, 0);
    m_view.changed.push_back(m_ship);
  }
  void follow() { player.followed = m_ship.key; }
  CellRect tick(ClientViewport& window) {
    ++m_view.tick;
    m_view.players = {player};
    m_publisher.update(m_view);
    m_view.changed.clear();
    return window.update(m_publisher, player, 4);
  }
  df::PlayerFacts player;

 private:
  df::WorldView m_view;
  df::ObjectFacts m_ship;
  Publisher m_publisher;
};

void expectRect(const CellRect& rect, std::int64_t left, std::int64_t top, std::int64_t right,
                std::int64_t bottom) {
  EXPECT_EQ(rect.left, left);
  EXPECT_EQ(rect.top, top);
  EXPECT_EQ(rect.right, right);
  EXPECT_EQ(rect.bottom, bottom);
}

TEST(ClientViewport, ALargeTerminalShowsTheViewAndNoMore) {
  for (const std::uint32_t size : {0u, 80u, 400u, 9999u, 0xFFFFFFFFu}) {
    Scene scene;
    ClientViewport window;
    window.setTerminal(size, size);
    expectRect(scene.tick(window), 100, 50, 180, 74);
  }
}

TEST(ClientViewport, TinyTerminalGetsTheMinimumViewport) {
  Scene scene;
  ClientViewport window;
  window.setTerminal(1, 1);
  const CellRect rect = scene.tick(window);
  EXPECT_GE(rect.right - rect.left, ClientViewport::kMinColumns);
  EXPECT_GE(rect.bottom - rect.top, ClientViewport::kMinRows);
}

TEST(ClientViewport, ViewportGrowsForAFastObjectAndShrinksLate) {
  Scene scene;
  scene.follow();
  ClientViewport window;
  window.setTerminal(20, 24);
  const CellRect slow = scene.tick(window);
  scene.put(140, 62, 1);
  const CellRect fast = scene.tick(window);
  EXPECT_GE((fast.right - fast.left) - (slow.right - slow.left), 24);
  scene.put(140, 62, 0);
  const CellRect stopped = scene.tick(window);
  EXPECT_GE((stopped.right - stopped.left) - (slow.right - slow.left), 20);
  CellRect later;
  for (int i = 0; i < 200; ++i) later = scene.tick(window);
  expectRect(later, slow.left, slow.top, slow.right, slow.bottom);
}

/// A client with a small terminal that draws the tick of three ticks ago, in a random world.
struct SmallClient {
  int columns = 20;
  int rows = 10;
  int shown_cells = 0;
  int wrong_cells = 0;
  std::size_t most_known = 0;
  std::size_t bytes = 0;
  SnapshotSender sender;

  void play(std::uint64_t seed, int ticks) {
    // Drawing outside objects would be one look for the whole view.
    test::PublishedWorld world(
        {.width = 120, .height = 60, .view_width = 80, .view_height = 40, .objects = 120, .scribble = 0},
        seed);
    test::SnapshotReader reader;
    std::map<std::uint32_t, df::Canvas> truth;
    std::deque<std::vector<SnapshotSender::Packet>> on_their_way;
    sender.setTerminal(static_cast<std::uint32_t>(columns), static_cast<std::uint32_t>(rows));
    for (int i = 0; i < ticks; ++i) {
      world.tick();
      sender.applyTick(world.publisher, world.player());
      truth.emplace(world.tickNumber(), world.picture(0));
      on_their_way.push_back(sender.build(world.publisher));
      most_known = std::max(most_known, sender.knownCount());
      if (on_their_way.size() <= 3) continue;
      for (const SnapshotSender::Packet& packet : on_their_way.front()) {
        bytes += packet.bytes.size();
        reader.read(packet.bytes);
      }
      on_their_way.pop_front();
      sender.acknowledge(reader.acks);
      compare(reader.replica, world.tickNumber() - 3, truth);
    }
  }
  void compare(const Replica& replica, std::uint32_t tick, std::map<std::uint32_t, df::Canvas>& truth) {
    const df::Canvas seen = replica.render(tick);
    const df::Canvas& wanted = truth.at(tick);
    const CellPosition focus = replica.focus(tick);
    const int width = std::min(columns, seen.width());
    const int height = std::min(rows, seen.height());
    const int left = cropStart(focus.x, width, seen.width());
    const int top = cropStart(focus.y, height, seen.height());
    for (int y = top; y < top + height; ++y) {
      for (int x = left; x < left + width; ++x) {
        ++shown_cells;
        wrong_cells += seen.at(x, y) == wanted.at(x, y) ? 0 : 1;
      }
    }
    truth.erase(tick);
  }
};

TEST(ClientViewport, ASmallTerminalIsDrawnRightAndCostsLess) {
  std::size_t small_bytes = 0;
  std::size_t full_bytes = 0;
  std::size_t small_known = 0;
  std::size_t full_known = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    SmallClient small;
    small.play(seed, 300);
    EXPECT_EQ(small.wrong_cells, 0) << "seed " << seed << ", of " << small.shown_cells;
    SmallClient full;
    full.columns = 80;
    full.rows = 40;
    full.play(seed, 300);
    EXPECT_EQ(full.wrong_cells, 0) << "seed " << seed;
    small_bytes += small.bytes;
    full_bytes += full.bytes;
    small_known += small.most_known;
    full_known += full.most_known;
  }
  EXPECT_LT(small_bytes * 10, full_bytes * 8);
  EXPECT_LT(small_known * 10, full_known * 8);
}

TEST(ClientViewport, ATerminalThatGrowsReceivesTheRest) {
  test::DirectSender direct(700);
  direct.sender.setTerminal(20, 10);
  direct.tick();
  EXPECT_LT(direct.sender.knownCount(), 450u);
  direct.sender.reset();
  direct.skip();
  EXPECT_LT(direct.sender.knownCount(), 450u) << "a reset forgets the world, not the terminal";
  direct.sender.setTerminal(80, 24);
  direct.skip();
  EXPECT_EQ(direct.sender.knownCount(), 700u);
}

}  // namespace
}  // namespace naiad

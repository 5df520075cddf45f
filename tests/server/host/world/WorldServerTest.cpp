// GM.run() in a process that a host started for a world. A thread of the test plays that process, the test
// the host.
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <thread>

#include "engine/events/EventKeyboard.h"
#include "engine/events/EventMouse.h"
#include "engine/managers/DisplayManager.h"
#include "engine/managers/GameManager.h"
#include "engine/managers/WorldManager.h"
#include "engine/world/InputQueue.h"
#include "engine/world/Object.h"
#include "engine/world/Views.h"
#include "engine/world/World.h"
#include "engine/world/WorldLog.h"
#include "host/world/WorldServer.h"

namespace naiad {
namespace {

/// Flies one cell per tick and counts the clicks that hit the place where it was drawn.
class Flyer : public df::Object {
 public:
  explicit Flyer(int& hits) : m_hits(hits) {
    setType("Flyer");
    setSolidness(df::SPECTRAL);
    setPosition(df::Vector(10, 5));
    setVelocity(df::Vector(1, 0));
    registerInterest(df::MSE_EVENT);
    registerInterest(df::KEYBOARD_EVENT);
  }
  int draw() override { return DM.drawCh(getPosition(), '#', df::RED); }
  int eventHandler(const df::Event* p_e) override {
    if (const auto* p_mouse = dynamic_cast<const df::EventMouse*>(p_e)) {
      m_hits += WM.objectsSeenAt(p_mouse->getMousePosition()).getCount();
    } else {
      GM.setGameOver();
    }
    return 1;
  }

 private:
  int& m_hits;
};

class WorldServerTest : public testing::Test {
 protected:
  /// The view follows the flyer through a wider world.
  WorldServerTest() {
    int sockets[2];
    EXPECT_EQ(socketpair(AF_UNIX, SOCK_STREAM, 0, sockets), 0);
    m_socket = sockets[0];
    m_thread = std::thread([this, theirs = sockets[1]] {
      df::World world;
      world.log().setSink([](const std::string&) {});
      const df::World::Scope scope(world);
      world.input().setLagCompensated(true);
      world.setHelp({"fly"});
      world.views().setWindow(80, 30);
      auto* p_flyer = new Flyer(hits);
      world.views().setBoundary(df::Box(df::Vector(), 400, 24));
      world.views().follow(nullptr, p_flyer);
      WorldServer(theirs, true).run(world);
      over = world.isGameOver();
      world.shutDown();
    });
    ready = readReady(receive());
  }
  ~WorldServerTest() override { end(); }
  void end() {
    if (m_socket >= 0) close(m_socket);
    m_socket = -1;
    if (m_thread.joinable()) m_thread.join();
  }

  void send(const std::string& bytes) const {
    EXPECT_EQ(::send(m_socket, bytes.data(), bytes.size(), MSG_NOSIGNAL), static_cast<ssize_t>(bytes.size()));
  }
  /// Reads a frame's fields; "end" if there is no frame.
  std::string receive() const {
    char head[kWorldFrameHead];
    if (recv(m_socket, head, sizeof head, MSG_WAITALL) != sizeof head) return "end";
    std::string fields(loadLittleEndian<std::uint32_t>(head), '\0');
    if (fields.empty()) return fields;
    return recv(m_socket, fields.data(), fields.size(), MSG_WAITALL) == static_cast<ssize_t>(fields.size())
               ? fields
               : "end";
  }
  WorldAnswer turn(std::vector<df::InputQueue::Input> inputs = {}, bool watched = true) {
    std::string record;
    std::string message;
    EXPECT_TRUE(m_turns.write({std::move(inputs), watched}, record));
    appendTurnMessage(record, false, message);
    send(message);
    const auto answer = readAnswer(receive(), m_views, view);
    EXPECT_TRUE(answer);
    return answer.value_or(WorldAnswer());
  }
  static df::InputQueue::Input join(std::uint32_t player) {
    return {.kind = df::InputQueue::kJoin, .player = player, .name = "ann", .color = df::RED};
  }
  /// Player 7, who saw tick `seen`, clicks in two columns of the flyer's row. Returns the number of hits.
  int hitsOfClicks(const df::ViewedTick& seen, int x, int other_x) {
    for (const int column : {x, other_x}) {
      turn({{.kind = df::InputQueue::kMouse,
             .player = 7,
             .seen = seen,
             .button = df::Mouse::LEFT,
             .mouse_action = df::CLICKED,
             .x = column,
             .y = 5}});
    }
    end();
    return hits;
  }

  int hits = 0;
  bool over = false;
  df::WorldView view;
  std::optional<WorldReady> ready;

 private:
  int m_socket = -1;
  TurnRecordWriter m_turns;
  ViewReader m_views;
  std::thread m_thread;
};

TEST_F(WorldServerTest, SaysWhatTheGameHasSetUp) {
  ASSERT_TRUE(ready);
  EXPECT_EQ(ready->window_width, 80);
  EXPECT_EQ(ready->window_height, 30);
  EXPECT_EQ(ready->help, std::vector<std::string>{"fly"});
}

TEST_F(WorldServerTest, TicksOncePerTurnAndSendsWatchedViews) {
  EXPECT_FALSE(turn({}, false).has_view);
  EXPECT_TRUE(turn({join(7)}).has_view);
  EXPECT_EQ(view.tick, 2u);
  ASSERT_EQ(view.changed.size(), 1u);
  EXPECT_EQ(view.changed[0].position.x, df::fromCells(12));
  ASSERT_EQ(view.players.size(), 1u);
  EXPECT_EQ(view.players[0].id, 7u) << "the host gives the ids";
  turn();
  EXPECT_EQ(view.tick, 3u);
}

TEST_F(WorldServerTest, ClickUsesObjectsAndViewOnThePlayersScreen) {
  turn({join(7)});
  while (view.tick < 80) turn();
  // The flyer was in cell 88 in tick 78, at two thirds of the view. Both have moved to the right since.
  EXPECT_EQ(hitsOfClicks({true, 76, 78}, 53, 55), 1);
}

TEST_F(WorldServerTest, GameOverByAPlayerReportsALeaver) {
  turn({join(7)});
  const WorldAnswer answer = turn(
      {{.kind = df::InputQueue::kKey, .player = 7, .key = df::Keyboard::Q, .key_action = df::KEY_PRESSED}});
  EXPECT_EQ(answer.leavers, std::vector<std::uint32_t>{7});
  EXPECT_FALSE(answer.game_over);
}

TEST_F(WorldServerTest, IsOverWhenTheHostIsGone) {
  turn();
  end();
  EXPECT_TRUE(over);
}

TEST_F(WorldServerTest, IsOverAfterAMalformedTurn) {
  send(std::string("\1\0\0\0\xff", 5));
  EXPECT_EQ(receive(), "end");
  end();
  EXPECT_TRUE(over);
}

}  // namespace
}  // namespace naiad

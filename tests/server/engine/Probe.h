// Fixtures of the engine's tests: a world for each test, and an Object that records its events.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "engine/events/EventKeyboard.h"
#include "engine/events/EventOut.h"
#include "engine/managers/GameManager.h"
#include "engine/managers/WorldManager.h"
#include "engine/sprites/Sprite.h"
#include "engine/world/Capture.h"
#include "engine/world/EventCollision.h"
#include "engine/world/EventDispatch.h"
#include "engine/world/InputQueue.h"
#include "engine/world/Mover.h"
#include "engine/world/Object.h"
#include "engine/world/ObjectRegistry.h"
#include "engine/world/Views.h"
#include "engine/world/WorldStore.h"
#include "tests/support/LoggedWorld.h"

namespace df::test {

using Received = std::vector<std::string>;

/// A world that is current during a test, with its log lines.
class WorldTest : public ::testing::Test, protected LoggedWorld {
 protected:
  ~WorldTest() override { world.shutDown(); }  // while `received` exists

  void ticks(int n) {
    for (int i = 0; i < n; ++i) world.tick();
  }
  /// Returns the number of log lines that contain `text`.
  int logged(const std::string& text) const {
    int count = 0;
    for (const std::string& line : lines) count += line.find(text) != std::string::npos ? 1 : 0;
    return count;
  }
  /// Sends a keyboard event that belongs to no player.
  static void press(Keyboard::Key key, EventKeyboardAction action = KEY_PRESSED) {
    EventKeyboard event;
    event.setKey(key);
    event.setKeyboardAction(action);
    WM.onEvent(&event);
  }
  /// Runs a tick in which a player joins. Returns their id.
  std::uint32_t joined(const std::string& name, Color color = RED) {
    const std::uint32_t player = world.input().join(name, color);
    world.tick();
    return player;
  }
  /// Runs a tick in which these players press a key, in this order.
  void pressedBy(std::initializer_list<std::uint32_t> players, Keyboard::Key key) {
    for (const std::uint32_t player : players) world.input().key(player, key, KEY_PRESSED);
    world.tick();
  }
  /// Runs a tick in which a player leaves.
  void left(std::uint32_t player) {
    world.input().leave(player);
    world.tick();
  }
  /// Returns the contents of the window's `row`, without blanks, after each of `ticks` ticks.
  std::string shown(int row, int ticks) {
    std::string all;
    for (int i = 0; i < ticks; ++i) {
      world.tick();
      std::string text = world.picture().render({}).rowText(row);
      std::erase(text, ' ');
      all += text;
    }
    return all;
  }

  Received received;  // "name:event" entries of the Probes that share this list
};

struct PlacedObject : Object {
  explicit PlacedObject(Vector at) { setPosition(at); }
};

/// An Object that adds "name:event" to a list, then runs its handler.
class Probe : public Object {
 public:
  using Handler = std::function<void(Probe&, const Event&)>;

  explicit Probe(std::string name = "probe", std::vector<std::string>* p_received = nullptr, Vector at = {})
      : m_p_received(p_received) {
    setType(std::move(name));
    setPosition(at);
  }

  int eventHandler(const Event* p_e) override {
    if (m_p_received != nullptr) m_p_received->push_back(getType() + ":" + p_e->getType());
    const Handler handler = on_event;  // a copy, because the handler may delete this
    if (handler) handler(*this, *p_e);
    return 1;
  }

  int draw() override {
    if (on_draw) on_draw(*this);
    return 0;
  }

  /// Registers interest in events of this type, and runs `handler` for every event.
  void hear(const std::string& type, Handler handler) {
    registerInterest(type);
    on_event = std::move(handler);
  }

  Handler on_event;
  std::function<void(Probe&)> on_draw;

 private:
  std::vector<std::string>* m_p_received;
};

/// Makes a sprite whose frames have one row each.
inline Sprite spriteOf(const std::vector<std::string>& frames, int slowdown = 1) {
  Sprite sprite(static_cast<int>(frames.size()));
  sprite.setWidth(static_cast<int>(frames[0].size()));
  sprite.setHeight(1);
  sprite.setSlowdown(slowdown);
  for (const std::string& frame : frames) sprite.addFrame(Frame(sprite.getWidth(), 1, frame));
  return sprite;
}

inline void expectAt(const Object& o, double x, double y) {
  EXPECT_EQ(o.getPosition(), Vector(x, y));
}

}  // namespace df::test

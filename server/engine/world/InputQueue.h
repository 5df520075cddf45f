// What players did since the last tick, in the order it came. An input waits here for the next tick only: a
// host decides which tick that is (ReceivedInputs.h).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/world/GameRoom.h"
#include "engine/world/LagCompensation.h"
#include "shared/values/Color.h"
#include "shared/values/Keyboard.h"

namespace df {

class Event;
class World;

class InputQueue {
 public:
  /// kScore and kRoom are the host's own: a row that was kept of an earlier round (HighScores.h), and what is
  /// so of a room of the server (GameRooms.h). They are there at once, and send no event.
  enum Kind { kJoin, kLeave, kKey, kMouse, kScore, kRoom };
  /// One input; of the fields below `player`, those of its kind.
  struct Input {
    Kind kind;
    std::uint32_t player;
    ViewedTick seen = {};
    std::string name = {};
    Color color = COLOR_DEFAULT;
    Keyboard::Key key = Keyboard::UNDEFINED_KEY;
    EventKeyboardAction key_action = UNDEFINED_KEYBOARD_ACTION;
    Mouse::Button button = Mouse::UNDEFINED_MOUSE_BUTTON;
    EventMouseAction mouse_action = UNDEFINED_MOUSE_ACTION;
    int x = 0;  ///< cell of the player's view
    int y = 0;
    std::string table = {};  ///< of kScore, with `name` and `points`
    std::int64_t points = 0;
    GameRoom room = {};
  };

  explicit InputQueue(World& world) : m_world(world) {}

  /// Queue it, unless no player can have sent it: unknown keys, buttons and actions, clicks outside the view.
  /// Return the player's id; for a join, that is the first free one that is not before `input.player`.
  std::uint32_t push(Input input);
  void clear() { m_inputs.clear(); }
  /// Send the events of all that waits. What is pushed meanwhile waits for the next time.
  void drain();

 private:
  bool isPossible(const Input& input) const;
  bool isFiltered(const Event* p_event);
  void handle(const Input& input);
  void sendKey(const Input& input);
  void sendMouse(const Input& input);

  World& m_world;
  std::vector<Input> m_inputs;
};

}  // namespace df

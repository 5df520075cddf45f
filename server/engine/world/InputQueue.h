// The inputs of a world since the last tick, in order of arrival, and the one being handled. An input waits
// here only until the next tick; the host decides which tick that is (ReceivedInputs.h).
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "engine/world/GameRoom.h"
#include "engine/world/LagCompensation.h"
#include "engine/world/ObjectList.h"
#include "shared/values/Color.h"
#include "shared/values/Keyboard.h"
#include "shared/values/Vector.h"

namespace df {

class Event;
class EventDispatch;
class LazyExtras;
class Mover;
class ObjectRegistry;
class Views;
struct WorldState;

class InputQueue {
 public:
  /// kScore (a stored row of a table, HighScores.h) and kRoom (the state of a room of the server,
  /// GameRooms.h) come from the host itself. They take effect at once and send no event.
  enum Kind { kJoin, kLeave, kKey, kMouse, kScore, kRoom };
  /// One input. Which of the fields below `player` are used depends on the kind.
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
    std::string table = {};  ///< used by kScore, with `name` and `points`
    std::int64_t points = 0;
    GameRoom room = {};
  };

  /// The arguments must outlive this object.
  InputQueue(ObjectRegistry& objects, Views& views, EventDispatch& events, Mover& mover, LazyExtras& extras,
             const WorldState& state);

  // Functions for hosts. Inputs are handled in the next tick.

  /// Lets a player join. Returns the new id at once; the next tick makes the Player and sends the EventJoin.
  /// Ids count up from 1, and those below `id` are skipped. An id is used once, unless its player leaves and
  /// joins again in one tick.
  std::uint32_t join(const std::string& name, Color color, std::uint32_t id = 0);
  /// Lets a player leave in the next tick, which ignores an unknown id.
  void leave(std::uint32_t player);
  /// Adds a key. Ignores unknown keys, actions and players. `seen`: the picture that the player saw.
  void key(std::uint32_t player, Keyboard::Key key, EventKeyboardAction action, const ViewedTick& seen = {});
  /// Adds a mouse action at cell (x,y) of the player's view; ignored outside the view. The event's position
  /// is in world coordinates, computed from the view that the player saw, if the host knows it
  /// (setLagCompensation()), else from the view when the event is handled.
  void mouse(std::uint32_t player, EventMouseAction action, Mouse::Button button, int x, int y,
             const ViewedTick& seen = {});
  /// Adds an input. Ignores inputs that no player can have sent: unknown keys, buttons and actions, and mouse
  /// actions outside the view. Returns the player's id; for a join, that is the first free id that is not
  /// below `input.player`.
  std::uint32_t push(Input input);
  /// Returns the highest player id so far; 0 if no player has joined.
  std::uint32_t newestPlayer() const { return m_next_player - 1; }

  /// Sends the events of all waiting inputs. Inputs added during the call wait for the next call.
  void drain();
  /// Removes the waiting inputs and the players for popLeavers(), and resets setLagCompensated().
  void clear();

  /// Returns the id of the player whose join, leave, key or mouse is being handled; 0 if none is.
  std::uint32_t player() const { return m_player; }
  /// If set, a game over while a player's input is being handled does not end the game, but only means that
  /// this player wants to leave (popLeavers()). clear() keeps the setting.
  void setGameOverLeaves(bool leaves) { m_game_over_leaves = leaves; }
  /// Handles a game over. True if it only means that the player whose input is being handled wants to leave.
  bool handleGameOver();
  /// Removes and returns the players that wanted to leave (see setGameOverLeaves()).
  std::vector<std::uint32_t> popLeavers() { return std::exchange(m_leavers, {}); }

  /// Whether the game uses lag compensation. If it does not, the host need not record what players saw.
  void setLagCompensated(bool lag_compensated) { m_lag_compensated = lag_compensated; }
  bool isLagCompensated() const { return m_lag_compensated; }
  /// Sets the host's record of what players saw. Not owned; null for none.
  void setLagCompensation(const LagCompensation* p_lag_compensation) {
    m_p_lag_compensation = p_lag_compensation;
  }
  /// See WM.objectsSeenAt().
  ObjectList objectsSeenAt(Vector cell) const;

 private:
  bool isPossible(const Input& input) const;
  bool isFiltered(const Event* p_event);
  void handle(const Input& input);
  void sendKey(const Input& input);
  void sendMouse(const Input& input);

  ObjectRegistry& m_objects;
  Views& m_views;
  EventDispatch& m_events;
  Mover& m_mover;
  LazyExtras& m_extras;
  const WorldState& m_state;
  std::vector<Input> m_inputs;
  std::uint32_t m_next_player = 1;
  std::uint32_t m_player = 0;  // player whose input is being handled; 0: none
  ViewedTick m_seen;           // the picture that this player saw
  const LagCompensation* m_p_lag_compensation = nullptr;
  std::vector<std::uint32_t> m_leavers;
  bool m_game_over_leaves = false;
  bool m_lag_compensated = false;
};

}  // namespace df

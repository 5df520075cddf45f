// The input of a world: what players did since the last tick, in the order it came, and which of it is being
// handled. An input waits here for the next tick only: a host decides which tick that is (ReceivedInputs.h).
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

  /// All live longer than this.
  InputQueue(ObjectRegistry& objects, Views& views, EventDispatch& events, Mover& mover, LazyExtras& extras,
             const WorldState& state);

  // Functions for hosts. An input is handled in the next tick.

  /// A player joins. Return the new player's id at once; the Player and its EventJoin come in the next
  /// tick. Ids count up from 1 and are not used again; `id`: leave out those before this one.
  std::uint32_t join(const std::string& name, Color color, std::uint32_t id = 0);
  /// A player goes, in the next tick. An unknown id is ignored then.
  void leave(std::uint32_t player);
  /// A key. Unknown keys, actions and players are ignored. `seen`: what was on the player's screen then.
  void key(std::uint32_t player, Keyboard::Key key, EventKeyboardAction action, const ViewedTick& seen = {});
  /// The mouse, at cell (x,y) of the player's view; ignored outside it. The event's position is in world
  /// coordinates, by the view as the player saw it if the host says so (setLagCompensation()), else as it is
  /// when the event is handled.
  void mouse(std::uint32_t player, EventMouseAction action, Mouse::Button button, int x, int y,
             const ViewedTick& seen = {});
  /// Queue it, unless no player can have sent it: unknown keys, buttons and actions, clicks outside the view.
  /// Return the player's id; for a join, that is the first free one that is not before `input.player`.
  std::uint32_t push(Input input);
  /// Returns the highest player id used so far; 0 before the first.
  std::uint32_t newestPlayer() const { return m_next_player - 1; }

  /// Send the events of all that waits. What is pushed meanwhile waits for the next time.
  void drain();
  /// Forgets the waiting inputs, the leavers, and setLookingBack().
  void clear();

  /// The player whose join, leave, key or mouse is being handled; 0 outside that.
  std::uint32_t player() const { return m_player; }
  /// If set, a game over while a player's input is handled does not end the game: that player wants to leave,
  /// which is up to the host. It stays through clear().
  void setGameOverLeaves(bool leaves) { m_game_over_leaves = leaves; }
  /// Takes a game over. Returns true if it only means that the player whose input is handled wants to leave.
  bool takeGameOver();
  /// The players that wanted to leave since the last call.
  std::vector<std::uint32_t> takeLeavers() { return std::exchange(m_leavers, {}); }

  /// Does the game use lag compensation? Then the host should set it; otherwise it need not keep any history.
  void setLookingBack(bool looking_back) { m_looking_back = looking_back; }
  bool isLookingBack() const { return m_looking_back; }
  /// Says what players saw. Not owned; null for none.
  void setLagCompensation(const LagCompensation* p_lag_compensation) {
    m_p_lag_compensation = p_lag_compensation;
  }
  /// WM.objectsSeenAt().
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
  std::uint32_t m_player = 0;  // whose input is being handled
  ViewedTick m_seen;           // by that player
  const LagCompensation* m_p_lag_compensation = nullptr;
  std::vector<std::uint32_t> m_leavers;
  bool m_game_over_leaves = false;
  bool m_looking_back = false;
};

}  // namespace df

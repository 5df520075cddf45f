// One game world: all Objects that interact, from its seed to its tick count.
//
// Game code rarely names it: the managers (WM, GM, DM, IM, LM) forward to the calling thread's current
// world. Hosts and tests hold worlds directly, as many as they like, each on one thread at a time.
//
// A world is a pure function of its seed, its inputs and its tick count: it reads no clock and needs
// neither network nor terminal.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "Box.h"
#include "Canvas.h"
#include "Color.h"
#include "Contact.h"
#include "Event.h"
#include "Keyboard.h"
#include "Layer.h"
#include "ObjectList.h"
#include "Player.h"
#include "Random.h"
#include "Runner.h"
#include "Vector.h"
#include "detail/LagCompensation.h"
#include "detail/MoverStats.h"
#include "detail/WorldScope.h"
#include "detail/WorldView.h"

namespace df {

struct Activity;
struct ActivityPage;
class Capture;
class InputQueue;
class Interests;
class Mover;
class Object;
class Views;
class WorldStore;
struct WorldExtras;

class World {
 public:
  World();
  /// Objects that are still alive stay alive, in no world: their getters and setters go on working. (It is
  /// shutDown() that deletes.)
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  /// The calling thread's current world; where none was set, one default world that all such threads share
  /// and that is never destroyed, so that static Objects and cached references are safe.
  static World& current();

  /// Makes a world the current one of this thread while it lives. Scopes nest.
  using Scope = WorldScope;

  // Life.

  /// Delete what is alive and was made with `new`, take the rest out, and forget players, inputs,
  /// interests, boundary, views, ticks and game over. The world can be started again; seed, sink and runner
  /// stay. Called inside a tick, update, draw or event handler, it happens at its end, and the game
  /// is over until GM.startUp().
  void shutDown();
  /// Which managers are started: bits of their own choosing. (The world itself works without.)
  void setStarted(unsigned manager, bool started);
  bool isStarted(unsigned manager) const { return (m_started & manager) != 0; }

  // Time.

  /// One full tick: step event, input events, update(), draw(), then view() is filled if the world is
  /// watched. Nothing happens inside another tick, update or draw.
  void tick();
  /// Move all Objects once, in creation order, let the layers step, then delete what is marked. Nothing
  /// happens inside another update.
  void update();
  /// Begin a new picture: run the draw() of all Objects in view, by altitude, then creation order. Nothing
  /// happens inside a tick, which does it at its end.
  void draw();
  /// Run the game: through the Runner if one is set, else through program(), else tick() after tick() until
  /// the game is over. Without a Runner it goes on after a run that has ended, if GM.startUp() was called; a
  /// game that is over before the first one is over. Nothing happens inside a tick, update or draw.
  void run();
  /// Ticks begun since the world began.
  int getStepCount() const { return m_step_count; }
  /// Was run() or tick() called, ever?
  bool hasBegun() const { return m_begun; }
  void setGameOver(bool game_over = true);
  bool isGameOver() const { return m_game_over; }
  /// From now on a setGameOver() while a player's input is handled does not end the game: that player wants
  /// to leave, which is up to the host. It stays through shutDown().
  void setGameOverLeaves(bool leaves) { m_game_over_leaves = leaves; }
  /// The players that wanted to leave since the last call.
  std::vector<std::uint32_t> takeLeavers() { return std::exchange(m_leavers, {}); }
  /// Not owned; null for none.
  void setRunner(Runner* p_runner) { m_p_runner = p_runner; }
  Runner* getRunner() const { return m_p_runner; }
  /// Runs this world if it has no Runner (Runner.h); null if it has one, was made by hand, or no Program is
  /// set.
  running::Program* program() const;
  /// From now on `layer` takes part in update(), after the layers added before it. It lives as long as the
  /// world. Added by a layer's step(), or by a handler that it calls, it takes part in the same update().
  void addLayer(std::unique_ptr<Layer> layer) { m_layers.push_back(std::move(layer)); }
  /// The first layer of this class; null if there is none.
  template <class T>
  T* findLayer() const {
    for (const auto& layer : m_layers) {
      if (auto* p_layer = dynamic_cast<T*>(layer.get())) return p_layer;
    }
    return nullptr;
  }
  /// Restart the random sequence.
  void setSeed(std::uint64_t seed);
  /// 0 to n-1, each equally likely; 0 if n < 1.
  int randomInt(int n) { return m_random.below(n); }

  // Objects. WorldManager.h documents them under the same names.

  int insertObject(Object* p_o);
  int removeObject(Object* p_o);
  int markForDelete(Object* p_o);
  ObjectList getAllObjects(bool inactive = false) const;
  ObjectList objectsOfType(const std::string& type) const;
  ObjectList solidObjects() const;
  Object* objectWithId(int id) const;
  ObjectList getCollisions(const Object* p_o, Vector where) const;
  int moveObject(Object* p_o, Vector where);
  void setSweptCollisions(bool swept = true);
  bool getSweptCollisions() const;
  Contact firstContact(const Object* p_o, Vector where) const;
  std::optional<Vector> findFree(Box box, Vector near);
  /// The Object of a handle; null if it is gone.
  Object* find(ObjectKey key) const;
  /// Counts of the code paths that the moves have taken so far.
  const MoverStats& moverStats() const;
  [[deprecated("say moverStats()")]] const MoverStats& paths() const { return moverStats(); }
  ObjectList objectsSeenAt(Vector cell) const;
  /// Objects in the world, inactive ones included.
  int getObjectCount() const;

  // Events.

  /// Send to all Objects that registered interest in the event's type, in order of registration, as of now:
  /// an Object that registers meanwhile waits for the next event; one that is deleted, unregistered or made
  /// inactive meanwhile is skipped. Return to how many it was sent.
  int onEvent(const Event* p_event);
  /// Send to one Object, if it is alive and active. If its handler throws, the Object is made inactive,
  /// marked for deletion and logged. Return whether it was sent.
  bool deliver(ObjectKey key, const Event& event);

  // Boundary, views and players.

  int setBoundary(Box boundary);
  Box getBoundary() const;
  /// Size of the window, and so of every view: 20 to 400 by 10 to 150 cells. A boundary that was never
  /// set follows it. Return 0, else -1.
  int setWindow(int width, int height);
  int getWindowWidth() const;
  int getWindowHeight() const;
  /// The view of the player whose input is being handled, if they have one of their own, else the world's.
  Box getView() const;
  int setView(Box view);
  int setViewPosition(Vector centre);
  int setViewFollowing(Object* p_o);
  Object* getViewFollowing() const;
  std::vector<Player*> getPlayers() const;
  Player* getPlayer(std::uint32_t id) const;
  /// The player whose join, leave, key or mouse is being handled; 0 outside that.
  std::uint32_t inputPlayer() const { return m_input_player; }

  // Input, for the host. What is put in is handled in the next tick, in the order it came.

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
  /// Send the events of all queued input. tick() does this.
  void drainInput();
  /// Does the game use lag compensation? Then the host should set it; otherwise it need not keep any history.
  void setLookingBack(bool looking_back) { m_looking_back = looking_back; }
  bool isLookingBack() const { return m_looking_back; }
  /// Says what players saw. Not owned; null for none.
  void setLagCompensation(const LagCompensation* p_lag_compensation) {
    m_p_lag_compensation = p_lag_compensation;
  }
  [[deprecated("say setLagCompensation()")]] void setHindsight(const LagCompensation* p_lag_compensation) {
    setLagCompensation(p_lag_compensation);
  }

  // What a tick looks like.

  /// From now on fill view() in every tick; the first time with every Object as changed. Unwatched, only
  /// what was drawn is kept.
  void setWatched(bool watched);
  bool isWatched() const;
  /// What the last tick changed. Valid until the next tick begins.
  const WorldView& view() const;
  /// One character at a world position; one that no terminal draws in one cell becomes '?'. Return 0, or
  /// -1 for a position or colour out of range.
  int drawCh(Vector world_pos, char32_t ch, Color color);
  /// What the last tick drew, seen from a view with this corner.
  Canvas renderView(FixedVector corner) const;
  /// What this player sees: the view, their texts on top. Without such a player, the world's own view.
  Canvas renderPlayer(std::uint32_t player) const;

  // Log and refusals.

  using LogSink = std::function<void(const std::string& line)>;
  /// Where lines go; none: the file dragonfly.log (LogManager.h).
  void setLogSink(LogSink sink) { m_log_sink = std::move(sink); }
  /// Write one line, without newline at its end.
  void log(const std::string& line) const;
  /// Lines of writeLog(level, …) with a level above this are dropped.
  void setLogLevel(int level) { m_log_level = level; }
  int getLogLevel() const { return m_log_level; }
  void setLogFlush(bool flush) { m_log_flush = flush; }
  bool getLogFlush() const { return m_log_flush; }
  /// Log the line, unless it was logged by this before. Of very many different ones the first ones alone.
  void logOnce(const std::string& line) const;
  /// The same for a line that only the report of a crash shows: where it is a fault, one follows.
  void noteOnce(const std::string& line) const;
  /// Count a call that was refused, and log it, with what would have been right, if it is the first of its
  /// name for this type of Object.
  void refuse(const std::string& type, const char* what);
  /// Calls refused so far because of a number that was not finite or out of range.
  std::uint64_t getRefusals() const { return m_refusals; }

  // What only some games use.

  /// Behave as the published engine where it differs from the book (docs/dragonfly-api.md lists it). For new
  /// Objects, so before the first. Default: the book. It stays through shutDown().
  void setCompat(bool compat = true) { m_compat = compat; }
  bool compat() const { return m_compat; }
  /// Relative names of sprites, sounds and music are looked for in the working directory, then here. It stays
  /// through shutDown().
  void addResourceFolder(std::string folder);
  /// While a game is paused, no step event is sent and nothing moves; only Pause objects get events, except
  /// joins and leaves, which all get.
  void setPaused(bool paused = true);
  bool isPaused() const;
  /// Is the picture of a tick being drawn?
  bool isDrawing() const { return m_in_draw; }
  /// A sound was played; see WorldView.
  void noteSound(SoundPlayed sound);
  /// Sprites, sounds, settings and the like, made at first use.
  WorldExtras& extras();
  /// Null before the first extras().
  WorldExtras* findExtras() const { return m_p_extras.get(); }

  /// Lines about the game for the client's help screen.
  void setHelp(std::vector<std::string> lines) { m_help = std::move(lines); }
  const std::vector<std::string>& getHelp() const { return m_help; }

  // The engine's parts, which games do not use.

  WorldStore& store() { return *m_p_store; }
  const WorldStore& store() const { return *m_p_store; }
  Interests& interests() { return *m_interests; }
  Views& views() { return *m_views; }
  /// Where join(), leave(), key() and mouse() put their input.
  InputQueue& inputs() { return *m_input; }
  /// Run the eventHandler() of an Object in the world; see deliver(). Defined in InterestDispatch.h.
  inline void runHandler(ObjectKey key, Object& object, const Event& event);
  /// From now on note on this page what the game does (ActivityPage.h). Not owned; null for none.
  void setActivityPage(ActivityPage* p_page);
  /// Where the handler that runs is noted, with or without a page.
  Activity& activity() { return *m_p_activity; }
  /// Name the event's class on the page. Before the event is sent out.
  inline void nameClassOf(const Event& event);
  /// Note what the Object's class overrides.
  void learnType(std::uint32_t slot);
  /// Draw a static look again.
  void forgetLook(std::uint32_t slot);
  /// Draw the frame that shows now, of an Object that has frames.
  void drawFrame(std::uint32_t slot);
  /// Put an Object there, without a move: the views that follow it go with it, and it gets an out event if it
  /// leaves the world. For layers.
  void place(ObjectKey key, FixedVector where);
  /// Make an Object whose handler threw inactive, mark it for deletion, and log why.
  void quarantine(ObjectKey key, const std::string& why);

 private:
  friend class InputQueue;
  friend class Object;

  void learnNewcomers();
  void explainMissing(const std::string& type) const;
  void nameClass(std::uint32_t slot);
  void nameEvent(const Event& event);
  void drawObjects();
  void deleteMarked();
  void deleteAll();
  void forget(Object* p_o);
  void finishShutDown();
  template <class Wanted>
  ObjectList collect(Wanted wanted) const;
  bool owns(const Object* p_o) const;
  /// Is code of an Object running that has to return first?
  bool isBusy() const { return m_in_tick || m_in_update || m_in_draw || m_handlers > 0; }

  WorldStore* m_p_store;  // counted: outlives the world if Objects or lists do
  std::unique_ptr<Interests> m_interests;
  std::unique_ptr<Views> m_views;
  std::unique_ptr<Capture> m_capture;
  std::unique_ptr<InputQueue> m_input;
  std::unique_ptr<Mover> m_mover;
  std::vector<std::unique_ptr<Layer>> m_layers;
  std::unique_ptr<WorldExtras> m_p_extras;  // null until first use
  std::vector<ObjectKey> m_deletions;       // marked, in that order
  Random m_random;
  std::uint64_t m_seed = 1;
  Runner* m_p_runner = nullptr;
  LogSink m_log_sink;
  mutable std::set<std::string> m_logged;   // by logOnce()
  mutable std::set<std::string> m_missing;  // types that objectsOfType() was asked for in vain
  std::set<std::string> m_unowned;  // types marked for deletion, but not made with new, that were logged
  std::vector<std::string> m_help;
  std::uint64_t m_refusals = 0;
  std::uint32_t m_next_player = 1;
  std::uint32_t m_input_player = 0;
  ViewedTick m_input_seen;  // by that player
  const LagCompensation* m_p_lag_compensation = nullptr;
  bool m_looking_back = false;
  bool m_compat = false;
  int m_step_count = 0;
  int m_log_level = 0;
  unsigned m_started = 0;
  bool m_log_flush = false;
  bool m_begun = false;
  bool m_game_over = false;
  bool m_game_over_leaves = false;
  bool m_is_default = false;
  std::vector<std::uint32_t> m_leavers;
  bool m_in_tick = false;
  bool m_in_update = false;
  bool m_in_draw = false;
  int m_handlers = 0;  // eventHandler()s that are running, one inside the other
  std::unique_ptr<Activity> m_own_activity;
  Activity* m_p_activity;            // that, or the page's
  ActivityPage* m_p_page = nullptr;  // null: what the game does is not noted
  std::uintptr_t m_named_event = 0;  // class of the event that was named last
  bool m_shutdown_pending = false;
};

}  // namespace df

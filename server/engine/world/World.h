// One game world: the Objects that interact, and all other state of the engine for one game, such as the
// players, the seed and the tick count.
//
// Game code rarely names it: the managers (WM, GM, DM, IM, LM) forward to the calling thread's current
// world. Hosts and tests hold worlds directly, as many as they like, each on one thread at a time.
//
// A world is a pure function of its seed, its inputs and its tick count: it needs no clock, network or
// terminal.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "Box.h"
#include "Color.h"
#include "Event.h"
#include "Layer.h"
#include "ObjectList.h"
#include "Runner.h"
#include "Vector.h"
#include "detail/WorldScope.h"
#include "detail/WorldState.h"
#include "detail/WorldView.h"

namespace df {

struct ActivityPage;
class Capture;
class EventDispatch;
class InputQueue;
class Interests;
class LazyExtras;
class Mover;
class Object;
class ObjectRegistry;
class Tick;
class Views;
class WorldLog;
class WorldStore;
struct WorldExtras;

class World {
 public:
  World();
  /// Deletes no Objects, unlike shutDown(). Their getters and setters still work without a world.
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  /// Returns the calling thread's current world. All threads without one share a default world that is never
  /// destroyed, so that static Objects and cached references are safe.
  static World& current();

  /// Makes a world the current world of this thread while the Scope exists. Scopes can be nested.
  using Scope = WorldScope;

  // Lifetime.

  /// Deletes Objects made with `new`, removes all others, and resets players, inputs, interests, boundary,
  /// views, tick count and game over. The world can then be started again; it keeps seed, sink and runner. If
  /// called inside a tick, update, draw or event handler, does so at its end, and the game is over until
  /// GM.startUp().
  void shutDown();
  /// Records which managers are started, as bits of Started.h. (The world itself works without them.)
  void setStarted(unsigned manager, bool started) {
    m_state.started = started ? m_state.started | manager : m_state.started & ~manager;
  }
  bool isStarted(unsigned manager) const { return (m_state.started & manager) != 0; }

  // Time. Tick.h has the steps of a tick.

  /// Runs one full tick: step event, input events, update(), draw(), then fills the WorldView if the world is
  /// watched. Does nothing inside another tick, update or draw.
  void tick();
  /// Moves all Objects once, in creation order, runs the layers' step(), then deletes the marked Objects.
  /// Does nothing inside another update.
  void update();
  /// Begins a new picture: runs the draw() of all Objects in view, by altitude, then creation order. Does
  /// nothing inside another draw, or inside a tick, which draws at its end.
  void draw();
  /// True while a picture is being drawn.
  bool isDrawing() const;
  /// Runs the game: by the Runner if one is set, else by program(), else tick by tick until the game is over.
  /// Without a Runner, a second call after GM.startUp() continues a game that was over at the end of the
  /// first run. If the game is over before the first run, that run ends immediately. Does nothing inside a
  /// tick, update or draw.
  void run();
  /// Returns the number of ticks begun since the world began.
  int getStepCount() const { return m_state.step_count; }
  /// True if run(), tick() or update() was ever called.
  bool hasBegun() const { return m_state.begun; }
  /// Ends the game; `false` undoes this. While a player's input is being handled, the host may end the game
  /// for that player alone (InputQueue::setGameOverLeaves).
  void setGameOver(bool game_over = true);
  bool isGameOver() const { return m_state.game_over; }
  /// Sets the Runner. Not owned; null for none.
  void setRunner(Runner* p_runner) { m_state.p_runner = p_runner; }
  /// Returns the Program that runs this world (Runner.h). Null if the world has a Runner, if it is not the
  /// default world, or if no Program is set.
  running::Program* program() const;
  /// Makes `layer` take part in update(), after the layers added before it. The layer exists as long as the
  /// world. If it is added during a layer's step(), it takes part in that update() already.
  void addLayer(std::unique_ptr<Layer> layer) { m_state.layers.push_back(std::move(layer)); }
  /// Returns the first layer of this class; null if not found.
  template <class T>
  T* findLayer() const {
    for (const auto& layer : m_state.layers) {
      if (auto* p_layer = dynamic_cast<T*>(layer.get())) return p_layer;
    }
    return nullptr;
  }
  /// Restarts the random sequence from this seed.
  void setSeed(std::uint64_t seed) {
    m_state.seed = seed;
    m_state.random = Random(seed);
  }
  /// Returns a random number 0 to n-1, each equally likely; 0 if n < 1.
  int randomInt(int n) { return m_state.random.below(n); }

  // The picture.

  /// Draws one character at a world position. A character that no terminal draws in one cell becomes '?'.
  /// Returns 0, or -1 for a position or colour out of range.
  int drawCh(Vector world_pos, char32_t ch, Color color);
  /// Returns the own view of the player whose input is being handled, if they have one, else the world's.
  Box getView() const;

  // Features that only some games use.

  /// Makes the world behave like the published engine where that differs from the book (docs/dragonfly-api.md
  /// lists it). Affects new Objects, so call it before the first is made. Off by default. shutDown() keeps
  /// the setting.
  void setCompat(bool compat = true) { m_state.compat = compat; }
  bool compat() const { return m_state.compat; }
  /// While a game is paused, no step event is sent and nothing moves; only Pause objects get events, except
  /// joins and leaves, which all Objects get.
  void setPaused(bool paused = true) { m_state.paused = paused; }
  bool isPaused() const { return m_state.paused; }
  /// Returns the sprites, sounds, settings and other WorldExtras, which are made at first use.
  WorldExtras& extras();
  /// Like extras(), but returns null if extras() has not been called yet.
  WorldExtras* findExtras() const;
  /// Lines about the game, shown on the help screen of clients.
  void setHelp(std::vector<std::string> lines) { m_state.help = std::move(lines); }
  const std::vector<std::string>& getHelp() const { return m_state.help; }
  /// Makes the world record on this page what the game does (ActivityPage.h). Not owned; null for none.
  void setActivityPage(ActivityPage* p_page);

  // The parts, for hosts and the engine. Each has a header of its own.

  WorldStore& store() { return *m_p_store; }
  const WorldStore& store() const { return *m_p_store; }
  WorldLog& log() const { return *m_log; }
  Interests& interests() { return *m_interests; }
  ObjectRegistry& objects() const { return *m_objects; }
  EventDispatch& events() { return *m_events; }
  /// Boundary, window, views and players.
  Views& views() const { return *m_views; }
  Capture& picture() const { return *m_picture; }
  Mover& mover() { return *m_mover; }
  InputQueue& input() const { return *m_input; }

  // Access for Objects and sounds, which do not include the headers of the parts.

  /// See EventDispatch::deliver().
  void deliver(ObjectKey key, const Event& event);
  /// Starts or stops turning this Object towards its next node in each tick.
  void setWalking(Object& object, bool walks);
  /// See Capture::addFrame().
  void drawFrame(std::uint32_t slot);
  /// Records that a sound or music began, paused or stopped; see WorldView.
  void recordSound(SoundPlayed sound);
  /// True if the sound or music repeats: its last play() was a loop, and it was neither stopped nor paused
  /// since, nor displaced by newer ones (WorldExtras::kMaxPlaying).
  bool isPlaying(const std::string& label, bool music);
  /// True if the file of a sound or a piece of music can be read; logs a line if not.
  bool findFile(const std::string& kind, const std::string& filename);

 private:
  void finishShutDown();
  /// True while an Object's code is running, which has to return before a shutdown.
  bool isBusy() const;

  WorldStore* m_p_store;  // reference-counted: outlives the world if Objects, lists or Refs do
  WorldState m_state;
  std::unique_ptr<WorldLog> m_log;
  std::unique_ptr<LazyExtras> m_extras;
  std::unique_ptr<Interests> m_interests;
  std::unique_ptr<ObjectRegistry> m_objects;
  std::unique_ptr<EventDispatch> m_events;
  std::unique_ptr<Views> m_views;
  std::unique_ptr<Capture> m_picture;
  std::unique_ptr<Mover> m_mover;
  std::unique_ptr<InputQueue> m_input;
  std::unique_ptr<Tick> m_tick;
};

}  // namespace df

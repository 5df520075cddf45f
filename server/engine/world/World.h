// One game world: all Objects that interact, from its seed to its tick count.
//
// Game code rarely names it: the managers (WM, GM, DM, IM, LM) forward to the calling thread's current
// world. Hosts and tests hold worlds directly, as many as they like, each on one thread at a time.
//
// A world is a pure function of its seed, its inputs and its tick count: it reads no clock and needs
// neither network nor terminal.
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
  void setStarted(unsigned manager, bool started) {
    m_state.started = started ? m_state.started | manager : m_state.started & ~manager;
  }
  bool isStarted(unsigned manager) const { return (m_state.started & manager) != 0; }

  // Time. Tick.h has the steps of a tick.

  /// One full tick: step event, input events, update(), draw(), then the WorldView is filled if the
  /// world is watched. Nothing happens inside another tick, update or draw.
  void tick();
  /// Move all Objects once, in creation order, let the layers step, then delete what is marked. Nothing
  /// happens inside another update.
  void update();
  /// Begin a new picture: run the draw() of all Objects in view, by altitude, then creation order. Nothing
  /// happens inside a tick, which does it at its end.
  void draw();
  /// True while a picture is being drawn.
  bool isDrawing() const;
  /// Run the game: through the Runner if one is set, else through program(), else tick() after tick() until
  /// the game is over. Without a Runner it goes on after a run that has ended, if GM.startUp() was called; a
  /// game that is over before the first one is over. Nothing happens inside a tick, update or draw.
  void run();
  /// Ticks begun since the world began.
  int getStepCount() const { return m_state.step_count; }
  /// Was run() or tick() called, ever?
  bool hasBegun() const { return m_state.begun; }
  /// While a player's input is handled, it may end the game for that player alone
  /// (InputQueue::setGameOverLeaves).
  void setGameOver(bool game_over = true);
  bool isGameOver() const { return m_state.game_over; }
  /// Not owned; null for none.
  void setRunner(Runner* p_runner) { m_state.p_runner = p_runner; }
  /// Runs this world if it has no Runner (Runner.h); null if it has one, was made by hand, or no Program is
  /// set.
  running::Program* program() const;
  /// From now on `layer` takes part in update(), after the layers added before it. It lives as long as the
  /// world. Added by a layer's step(), or by a handler that it calls, it takes part in the same update().
  void addLayer(std::unique_ptr<Layer> layer) { m_state.layers.push_back(std::move(layer)); }
  /// The first layer of this class; null if there is none.
  template <class T>
  T* findLayer() const {
    for (const auto& layer : m_state.layers) {
      if (auto* p_layer = dynamic_cast<T*>(layer.get())) return p_layer;
    }
    return nullptr;
  }
  /// Restart the random sequence.
  void setSeed(std::uint64_t seed) {
    m_state.seed = seed;
    m_state.random = Random(seed);
  }
  /// 0 to n-1, each equally likely; 0 if n < 1.
  int randomInt(int n) { return m_state.random.below(n); }

  // The picture.

  /// One character at a world position; one that no terminal draws in one cell becomes '?'. Return 0, or
  /// -1 for a position or colour out of range.
  int drawCh(Vector world_pos, char32_t ch, Color color);
  /// The view of the player whose input is being handled, if they have one of their own, else the world's.
  Box getView() const;

  // What only some games use.

  /// Behave as the published engine where it differs from the book (docs/dragonfly-api.md lists it). For new
  /// Objects, so before the first. Default: the book. It stays through shutDown().
  void setCompat(bool compat = true) { m_state.compat = compat; }
  bool compat() const { return m_state.compat; }
  /// While a game is paused, no step event is sent and nothing moves; only Pause objects get events, except
  /// joins and leaves, which all get.
  void setPaused(bool paused = true) { m_state.paused = paused; }
  bool isPaused() const { return m_state.paused; }
  /// Sprites, sounds, settings and the like, made at first use.
  WorldExtras& extras();
  /// Null before the first extras().
  WorldExtras* findExtras() const;
  /// Lines about the game for the client's help screen.
  void setHelp(std::vector<std::string> lines) { m_state.help = std::move(lines); }
  const std::vector<std::string>& getHelp() const { return m_state.help; }
  /// From now on note on this page what the game does (ActivityPage.h). Not owned; null for none.
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

  // Access for Objects and sounds, which include no part above them.

  /// EventDispatch::deliver().
  void deliver(ObjectKey key, const Event& event);
  /// Starts or stops turning this Object towards its next node in each tick.
  void setWalking(Object& object, bool walks);
  /// Capture::addFrame().
  void drawFrame(std::uint32_t slot);
  /// A sound was played; see WorldView.
  void noteSound(SoundPlayed sound);
  /// True if it was played in a loop and has not been stopped.
  bool isPlaying(const std::string& label, bool music);
  /// Whether the file of a sound or a piece of music can be read. If not, a line in the log says so.
  bool findFile(const std::string& kind, const std::string& filename);

 private:
  void finishShutDown();
  /// True while code of an Object is running, which has to return first.
  bool isBusy() const;

  WorldStore* m_p_store;  // counted: outlives the world if Objects or lists do
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

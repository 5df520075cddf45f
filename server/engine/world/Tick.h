// Runs the steps of a world's tick in their order.
#pragma once

#include <cstdint>
#include <vector>

namespace df {

class Capture;
class EventDispatch;
class InputQueue;
class LazyExtras;
class Mover;
class Object;
class ObjectRegistry;
class World;
struct WorldState;

/// The Objects of a world that walk along paths.
class PathFollowers {
 public:
  PathFollowers() = default;
  PathFollowers(const PathFollowers&) = delete;
  PathFollowers& operator=(const PathFollowers&) = delete;
  /// Stops all walking Objects, because Objects may outlive their world.
  ~PathFollowers();

  /// Adds the Object if `walks`, else removes it.
  void set(Object& object, bool walks);
  /// Starts a tick: turns each Object towards its next node, in the order in which they were added.
  void step();

 private:
  static void turn(Object& object);

  std::vector<Object*> m_objects;
};

class Tick {
 public:
  /// The arguments must outlive this object. `world` is only passed to layers.
  Tick(World& world, ObjectRegistry& objects, EventDispatch& events, Capture& picture, Mover& mover,
       InputQueue& input, LazyExtras& extras, WorldState& state);

  // See World::tick(), update() and draw().

  void run();
  void update();
  void draw();
  /// True while run(), update() or draw() is running.
  bool isRunning() const { return m_in_tick || m_in_update || m_in_draw; }
  /// True while a picture is being drawn.
  bool isDrawing() const { return m_in_draw; }
  /// Returns the Objects that are turned towards their next node after each step event.
  PathFollowers& pathFollowers() { return m_path_followers; }

 private:
  void drawObjects();

  World& m_world;
  ObjectRegistry& m_objects;
  EventDispatch& m_events;
  Capture& m_picture;
  Mover& m_mover;
  InputQueue& m_input;
  LazyExtras& m_extras;
  WorldState& m_state;
  PathFollowers m_path_followers;
  bool m_in_tick = false;
  bool m_in_update = false;
  bool m_in_draw = false;
};

}  // namespace df

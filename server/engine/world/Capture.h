// Runs the draw() of every Object in view and records the characters that they draw.
//
// The list of characters is always recorded, because it is the picture of the tick (render()). The rest of
// the WorldView is filled only while the world is watched (WorldStore::setWatched).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/world/Object.h"
#include "engine/world/WorldView.h"
#include "shared/values/Canvas.h"

namespace df {

class EventDispatch;
class LazyExtras;
class Views;
class WorldStore;
struct WorldState;

class Capture {
 public:
  /// The arguments must outlive this object.
  Capture(WorldStore& store, Views& views, EventDispatch& events, const LazyExtras& extras,
          const WorldState& state);

  /// Clears the picture of the last tick.
  void clearPicture();
  /// Draws the active visible Objects whose box intersects a view, and all active visible view objects, by
  /// altitude, then creation order, as these were when the call began. For Objects of class Object itself,
  /// draws only sprites, shapes and frames. A static look (Object::setStaticLook) is drawn once, then reused.
  void drawAll();
  /// Adds one character, as drawn by the Object whose draw() is running, or by no Object if none is.
  void add(FixedVector position, char32_t ch, Color color);
  /// Adds the present frame of the Object in this slot, as drawn by it.
  void addFrame(std::uint32_t slot);
  /// Completes view() if the world is watched.
  void finishView();

  /// Returns the changes of the last tick. Valid until the next tick begins.
  const WorldView& view() const { return m_view; }
  /// Returns the picture in a view with this corner: a character is in cell(position) - cell(corner),
  /// displaced if the window shakes. View objects keep their cells.
  Canvas render(FixedVector corner) const;
  /// Returns the picture that this player sees, with their texts on top. For an unknown player, it is that of
  /// the world's view.
  Canvas renderPlayer(std::uint32_t player) const;

 private:
  bool mayDraw(std::uint32_t slot);
  void sortByAltitude();
  void drawOne(ObjectKey key);
  void publishLook(std::size_t entry);
  void shake();

  WorldStore& m_store;
  Views& m_views;
  EventDispatch& m_events;
  const LazyExtras& m_extras;
  const WorldState& m_state;
  WorldView m_view;
  ObjectKey m_drawing;  // Object whose draw() is running; generation 0: none
  std::array<std::vector<ObjectKey>, MAX_ALTITUDE + 1> m_by_altitude;  // scratch of drawAll()
  std::vector<std::vector<DrawCommand>> m_looks;  // static looks, by slot; see WorldStore::kLookCached
};

}  // namespace df

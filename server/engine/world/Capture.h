// Runs the draw() of every Object in view and keeps the characters that it draws.
//
// The list of characters is always kept, because it is the picture of the tick (render()). The rest of the
// WorldView is filled only while the world is watched.
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
  /// Draws the active visible Objects whose box intersects a view, by altitude, then creation order, as these
  /// were when the call began. Objects of type Object itself draw only sprites, shapes and frames. A static
  /// look is drawn once and then repeated.
  void drawAll();
  /// Adds one character, as drawn by the Object whose draw() is running.
  void add(FixedVector position, char32_t ch, Color color);
  /// Adds the frame that shows now, as drawn by that Object.
  void addFrame(std::uint32_t slot);
  /// Completes view() if the world is watched.
  void finishView();

  /// Returns the changes of the last tick. Valid until the next tick begins.
  const WorldView& view() const { return m_view; }
  /// Returns the picture in a view with this corner: cell(position) - cell(corner), shaken if the window is.
  /// View objects keep their cells.
  Canvas render(FixedVector corner) const;
  /// Returns the picture that this player sees, with their texts on top. Without a player, the world's view.
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
  ObjectKey m_drawing;  // the Object whose draw() is running; generation 0: none
  std::array<std::vector<ObjectKey>, MAX_ALTITUDE + 1> m_by_altitude;  // scratch of drawAll()
  std::vector<std::vector<DrawCommand>> m_looks;  // static looks, by slot; see WorldStore::kLookCached
};

}  // namespace df

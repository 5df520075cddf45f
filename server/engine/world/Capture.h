// Runs the draw() of everything in view, and keeps what it put on the screen.
//
// The list of characters is kept in any case: it is the picture of the tick (render()). The rest
// of the WorldView is filled only while the world is watched.
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
  /// All live longer than this.
  Capture(WorldStore& store, Views& views, EventDispatch& events, const LazyExtras& extras,
          const WorldState& state);

  /// Forget the last picture.
  void clearPicture();
  /// Draw the active visible Objects whose box intersects a view: by altitude, then creation order, as they
  /// were when this began. Objects of type Object itself draw nothing and are left out; of static looks the
  /// first drawing is repeated.
  void drawAll();
  /// One character, on behalf of the Object whose draw() is running.
  void add(FixedVector position, char32_t ch, Color color);
  /// The frame that shows now, on its behalf.
  void addFrame(std::uint32_t slot);
  /// Complete view(), if the world is watched.
  void finishView();

  /// What the last tick changed. Valid until the next tick begins.
  const WorldView& view() const { return m_view; }
  /// The picture in a view with this corner: cell(position) - cell(corner), shaken if the window is, but view
  /// objects where they are in every view.
  Canvas render(FixedVector corner) const;
  /// What this player sees: the view, their texts on top. Without such a player, the world's own view.
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
  ObjectKey m_drawing;  // its draw() is running; generation 0: none is
  std::array<std::vector<ObjectKey>, MAX_ALTITUDE + 1> m_by_altitude;  // scratch of drawAll()
  std::vector<std::vector<DrawCommand>> m_looks;  // static ones, relative, by slot; see WorldStore::kLookKept
};

}  // namespace df

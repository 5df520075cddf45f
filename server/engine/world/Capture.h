// Runs the draw() of everything in view, and keeps what it put on the screen.
//
// The list of characters is kept in any case: it is the picture of the tick (World::renderView). The rest
// of the WorldView is filled only while the world is watched.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/world/Object.h"
#include "engine/world/WorldView.h"
#include "shared/values/Canvas.h"

namespace df {

class World;

class Capture {
 public:
  explicit Capture(World& world) : m_world(world) {}

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
  /// Complete the WorldView, if the world is watched.
  void finishView();
  /// Draw the look of this slot again, if it was static.
  void forgetLook(std::uint32_t slot) {
    if (slot < m_looks.size()) m_looks[slot].reset();
  }

  const WorldView& view() const { return m_view; }
  /// The picture in a view with this corner: cell(position) - cell(corner), shaken if the window is, but view
  /// objects where they are in every view.
  Canvas render(FixedVector corner) const;

 private:
  bool mayDraw(std::uint32_t slot);
  void sortByAltitude();
  void drawOne(ObjectKey key);
  void publishLook(std::size_t entry);
  void shake();

  World& m_world;
  WorldView m_view;
  ObjectKey m_drawing;  // its draw() is running; generation 0: none is
  std::array<std::vector<ObjectKey>, MAX_ALTITUDE + 1> m_by_altitude;  // scratch of drawAll()
  std::vector<std::optional<std::vector<DrawCommand>>> m_looks;        // static ones, relative, by slot
};

}  // namespace df

// Which frame of a sprite shows now (book, Listing 4.149). A value: each Object has its own.
//
// An Object's animation goes on in the tick, once, after all have been drawn, whether or not it is in a view;
// that of an inactive or invisible Object waits. One that a game holds for itself goes on with each draw().
#pragma once

#include <string>

#include "Box.h"
#include "Sprite.h"

namespace df {

/// How a frame is turned over before it is drawn.
enum class Transform {
  NO_TRANSFORM,
  HORIZONTAL,  ///< left and right change places
  VERTICAL,    ///< top and bottom
  BOTH,
};

class Animation {
 public:
  /// Short for Transform::HORIZONTAL and so on.
  static constexpr Transform HORIZONTAL = Transform::HORIZONTAL;
  static constexpr Transform VERTICAL = Transform::VERTICAL;
  static constexpr Transform BOTH = Transform::BOTH;

  Animation() = default;

  /// From the first frame on. Not owned; null for none.
  void setSprite(Sprite* p_new_sprite);
  Sprite* getSprite() const { return m_p_sprite; }
  /// The sprite's label.
  void setName(std::string new_name) { m_name = std::move(new_name); }
  const std::string& getName() const { return m_name; }

  /// The frame that shows now, 0 … frames-1.
  void setIndex(int new_index) { m_index = new_index; }
  int getIndex() const { return m_index; }

  /// Ticks for which the frame has been shown; -1: the animation is stopped.
  void setSlowdownCount(int new_slowdown_count) { m_slowdown_count = new_slowdown_count; }
  int getSlowdownCount() const { return m_slowdown_count; }

  /// Turn the frames over as they are drawn; characters with a mirror image, as / and <, become it. The box
  /// stays, and characters are not compared in collisions (Object::setPrecise) while it is on.
  void setTransform(Transform new_transform) { m_transform = new_transform; }
  Transform getTransform() const { return m_transform; }

  /// The sprite's box; 1 by 1 around the position without one.
  Box getBox() const;

  /// Draw the frame around a position, then go on by a tick. Return 0, or -1 without a frame.
  int draw(Vector position);
  /// Only draw it.
  int paint(Vector position) const;
  /// One tick has passed. Return whether another frame shows now.
  bool advance();

  /// For log lines.
  std::string toString() const;
  friend bool operator==(const Animation& a, const Animation& b) {
    return a.m_p_sprite == b.m_p_sprite && a.m_index == b.m_index &&
           a.m_slowdown_count == b.m_slowdown_count && a.m_name == b.m_name && a.m_transform == b.m_transform;
  }
  friend bool operator!=(const Animation& a, const Animation& b) { return !(a == b); }

 private:
  Sprite* m_p_sprite = nullptr;
  int m_index = 0;
  int m_slowdown_count = 0;
  std::string m_name;
  Transform m_transform = Transform::NO_TRANSFORM;
};

}  // namespace df

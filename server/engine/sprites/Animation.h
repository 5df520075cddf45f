// Selects the frame of a sprite to show (book, Listing 4.149). Each Object has an Animation of its own.
//
// An Object's animation advances once per tick, after all Objects have been drawn, whether or not it is in a
// view. It does not advance while the Object is inactive or invisible or the game is paused. An Animation
// that is not an Object's, but a game's own variable, advances with each draw().
#pragma once

#include <string>

#include "Box.h"
#include "Sprite.h"

namespace df {

/// Ways to mirror a frame before it is drawn.
enum class Transform {
  NONE,
  HORIZONTAL,  ///< swaps left and right
  VERTICAL,    ///< swaps top and bottom
  BOTH,
  NO_TRANSFORM = NONE,  ///< older name of NONE
};

#if !defined(DF_SCOPED_ENUMS)
inline constexpr Transform NONE = Transform::NONE;              ///< short for Transform::NONE
inline constexpr Transform HORIZONTAL = Transform::HORIZONTAL;  ///< short for Transform::HORIZONTAL
inline constexpr Transform VERTICAL = Transform::VERTICAL;      ///< short for Transform::VERTICAL
inline constexpr Transform BOTH = Transform::BOTH;              ///< short for Transform::BOTH
#endif

class Animation {
 public:
  /// Short for Transform::HORIZONTAL and so on.
  static constexpr Transform HORIZONTAL = Transform::HORIZONTAL;
  static constexpr Transform VERTICAL = Transform::VERTICAL;
  static constexpr Transform BOTH = Transform::BOTH;

  Animation() = default;

  /// The sprite, which is shown from its first frame on. Not owned; null for none.
  void setSprite(Sprite* p_new_sprite);
  Sprite* getSprite() const { return m_p_sprite; }
  /// Label of the sprite.
  void setName(std::string new_name) { m_name = std::move(new_name); }
  const std::string& getName() const { return m_name; }

  /// Index of the frame that is shown, 0 to the number of frames - 1.
  void setIndex(int new_index) { m_index = new_index; }
  int getIndex() const { return m_index; }

  /// Ticks for which the frame has been shown; -1: the animation is stopped.
  void setSlowdownCount(int new_slowdown_count) { m_slowdown_count = new_slowdown_count; }
  int getSlowdownCount() const { return m_slowdown_count; }

  /// Mirrors the frames when they are drawn. Characters with a mirror image, such as / and <, are replaced by
  /// it. The box does not change. A precise test of collisions (Object::setPrecise) does not compare mirrored
  /// frames, but takes the Object's mask or, without a mask, its whole box.
  void setTransform(Transform new_transform) { m_transform = new_transform; }
  Transform getTransform() const { return m_transform; }

  /// Returns the sprite's box; without a sprite, a box of 1 by 1 around the position.
  Box getBox() const;

  /// Draws the frame around a position, then advances by a tick. Returns 0, or -1 without a frame or if a
  /// character could not be drawn.
  int draw(Vector position);
  /// Draws the frame without advancing.
  int paint(Vector position) const;
  /// Advances by one tick. Returns true if that selected another frame.
  bool advance();

  /// Returns a text for log lines.
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

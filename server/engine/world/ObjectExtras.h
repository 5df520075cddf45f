// What an Object has only if its game gave it that: made at first use, behind one pointer.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include "engine/sprites/Animation.h"
#include "engine/world/ObjectAttributes.h"
#include "engine/world/Path.h"
#include "engine/world/Shape.h"

namespace naiad {
struct Look;
}

namespace df {

struct ObjectExtras {
  static constexpr std::size_t kNowhere = SIZE_MAX;

  Animation animation;
  std::shared_ptr<const naiad::Look> p_look;  ///< as last published
  std::size_t animated = kNowhere;            ///< its place in the world's Animations
  std::optional<Shape> shape;
  std::optional<int> id;  ///< that the game chose
  Path path;
  bool hears_while_paused = false;
  bool is_centered = true;
  bool follows_path = false;
  double path_speed = 0;  ///< with which it set out; its last step to a node may be a short one
  bool avoids_collisions = false;
  std::optional<ObjectAttributes> serialized;  ///< as they were when they were last written
  unsigned modified = 0;                       ///< attributes that the game calls modified
};

}  // namespace df

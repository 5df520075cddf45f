// Attributes that an Object has only if its game sets them. They are made at first use, behind one pointer.
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
  std::shared_ptr<const naiad::Look> p_look;  ///< last published look
  std::size_t animated = kNowhere;            ///< index in the world's Animations
  std::optional<Shape> shape;
  std::optional<int> id;  ///< id chosen by the game (setId())
  Path path;
  bool receives_while_paused = false;
  bool is_centered = true;
  bool follows_path = false;
  double path_speed = 0;  ///< speed at the start of the path; the last step to a node may be shorter
  bool avoids_collisions = false;
  std::optional<ObjectAttributes> serialized;  ///< values when they were last written
  unsigned modified = 0;                       ///< attributes that the game marked as modified
};

}  // namespace df

// Makes a jointed figure in one line:
//
//   for (df::Body* p_part : df::makeRagdoll(df::Vector(40, 10)).parts()) p_part->setFriction(0.3);
#pragma once

#include <array>

#include "Body.h"

namespace df {

/// Ten Bodies that may turn, joined by hinges with the angle limits of a human. The world owns them, like
/// every Object made with new; the joints end with them.
struct Ragdoll {
  Body* p_head = nullptr;
  Body* p_trunk = nullptr;
  std::array<Body*, 2> upper_arms = {};  ///< left, right
  std::array<Body*, 2> lower_arms = {};
  std::array<Body*, 2> thighs = {};
  std::array<Body*, 2> shins = {};

  /// Returns all ten parts, the trunk first.
  std::array<Body*, 10> parts() const;
};

/// Makes a figure that stands with its arms stretched out, the middle of the trunk at `where`. `height` > 0
/// is in rows (a cell is `aspect` times as high as wide); `mass` > 0 is that of the whole figure. An invalid
/// height or mass is replaced by its default.
Ragdoll makeRagdoll(Vector where, double height = 8, double mass = 8, Color color = COLOR_DEFAULT);

}  // namespace df

// A jointed figure, made in a line:
//
//   for (df::Body* p_part : df::makeRagdoll(df::Vector(40, 10)).parts()) p_part->setFriction(0.3);
#pragma once

#include <array>

#include "Body.h"

namespace df {

/// Ten Bodies that may turn, joined by hinges with a human's limits. The world owns them, like every Object
/// made with new; the joints go with them.
struct Ragdoll {
  Body* p_head = nullptr;
  Body* p_trunk = nullptr;
  std::array<Body*, 2> upper_arms = {};  ///< left, right
  std::array<Body*, 2> lower_arms = {};
  std::array<Body*, 2> thighs = {};
  std::array<Body*, 2> shins = {};

  /// All ten, the trunk first.
  std::array<Body*, 10> parts() const;
};

/// Standing with its arms stretched out, the middle of the trunk at `where`. `height` in rows (a cell is
/// `aspect` times as high as wide), > 0; `mass` > 0 of the whole. Numbers out of range make a figure of the
/// default size.
Ragdoll makeRagdoll(Vector where, double height = 8, double mass = 8, Color color = COLOR_DEFAULT);

}  // namespace df

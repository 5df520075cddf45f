// The seam through which something beyond the book's moves takes part in a world's update(): physics is one.
//
// A world without layers spends nothing on them. A layer moves Objects that carry the store's flag kBody,
// which the book's moves skip.
#pragma once

namespace df {

class World;

class Layer {
 public:
  virtual ~Layer() = default;
  /// Once in each update(), after all Objects have moved and before the marked ones are deleted. Handlers
  /// that are called from here may do what those of collisions may.
  virtual void step(World& world) = 0;
};

}  // namespace df

// The interface through which parts beyond the book, such as physics, take part in a world's update().
//
// A world without layers spends nothing on them. A layer moves Objects that have the store's flag kBody; the
// book's moves skip these.
#pragma once

namespace df {

class World;

class Layer {
 public:
  virtual ~Layer() = default;
  /// Called once in each update(), after all Objects have moved and before the marked ones are deleted.
  /// Handlers called from here may do what collision handlers may.
  virtual void step(World& world) = 0;
};

}  // namespace df

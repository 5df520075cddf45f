// The interface by which extensions of the engine, such as physics, take part in a world's update().
//
// A world without layers has no cost for them. A layer moves the Objects that have the store's flag kBody;
// the moves of the book's engine skip these.
#pragma once

namespace df {

class World;

class Layer {
 public:
  virtual ~Layer() = default;
  /// Called once in each update(), after all Objects have moved and before the marked ones are deleted.
  /// Handlers that step() calls may do what collision handlers may do.
  virtual void step(World& world) = 0;
};

}  // namespace df

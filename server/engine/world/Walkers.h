// The Objects of a world that walk along paths.
#pragma once

#include <vector>

namespace df {

class Object;

class Walkers {
 public:
  Walkers() = default;
  Walkers(const Walkers&) = delete;
  Walkers& operator=(const Walkers&) = delete;
  /// Objects may outlive their world.
  ~Walkers();

  /// Adds or removes the Object.
  void set(Object& object, bool walks);
  /// A tick begins: turn each towards its next node, by the order in which they set out.
  void step();

 private:
  static void turn(Object& object);

  std::vector<Object*> m_objects;
};

}  // namespace df

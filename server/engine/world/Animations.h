// The Objects of a world with running animations.
#pragma once

#include <vector>

namespace df {

class Object;

class Animations {
 public:
  Animations() = default;
  Animations(const Animations&) = delete;
  Animations& operator=(const Animations&) = delete;
  /// Objects may outlive their world.
  ~Animations();

  /// From now on this Object's animation goes on, if it was not to already.
  void add(Object& object);
  void remove(Object& object);
  /// One tick has passed.
  void advance();

 private:
  std::vector<Object*> m_objects;  // each stores its place (ObjectExtras::animated)
};

}  // namespace df

// The handle of an Object, which lists, layers and hosts hold instead of a pointer.
#pragma once

#include <cstdint>

namespace df {

/// A slot of the world store and the generation that occupies it. Two objects never share both.
struct ObjectKey {
  std::uint32_t slot = 0;
  std::uint32_t generation = 0;  ///< 0: no Object
  friend bool operator==(ObjectKey a, ObjectKey b) {
    return a.slot == b.slot && a.generation == b.generation;
  }
  friend bool operator!=(ObjectKey a, ObjectKey b) { return !(a == b); }
};

}  // namespace df

// The Objects of a world with running animations.
#pragma once

#include <cstdint>
#include <vector>

namespace df {

class WorldStore;
struct ObjectExtras;

class Animations {
 public:
  explicit Animations(WorldStore& store) : m_store(store) {}
  Animations(const Animations&) = delete;
  Animations& operator=(const Animations&) = delete;
  /// Objects may outlive their world.
  ~Animations();

  /// Runs the animation of the Object in this slot. Adding it twice is once.
  void add(std::uint32_t slot, ObjectExtras& extras);
  void remove(ObjectExtras& extras);
  /// One tick has passed.
  void advance();

 private:
  struct Entry {
    std::uint32_t slot;
    ObjectExtras* p_extras;  // it stores its place here (ObjectExtras::animated)
  };

  WorldStore& m_store;
  std::vector<Entry> m_entries;
};

}  // namespace df

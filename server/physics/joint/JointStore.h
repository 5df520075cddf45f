// The joints of a world of bodies, by id, from step to step.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "physics/geometry/Index.h"
#include "physics/joint/Joint.h"

namespace naiad::physics {

/// Whatever ids are used again, joints are listed in the order in which they were added: a group does not
/// depend on what was in the world before.
class JointStore {
 public:
  /// The world has checked that it is valid. Returns its id.
  int add(const Joint& joint, bool may_touch);
  /// False if it is of another kind or on other bodies. A broken one stays broken.
  bool set(int id, const Joint& joint);
  void remove(int id);
  bool exists(int id) const { return id >= 0 && id < limit() && m_entries[at(id)].exists; }
  /// As it was given, with what the last step wrote.
  const Joint& joint(int id) const { return m_entries[at(id)].joint; }
  /// Ids, in the order of addition.
  const std::vector<int>& ids() const { return m_order; }
  /// Does one of them keep the two bodies from touching?
  bool keepsApart(int a, int b);
  /// visit(a, b) for every joint that is not broken; a is −1 for a mouse.
  template <class Visit>
  void visitWorking(Visit visit) const {
    for (const int id : m_order) {
      if (!joint(id).is_broken) visit(firstOf(joint(id)), joint(id).b);
    }
  }
  /// Its first body; −1: a mouse has none.
  static int firstOf(const Joint& joint) { return joint.kind == JointKind::kMouse ? -1 : joint.a; }

 protected:
  using Memory = std::array<double, 3>;

  /// Multipliers of the last sub-step per its length, by row: the next first guess.
  Memory& memoryOf(int id) { return m_entries[at(id)].memory; }
  /// What it exerted in a step. Does that break it?
  bool finish(int id, Vec2 force, double torque);

 private:
  struct Entry {
    Joint joint;
    bool exists = false;
    bool may_touch = false;
    Memory memory = {};
  };

  int limit() const { return static_cast<int>(m_entries.size()); }
  void sortApart();

  std::vector<Entry> m_entries;
  std::vector<int> m_free;
  std::vector<int> m_order;
  std::vector<std::pair<int, int>> m_apart;  // bodies that are kept from touching, sorted
  bool m_is_apart_sorted = true;
};

}  // namespace naiad::physics

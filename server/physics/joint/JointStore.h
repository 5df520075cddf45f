// The joints of a world of bodies, by id, kept from step to step.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "physics/geometry/Index.h"
#include "physics/joint/Joint.h"

namespace naiad::physics {

/// Joints are listed in the order of addition, even if ids are reused, so groups do not depend on the ids.
class JointStore {
 public:
  /// Adds a joint and returns its id. The caller has checked that the joint is valid.
  int add(const Joint& joint, bool may_touch);
  /// Replaces a joint. Returns false if its kind or bodies differ. A broken joint stays broken.
  bool set(int id, const Joint& joint);
  void remove(int id);
  /// Sets the multipliers of the joints of the bodies for which forgets(body) is true to 0.
  template <class Forgets>
  void forget(Forgets forgets) {
    for (const int id : m_order) {
      const int first = firstOf(joint(id));
      if (forgets(joint(id).b) || (first >= 0 && forgets(first))) m_entries[at(id)].memory = {};
    }
  }
  bool exists(int id) const { return id >= 0 && id < limit() && m_entries[at(id)].exists; }
  /// Returns the joint with the results of the last step.
  const Joint& joint(int id) const { return m_entries[at(id)].joint; }
  /// Returns all ids in the order of addition.
  const std::vector<int>& ids() const { return m_order; }
  /// True if a joint between the two bodies disables their contacts.
  bool keepsApart(int a, int b);
  /// Counts the joints that were added, removed or broken.
  std::uint64_t changes() const { return m_changes; }
  /// Calls visit(a, b) for every joint that is not broken; a is −1 for a mouse joint.
  template <class Visit>
  void visitWorking(Visit visit) const {
    for (const int id : m_order) {
      if (!joint(id).is_broken) visit(firstOf(joint(id)), joint(id).b);
    }
  }
  /// Returns the joint's first body; −1 for a mouse joint, which has only one.
  static int firstOf(const Joint& joint) { return joint.kind == JointKind::kMouse ? -1 : joint.a; }

  using Memory = std::array<double, 3>;
  /// Multipliers of the last sub-step divided by its length, by row: the first guess of the next sub-step.
  Memory& memoryOf(int id) { return m_entries[at(id)].memory; }
  const Memory& memoryOf(int id) const { return m_entries[at(id)].memory; }

 protected:
  /// Stores the force and torque of a step. Returns true if they break the joint.
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
  std::vector<std::pair<int, int>> m_apart;  // sorted pairs of bodies that do not collide because of a joint
  bool m_is_apart_sorted = true;
  std::uint64_t m_changes = 0;
};

}  // namespace naiad::physics

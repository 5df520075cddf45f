// Joints as rows of a step of soft sub-steps, solved for one after the other between the contacts
// (ContactRows.h).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "physics/joint/JointRows.h"
#include "physics/substep/SubstepBody.h"

namespace naiad::physics {

class SubstepJoints {
 public:
  int add(const Joint& joint, bool may_touch);
  bool set(int id, const Joint& joint);
  void remove(int id);
  bool exists(int id) const { return id >= 0 && id < limit() && entryOf(id).exists; }
  const Joint& joint(int id) const { return entryOf(id).joint; }
  int limit() const { return static_cast<int>(m_entries.size()); }
  bool isWorking(int id) const { return exists(id) && !joint(id).is_broken; }
  /// Does one of them keep the two bodies from touching?
  bool keepsApart(int a, int b);

  /// Rows for those of which a body moves; `h`: length of a sub-step.
  void begin(std::span<SubstepBody> bodies, float h);
  void warmStart(std::span<SubstepState> states);
  /// Where the bodies are now; `time`: since the step began.
  void place(std::span<const SubstepState> states, float time);
  void solve(std::span<SubstepState> states, bool is_soft);
  /// Writes forces; returns how many broke.
  int end();
  /// visit(a, b) for every joint that is not broken; a is −1 for a mouse.
  template <class Visit>
  void visitWorking(Visit visit) const {
    for (const Entry& entry : m_entries) {
      if (!entry.exists || entry.joint.is_broken) continue;
      visit(entry.joint.kind == JointKind::kMouse ? -1 : entry.joint.a, entry.joint.b);
    }
  }
  /// visit(a, b) for every joint of this step; a is −1 for a mouse.
  template <class Visit>
  void visitLinks(Visit visit) const {
    for (const Link& link : m_links) visit(link.a, link.b);
  }

 private:
  struct Entry {
    Joint joint;
    bool exists = false;
    bool may_touch = false;
    std::uint64_t number = 0;  // in the order of addition
    std::array<float, 3> memory = {};
  };
  struct Row {
    float nx = 0, ny = 0, ja = 0, jb = 0;
    float speed = 0;  // at the velocities of the start of the step
    float mass = 0;
    float value = 0;
    float bias = 0, mass_scale = 1, impulse_scale = 0;  // of the soft solution
    float low = 0, high = 0;
    float impulse = 0;
    float target = 0;
    bool is_spring = false;  // soft in both solutions
    std::int8_t side = 0;
  };
  struct Link {
    int id;
    std::int32_t a, b;              // bodies
    std::int32_t state_a, state_b;  // within the step
    float inverse_mass_a, inverse_mass_b, inverse_inertia_a, inverse_inertia_b;
    int row, count;
    JointFrame frame;  // at the start of the step; the offset from centre to centre
    Vec2 velocity;     // of b's centre against a's, at the start of the step
    bool is_point;     // the first two rows hold a point
    float inverse_xx = 0, inverse_xy = 0, inverse_yy = 0;  // of their matrix
    Vec2 force;
    double torque = 0;
  };

  Entry& entryOf(int id) { return m_entries[static_cast<std::size_t>(id)]; }
  const Entry& entryOf(int id) const { return m_entries[static_cast<std::size_t>(id)]; }
  void stiffen(std::span<SubstepBody> bodies);
  void load(int id, std::span<const SubstepBody> bodies);
  void prepare(Row& row, const Joint& joint) const;
  void solvePoint(const Link& link, SubstepState& a, SubstepState& b, bool is_soft);
  static void solveRow(const Link& link, Row& row, SubstepState& a, SubstepState& b, bool is_soft);
  void sortApart();

  std::vector<Entry> m_entries;
  std::vector<int> m_free;
  std::vector<int> m_order;                                    // ids, by number
  std::vector<std::pair<std::int32_t, std::int32_t>> m_apart;  // bodies that are kept from touching, sorted
  bool m_is_apart_sorted = true;
  std::uint64_t m_next_number = 0;
  std::vector<Link> m_links;
  std::vector<Row> m_rows;
  float m_h = 1;
};

}  // namespace naiad::physics

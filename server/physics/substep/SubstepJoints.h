// Joints as rows of a step of soft sub-steps; they are solved alternately with the contacts (ContactRows.h).
//
// Several joints that form a tree, or one with few loops, are one linear system (SubstepSystem.h). Contacts
// that press a jointed body with a much larger mass are rows of it, too, because a sweep does not know the
// mass behind a contact. Other joints are solved one after the other.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "physics/geometry/UnionFind.h"
#include "physics/joint/JointRows.h"
#include "physics/joint/JointStore.h"
#include "physics/substep/ContactRows.h"
#include "physics/substep/Softness.h"
#include "physics/substep/SubstepBody.h"
#include "physics/substep/SubstepSystem.h"

namespace naiad::physics {

class SubstepJoints : public JointStore {
 public:
  /// Loads the joints with a moving body, at the positions of the step's start; `h` is the length of a
  /// sub-step. Call addLoad() and makeRows() next.
  void begin(std::span<const SubstepBody> bodies, float h);
  /// Adds a contact if its load is heavy for a jointed body. Overlap is undone at most with the speed
  /// `max_push`. Returns its number; −1 if it was not added. Call first for contacts of two movable bodies.
  int addLoad(std::span<const SubstepBody> bodies, int a, int b, const Manifold& manifold, double max_push);
  /// Makes the rows of joints and loads.
  void makeRows(std::span<SubstepBody> bodies);
  /// True if a joint system solves this load.
  bool solvesLoad(int load) const { return load >= 0 && m_loads[at(load)].p_system != nullptr; }
  /// Sets the number of the load's row in the ContactRows, which have its impulses between solutions.
  void setPlace(int load, std::int32_t place) { m_loads[at(load)].place = place; }
  /// Returns the number of joint systems, which are solved directly.
  std::size_t systems() const { return m_systems.size(); }
  bool isEmpty() const { return m_links.empty(); }
  /// Finds the bodies of groups that only gravity and rigid joints act on, unless they are nets. If these get
  /// half of the first kick, and the other half before finishStep(), their velocities at the end of the step
  /// are those at their places. Else the velocity is that of half a sub-step later, which looks like a gain
  /// of energy when a chain swings.
  void findUntouched(std::span<const SubstepBody> bodies);
  /// Returns the states of these bodies.
  std::span<const std::int32_t> untouched() const { return m_untouched; }
  void warmStart(std::span<SubstepState> states);
  /// Call when the contacts have been warm started, too.
  void solveSoftly(std::span<SubstepState> states, ContactRows& rows);
  /// Solves without softness at the present positions; `time` is since the step began.
  void relax(std::span<SubstepState> states, ContactRows& rows, float time, bool only_untouched = false);
  /// Remembers the impulses for the next step, and solves the joints of the untouched bodies once more.
  void finishStep(std::span<SubstepState> states, ContactRows& rows, float time);
  /// Applies restitution to loads; call after ContactRows::bounce().
  void bounce(std::span<SubstepState> states, ContactRows& rows);
  /// Call after a step of length `dt`: writes the joints' forces. Returns the number of joints that broke.
  int end(double dt);
  /// Calls visit(state, work) for joints that may have added energy in this sub-step: the work of motors and
  /// of moving immovable bodies, and the energy released by springs. `state` is that of a movable body.
  template <class Visit>
  void visitWork(Visit visit) const {
    for (const Link& link : m_links) {
      if (link.work != 0)
        visit(link.inverse_mass_b + link.inverse_inertia_b > 0 ? link.state_b : link.state_a, link.work);
    }
  }
  /// Call when velocity changes were multiplied by these factors, by state. Multiplies the impulses kept for
  /// the next sub-step, too, and stops the speeds along the joints again.
  void scale(std::span<const float> factors, std::span<SubstepState> states, ContactRows& rows);
  /// Returns a number that the movable bodies of a group of joints share, for one of these bodies.
  int groupOf(int body) { return m_sets.rootOf(body); }
  /// Calls visit(a, b) for every joint of this step; a is −1 for a mouse joint.
  template <class Visit>
  void visitLinks(Visit visit) const {
    for (const Link& link : m_links) visit(link.a, link.b);
  }

 private:
  struct Row {
    float nx = 0, ny = 0, ja = 0, jb = 0;
    float speed = 0;  // speed along the row by the velocities at the start of the step
    float mass = 0;
    float value = 0;
    float bias = 0, mass_scale = 1, impulse_scale = 0;  // used by the soft solution
    float low = 0, high = 0;
    float impulse = 0;
    float target = 0;
    bool is_spring = false;  // a spring or motor: solved only before the bodies move
    bool is_limit = false;   // the bias is a gap that may close
    bool is_angle = false;
    std::int8_t side = 0;
  };
  struct JointImpulse {
    double size;
    Vec2 n;
    double ja, jb;
  };
  struct Law {  // dependence of a row's impulse on its speed, as in SubstepSystem::Row
    double bias = 0, softness = 0, target = 0;
    double low = -kNoLimit, high = kNoLimit;
    bool is_spring = false, is_limit = false;
  };
  struct Link {
    int id;
    std::int32_t a, b;              // ids of bodies
    std::int32_t state_a, state_b;  // indices of states
    float inverse_mass_a, inverse_mass_b, inverse_inertia_a, inverse_inertia_b;
    int row, count;                    // first row in m_rows, or in its system
    SubstepSystem* p_system;           // null: the joint is solved alone
    JointFrame frame;                  // frame at the start of the step; its offset is from centre to centre
    Vec2 velocity;                     // velocity of b's centre relative to a's, at the start of the step
    bool is_point;                     // the first two rows hold a point together
    bool is_hinge;                     // the joint has only these two rows
    bool is_line;                      // a rope, rod or spring between two points, with one row
    bool is_in_net;                    // solved alone, but other joints act on its bodies
    bool has_work;                     // a motor, a spring, or is_driven
    bool is_untouched;                 // as in findUntouched()
    bool is_driven;                    // one of the bodies is immovable and moves
    Vec2 driver;                       // velocity of that body
    std::array<double, 3> value = {};  // position errors of the rows
    float inverse_xx = 0, inverse_xy = 0, inverse_yy = 0;  // inverse of the matrix of these two rows
    Vec2 force;
    double torque = 0;
    double work = 0;  // energy that it may have added in this sub-step
  };
  struct Load {                     // a contact that a system may solve
    std::int32_t a, b;              // ids of bodies
    std::int32_t state_a, state_b;  // indices of states
    Manifold manifold;
    Vec2 velocity;  // velocity of b's centre relative to a's, at the start of the step
    double max_push;
    SubstepSystem* p_system = nullptr;
    int row = 0;
    std::int32_t place = 0;
  };
  struct Shape {   // what the pattern of a system depends on, for each link, then for each load
    int id, a, b;  // the id of a load is −1
    bool moves_a, moves_b;
    int rows;
    bool operator==(const Shape&) const = default;
  };
  struct Slot {  // place of a link in its system
    SubstepSystem* p_system = nullptr;
    int row = 0;
    bool is_in_net = false;
  };
  struct System {
    SubstepSystem rows;
    std::vector<int> bodies;  // ids
  };

  void stiffen(std::span<SubstepBody> bodies);
  void load(int id, std::span<const SubstepBody> bodies);
  void makeRowsOf(Link& link);
  void weigh(std::span<const SubstepBody> bodies);
  void placeLoad(const Load& load, const SubstepState& a, const SubstepState& b, float time) const;
  void takeLoads(const ContactRows& rows);
  void giveLoads(ContactRows& rows) const;
  void findSystems(std::size_t bodies);
  bool isDirect(std::span<const std::pair<int, int>> links) const;
  void addSystem(std::span<const std::pair<int, int>> links, std::map<int, System>& old);
  void place(Link& link, const SubstepState& a, const SubstepState& b, float time);
  void placeAcross(const Link& link, const JointFrame& frame, Vec2 along) const;
  Law lawOf(const Joint& joint, const SpeedRow& row) const;
  static void setSystemRow(const Link& link, int k, const SpeedRow& from, const Law& law);
  void setRow(Row& row, const Law& law) const;
  void soften(Row& row, const Joint& joint) const;
  void solve(const Link& link, SubstepState& a, SubstepState& b, bool is_soft);
  void solvePoint(const Link& link, SubstepState& a, SubstepState& b, bool is_soft);
  static void solveRow(const Link& link, Row& row, SubstepState& a, SubstepState& b, bool is_soft);
  JointImpulse impulseOf(const Link& link, int k) const;
  void addWork(Link& link, std::span<const SubstepState> states, double sign) const;
  void addStored(Link& link, const std::array<double, 3>& before) const;

  std::vector<Link> m_links;
  std::vector<Row> m_rows;
  std::vector<std::int32_t> m_untouched;  // states
  std::vector<Load> m_loads;
  std::vector<Shape> m_shapes, m_shapes_before;  // by link, then by load
  std::vector<Slot> m_slots;                     // by shape
  std::map<int, System> m_systems;               // by the id of the first joint
  UnionFind m_sets;                              // bodies that joints connect
  std::vector<float> m_behind;                   // by root in m_sets: least inverse mass; −1: no joints
  int m_pairs_loaded = 0;                        // loads between movable bodies
  std::vector<int> m_local_of;                   // scratch, by body: index in its system
  std::vector<std::int32_t> m_states;            // scratch
  std::vector<JointMass> m_masses;               // scratch
  Softness m_softness;
  float m_h = 1;
};

}  // namespace naiad::physics

// The energy of a linkage, and changes of its speeds that correct it.
#include <algorithm>
#include <cmath>

#include "physics/geometry/Index.h"
#include "physics/rigid/RigidLinkage.h"

namespace naiad::physics {

namespace {

constexpr double kFollowed =
    1;  // per tick²: sub-steps follow the oscillation of a spring up to this stiffness / mass

}  // namespace

// Returns the kinetic energy, and how much of it is motion relative to a rigid body with the momentum, and if
// possible the angular momentum, of a free linkage.
RigidLinkage::Motion RigidLinkage::motion() const {
  Motion result;
  double mass = 0;
  for (std::size_t i = 0; m_is_free && i < m_nodes.size(); ++i) {
    if (!(m_mass[i].inverse_mass > 0)) continue;
    const double its = 1 / m_mass[i].inverse_mass;
    mass += its;
    result.centre += its * (m_nodes[i].origin + m_nodes[i].displacement);
    result.velocity += its * m_nodes[i].velocity;
  }
  if (mass > 0) {
    result.centre = result.centre / mass;
    result.velocity = result.velocity / mass;
  }
  double turning = 0, inertia = 0;
  for (std::size_t i = 0; m_may_rotate && i < m_nodes.size(); ++i) {
    const Node& node = m_nodes[i];
    if (m_mass[i].inverse_mass > 0) {
      const Vec2 arm = node.origin + node.displacement - result.centre;
      turning += cross(arm, node.velocity - result.velocity) / m_mass[i].inverse_mass;
      inertia += lengthSquared(arm) / m_mass[i].inverse_mass;
    }
    if (m_mass[i].inverse_inertia > 0) {
      turning += node.spin / m_mass[i].inverse_inertia;
      inertia += 1 / m_mass[i].inverse_inertia;
    }
  }
  if (inertia > 0) result.spin = turning / inertia;
  for (std::size_t i = 0; i < m_nodes.size(); ++i) {
    const Node& node = m_nodes[i];
    if (m_mass[i].inverse_mass > 0) {
      const Vec2 arm = node.origin + node.displacement - result.centre;
      const Vec2 inner = node.velocity - result.velocity - result.spin * perpendicular(arm);
      result.kinetic += 0.5 * lengthSquared(node.velocity) / m_mass[i].inverse_mass;
      result.inner += 0.5 * lengthSquared(inner) / m_mass[i].inverse_mass;
    }
    if (m_mass[i].inverse_inertia > 0) {
      const double inner = node.spin - result.spin;
      result.kinetic += 0.5 * node.spin * node.spin / m_mass[i].inverse_inertia;
      result.inner += 0.5 * inner * inner / m_mass[i].inverse_inertia;
    }
  }
  return result;
}

// Returns the work of the forces since the start of the sub-step, or of the whole step.
double RigidLinkage::work(bool is_whole_step) const {
  double sum = 0;
  for (std::size_t i = 0; i < m_nodes.size(); ++i) {
    if (!(m_mass[i].inverse_mass > 0)) continue;
    const Vec2 path =
        is_whole_step ? m_nodes[i].displacement : m_nodes[i].displacement - m_nodes[i].displacement_before;
    sum += dot(m_nodes[i].acceleration, path) / m_mass[i].inverse_mass;
  }
  return sum;
}

// Multiplies the speeds relative to the motion as a rigid body by a factor between `least` and `most`, so
// that the kinetic energy becomes `kinetic`. Momentum and angular momentum do not change.
void RigidLinkage::setKinetic(double kinetic, double least, double most) {
  const Motion now = motion();
  if (!(now.inner > 0)) return;
  const double square = 1 + (kinetic - now.kinetic) / now.inner;
  const double factor = std::clamp(std::sqrt(std::max(0.0, square)), least, most);
  if (!(factor != 1)) return;
  for (std::size_t i = 0; i < m_nodes.size(); ++i) {
    Node& node = m_nodes[i];
    if (m_mass[i].inverse_mass > 0) {
      const Vec2 arm = node.origin + node.displacement - now.centre;
      const Vec2 rigid = now.velocity + now.spin * perpendicular(arm);
      node.velocity = rigid + factor * (node.velocity - rigid);
    }
    if (m_mass[i].inverse_inertia > 0) node.spin = now.spin + factor * (node.spin - now.spin);
  }
}

double RigidLinkage::springEnergy(std::span<const RigidBody> bodies,
                                  std::span<const RigidState> states) const {
  double sum = 0;
  for (const Spring& spring : m_springs) {
    const Joint& joint = m_p_joints->joint(spring.id);
    if (joint.stiffness == 0) continue;
    const auto anchorOf = [&](int body, Vec2 anchor) {
      const RigidState& state = states[at(body)];
      return state.displacement + state.turn * (bodies[at(body)].rotation * anchor);
    };
    const Place& from = spring.a >= 0 ? bodies[at(spring.a)].place : joint.target;
    Vec2 offset = (bodies[at(spring.b)].place - from) + anchorOf(spring.b, joint.anchor_b);
    if (spring.a >= 0) offset -= anchorOf(spring.a, joint.anchor_a);
    const double stretch = length(offset) - joint.length;
    sum += 0.5 * joint.stiffness * stretch * stretch;
  }
  return sum;
}

void RigidLinkage::limitEnergy(std::span<const RigidBody> bodies, std::span<RigidState> states) {
  takeStates(states);
  double work = 0;
  bool is_driven = m_has_motor;
  for (std::size_t i = 0; i < m_nodes.size(); ++i) {
    const RigidBody& body = bodies[at(m_nodes[i].body)];
    m_nodes[i].origin = body.place - bodies[at(m_nodes[0].body)].place;
    is_driven = is_driven || body.torque != 0 || body.jerk != Vec2{} ||
                (!isMovable(m_mass[i]) && (body.velocity != Vec2{} || body.spin != 0));
    if (m_mass[i].inverse_mass > 0)
      work += dot(body.acceleration, m_nodes[i].displacement) / m_mass[i].inverse_mass;
  }
  if (is_driven) return;
  const auto loses = [&](const Spring& spring) {
    const Joint& joint = m_p_joints->joint(spring.id);
    const double inverse_mass =
        bodies[at(spring.b)].inverse_mass + (spring.a >= 0 ? bodies[at(spring.a)].inverse_mass : 0);
    return joint.damping > 0 || joint.max_force < kNoLimit || joint.stiffness * inverse_mass > kFollowed;
  };
  const bool is_losing = std::any_of(m_springs.begin(), m_springs.end(), loses) ||
                         std::any_of(m_links.begin(), m_links.end(), [&](const Link& link) {
                           return isOneSided(link.kind) && m_p_joints->hasPushed(link.id);
                         });
  const double kinetic = motion().kinetic;
  const double gain = kinetic + springEnergy(bodies, states) - (m_start_energy + work);
  setKinetic(kinetic - gain, 0, is_losing ? 1 : 1 + kEnergyFactor);
  giveVelocities(states);
}

void RigidLinkage::damp(std::span<RigidState> states) {
  if (m_kinetic < 0) return;
  takeStates(states);
  double most = m_kinetic;
  for (std::size_t i = 0; i < m_nodes.size(); ++i) {
    const RigidState& state = states[at(m_nodes[i].body)];
    if (state.inverse_mass > 0) most += std::max(0.0, dot(state.kick, state.velocity) / state.inverse_mass);
  }
  setKinetic(most, 0, 1);
  giveVelocities(states);
}

}  // namespace naiad::physics

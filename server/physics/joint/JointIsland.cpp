#include "physics/joint/JointIsland.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "physics/geometry/Index.h"
#include "physics/joint/JointRod.h"

namespace naiad::physics {

namespace {

// If a step does not converge, it is repeated with twice as many stages, up to 16 times as many.
constexpr int kFiner = 2, kFinest = 16;
constexpr int kPatience = 3;  // number of converged steps after which longer stages are tried again

// Returns the tolerance of position constraints in metric cells: 2e-13, or 4 units in the last place of the
// largest coordinate if that is more.
double toleranceFor(double extent) {
  return std::max(2e-13, 0x1p-50 * extent);
}

}  // namespace

JointIsland::JointIsland(std::span<const int> bodies, std::span<const int> joints,
                         std::span<const JointBody> all_bodies, std::span<const Joint> all_joints)
    : m_motion(bodies, all_bodies),
      m_constraints(m_motion, joints, all_joints),
      m_second(m_constraints.rows.size()),
      m_rest(m_constraints.rows.size()),
      m_is_out_second(m_constraints.rows.size()) {
  const std::vector<JointMass>& mass = m_motion.mass;
  m_matrix.analyse(m_constraints.rows, mass);
  const bool is_rods = !m_constraints.rods.empty();
  if (is_rods && m_matrix.isChain()) m_chain.connect(m_constraints.rods, mass);
  m_is_rod = is_rods && m_constraints.links.size() == 1 && mass[0].inverse_inertia == 0 &&
             mass[1].inverse_inertia == 0;
}

bool JointIsland::load(std::span<const JointBody> bodies, std::span<const Joint> joints, Vec2 gravity) {
  if (!m_motion.load(bodies, gravity)) return false;
  m_tolerance = toleranceFor(m_motion.extent);
  m_last_h = 1;
  m_is_regularised = false;
  m_constraints.load(m_motion, joints);
  return true;
}

void JointIsland::hold(std::span<JointBody> bodies, std::span<const Joint> joints, JointCounters& counters) {
  if (m_is_frozen || !load(bodies, joints, {})) return;
  prepareHold();
  projectVelocities(counters);
  m_motion.storeVelocities(bodies);
}

void JointIsland::prepareHold() {
  using Kind = JointConstraints::Kind;
  if (m_constraints.is_smooth) return;
  for (std::size_t i = 0; i < m_constraints.rows.size(); ++i) {
    const Kind kind = m_constraints.kind[i];
    m_is_out_second[i] = kind == Kind::kSoft || kind == Kind::kMotor || m_constraints.side[i] != 0 ? 1 : 0;
  }
}

JointChain::Status JointIsland::stepChain(JointOptions options, double h, JointCounters& counters) {
  m_chain.load(m_motion.place, m_motion.velocity, m_motion.acceleration, m_constraints.multiplier,
               m_tolerance);
  JointChain::Status status = m_chain.project();
  const std::span<const double> stages = stagesOf(options.method);
  const int repeats = repeatsOf(options);
  for (int i = 0; i < repeats; ++i) {
    for (const double share : stages) {
      if (status != JointChain::Status::kDone) return status;
      ++counters.stages;
      status = m_chain.stage(share * (h / repeats), counters.iterations);
    }
  }
  if (status != JointChain::Status::kDone) return status;
  m_chain.store(m_motion.place, m_motion.velocity, m_constraints.multiplier, m_constraints.force,
                m_constraints.link_of);
  m_is_factored = false;
  return status;
}

bool JointIsland::stepBy(JointOptions options, bool is_last, std::span<const JointBody> bodies,
                         std::span<const Joint> joints, double h, Vec2 gravity, JointCounters& counters) {
  if (!load(bodies, joints, gravity)) return false;
  if (!is_last && !m_chain.isEmpty() && !m_motion.is_turning) {
    const JointChain::Status status = stepChain(options, h, counters);
    if (status != JointChain::Status::kBad) return status == JointChain::Status::kDone;
  }
  prepareHold();
  projectVelocities(counters);
  m_constraints.addForces(m_second);
  const std::span<const double> stages = stagesOf(options.method);
  const int repeats = repeatsOf(options);
  for (int i = 0; i < repeats; ++i) {
    for (const double share : stages) {
      const double length = share * (h / repeats);
      if (!(is_last ? advance(length, 0, counters) : stage(length, counters))) return false;
    }
  }
  return true;
}

void JointIsland::step(std::span<JointBody> bodies, std::span<Joint> joints, double h, Vec2 gravity,
                       JointOptions options, JointCounters& counters) {
  if (m_is_frozen) return;
  const int substeps = std::max(options.substeps, m_constraints.substepsOf(joints, h));
  const double resolved = h * options.substeps / substeps;  // length of a step with the usual sub-steps
  if (options.method == JointMethod::kAutomatic) {
    const JointMethod best = substeps > options.substeps ? JointMethod::kKahanLi6 : JointMethod::kSuzuki4;
    options.method = m_constraints.isCalm(joints, resolved) ? best : JointMethod::kRattle;
  }
  if (m_is_rod) {
    Joint& joint = joints[at(m_constraints.links[0].index)];
    if (stepRod(bodies[at(joint.a)], bodies[at(joint.b)], joint, h, gravity, options, counters)) return;
  }
  options.substeps = substeps;
  if (!m_constraints.mayCompose(m_motion, joints, resolved)) options.method = JointMethod::kRattle;
  // If stages do not converge, the whole step is repeated with shorter ones, because stages of different
  // lengths within a step would change the energy more than long ones. Only the last attempt may halve stages
  // and use regularised ones. The first attempt has as many stages as the last step needed.
  const int first = m_finer;
  bool is_done = false;
  for (int finer = first; !is_done && finer <= kFinest; finer *= kFiner) {
    if (finer > first) ++counters.refined;
    if (finer > 1) options.method = JointMethod::kRattle;
    const JointOptions refined = {options.method, options.substeps * finer};
    is_done = stepBy(refined, false, bodies, joints, h, gravity, counters);
    m_finer = finer;
  }
  if (m_finer > first || !is_done) m_calm_steps = 0;
  if (++m_calm_steps > kPatience && m_finer > 1) {
    m_finer /= kFiner;
    m_calm_steps = 0;
  }
  options.method = JointMethod::kRattle;
  if (!is_done) is_done = stepBy(options, true, bodies, joints, h, gravity, counters);
  if (is_done && m_motion.store(bodies)) {
    m_constraints.store(joints, h, m_last_h);
    return;
  }
  m_motion.halt(bodies);
  m_is_frozen = true;
  ++counters.quarantined;
}

}  // namespace naiad::physics

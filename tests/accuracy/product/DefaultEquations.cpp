// Systems that are not a body's motion, solved by the call that moves a body through a field
// (FlightField.cpp), with a World's settings: tolerances, limits, and the choice between the explicit and the
// implicit method. Like a df::Field, it has no Jacobian.
#include <algorithm>

#include "Default.h"
#include "Equations.h"
#include "physics/numerics/IntegratorAutomatic.h"

namespace lab {
namespace {

namespace physics = naiad::physics;

template <int N>
struct System {
  const OdeFunctions& functions;
  double start;
  void derivative(double t, const physics::StateVector<N>& y, physics::StateVector<N>& rates) const {
    functions.rate(start + t, y.data(), rates.data());
  }
  bool jacobian(double, const physics::StateVector<N>&, physics::StateMatrix<N>&) const { return false; }
};

template <int N>
class DefaultEquations : public Simulation {
 public:
  explicit DefaultEquations(const Scene& scene)
      : m_equations(scene.equations), m_functions(m_equations->functions()) {
    const std::vector<double> start = m_equations->start();
    std::copy(start.begin(), start.end(), m_y.begin());
  }

  void step(double tick, int /*substeps*/) override {
    const physics::IntegratorOptions options;
    physics::integrate<N>(System<N>{m_functions, m_time}, 0, tick, m_y, options, m_counters);
    m_time += tick;
  }

  BodyState body(int index) const override { return m_equations->body(index, m_y.data()); }
  std::span<const double> coordinates() const override { return m_y; }
  std::optional<Work> work() const override { return Work{}; }

 private:
  std::shared_ptr<const Equations> m_equations;
  OdeFunctions m_functions;
  double m_time = 0;
  physics::StateVector<N> m_y{};
  physics::IntegratorCounters m_counters;
};

}  // namespace

SimulationPtr equationsByDefault(const Scene& scene) {
  if (!scene.abstract() || scene.equations == nullptr) return nullptr;
  switch (scene.equations->functions().dimension) {
    case 3:
      return std::make_unique<DefaultEquations<3>>(scene);
    case 8:
      return std::make_unique<DefaultEquations<8>>(scene);
    default:
      return nullptr;
  }
}

}  // namespace lab

// Registers the textbooks' methods, which solve a scene's equations.
#include "Equations.h"
#include "Method.h"

namespace lab {
namespace {

Method textbook(const char* name, const char* label, Rule rule) {
  return {name, label, "1", Method::Kind::TEXTBOOK, [rule](const Scene& scene) -> SimulationPtr {
            return scene.equations == nullptr ? nullptr : scene.equations->integrate(rule);
          }};
}

const RegisteredMethod methods[] = {
    RegisteredMethod(textbook("euler", "explicit Euler", Rule::EULER)),
    RegisteredMethod(textbook("semi_implicit", "semi-implicit Euler", Rule::SEMI_IMPLICIT_EULER)),
    RegisteredMethod(textbook("verlet", "velocity Verlet", Rule::VERLET)),
    RegisteredMethod(textbook("rk4", "Runge–Kutta 4", Rule::RUNGE_KUTTA_4)),
    RegisteredMethod(textbook("yoshida4", "Yoshida 4", Rule::YOSHIDA_4)),
    RegisteredMethod(textbook("backward_euler", "backward Euler", Rule::BACKWARD_EULER)),
    RegisteredMethod(textbook("tr_bdf2", "TR-BDF2", Rule::TR_BDF2)),
};

}  // namespace
}  // namespace lab

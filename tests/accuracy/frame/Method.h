// What is compared: a way to run scenes. A method is a source file that registers itself:
//
//     const RegisteredMethod method({"box2d", "Box2D", "2.4.1", Method::Kind::PEER, [](const Scene& scene) {
//     … }});
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "Simulation.h"

namespace lab {

struct Method {
  enum class Kind {
    PRODUCT,    ///< the product's automatic choice, judged by Metric::target
    FAST,       ///< the product at its fast level, judged by Metric::fast_target
    CANDIDATE,  ///< what the product could do instead
    PEER,       ///< another library
    TEXTBOOK,   ///< an integrator for the scene's equations
  };
  std::string name;   ///< as in `method=…`
  std::string label;  ///< as a reader knows it
  std::string version;
  Kind kind = Kind::CANDIDATE;
  /// Makes the scene; null if the method cannot express it.
  std::function<SimulationPtr(const Scene&)> build;
  /// Positive: it chooses its sub-steps itself, and is judged at these alone; more of them are more, shorter
  /// ticks (ScenePace). 0: it is measured at 1, 2, 4 … 64.
  int own_substeps = 0;

  bool isProduct() const { return kind == Kind::PRODUCT || kind == Kind::FAST; }
  /// Are its errors at so many sub-steps held against targets?
  bool isJudgedAt(int substeps) const {
    return isProduct() && (own_substeps == 0 || own_substeps == substeps);
  }

  /// All that have registered: the product first, then by kind and name.
  static std::vector<const Method*> all();
};

/// Makes a method known to Method::all(), for as long as the program runs.
class RegisteredMethod {
 public:
  explicit RegisteredMethod(Method method);
};

}  // namespace lab

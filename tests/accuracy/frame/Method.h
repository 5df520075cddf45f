// A method of running scenes, for comparison with others. It is a source file that registers itself:
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
    CANDIDATE,  ///< a method that the product could use instead
    PEER,       ///< another library
    TEXTBOOK,   ///< an integrator for the scene's equations
  };
  std::string name;   ///< value of `method=…`
  std::string label;  ///< name in the report
  std::string version;
  Kind kind = Kind::CANDIDATE;
  /// Builds the scene; returns null if the method cannot express it.
  std::function<SimulationPtr(const Scene&)> build;
  /// If positive, the method chooses its sub-steps itself and is judged only at this number; at a larger
  /// number it gets more, shorter ticks (ScenePace). If 0, it is measured at 1, 2, 4 … 64.
  int own_substeps = 0;
  /// If false, only errors are measured.
  bool is_timed = true;

  bool isProduct() const { return kind == Kind::PRODUCT || kind == Kind::FAST; }
  /// True if its errors at this number of sub-steps are compared with targets.
  bool isJudgedAt(int substeps) const {
    return isProduct() && (own_substeps == 0 || own_substeps == substeps);
  }

  /// Returns all registered methods: the product first, then by kind and name.
  static std::vector<const Method*> all();
};

/// Adds a method to Method::all() for the rest of the program.
class RegisteredMethod {
 public:
  explicit RegisteredMethod(Method method);
};

}  // namespace lab

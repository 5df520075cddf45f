// A problem of the laboratory: scenes, their correct results, and how a method's error is computed. A problem
// is a source file that registers itself. It is made only on demand, because its references take time.
//
//     const RegisteredProblem problem("5", "pendulum", make, "Pendulum", "A lamp on a chain must not …");
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "Method.h"
#include "Scene.h"
#include "Trial.h"

namespace lab {

struct Metric {
  std::string name;         ///< value of `metric=…`: lower case, with the unit last unless it is a ratio
  std::string label;        ///< label of an axis
  double target = -1;       ///< limit for the product; negative: none
  double floor = 0;         ///< uncertainty by rounding or the reference; 0: none
  double fast_target = -1;  ///< limit for the product's fast level; negative: none

  double targetOf(const Method& method) const {
    return method.kind == Method::Kind::FAST ? fast_target : target;
  }
};

/// A limit on time, relative to another time of this run.
struct CpuBound {
  std::string name;         ///< value of `metric=…`
  std::string method;       ///< method whose time is the unit
  int substeps = 1;         ///< sub-steps of that method
  double target = -1;       ///< limit for the product, in units; negative: none
  double fast_target = -1;  ///< limit for the product's fast level, in units; negative: none
  // If `method` is empty, the unit is one of these:
  std::string of_case = {};     ///< the measured method's time in the problem's case of this name
  double unit_us = 0;           ///< this number of microseconds
  bool is_of_later = false;     ///< the first tick is compared with the method's median tick
  std::string unit_label = {};  ///< description of the unit

  Metric metric() const;
};

/// Time limit of a tick: 1 ms, and 5 µs for each body, contact and joint, and 1 µs for each impact up to
/// `most_impacts`.
struct TickBound {
  double base_us = 1000;
  double each_us = 5;
  double impact_us = 1;
  double most_impacts = 20000;

  double allowedUs(double bodies, double contacts, double joints, double impacts) const;
};

/// A scene and its metrics.
struct Case {
  std::string name;   ///< suffix of its metrics; empty if the problem has only one case
  std::string label;  ///< name in the report; empty: `name`
  Scene scene;        ///< the timed scene; a judge may run others
  std::vector<Metric> metrics;
  /// Returns the errors in the order of the metrics. NaN or infinity is drawn as a failure.
  std::function<std::vector<double>(const Trial&)> judge;
  std::vector<CpuBound> cpu_bounds;
  bool long_run = false;   ///< skipped by --quick
  int most_substeps = 64;  ///< limit; lower where more would take minutes without new insight
  double x = 0;            ///< position of the case in a map: its stiffness or mass ratio
  /// The product is also measured with more, shorter ticks, without targets, so that its diagram has a curve.
  bool draws_levels = false;
  bool is_crowd = false;  ///< too many bodies for candidates and textbook methods
  TickBound tick_bound;

  explicit Case(std::string its_name = "", std::string its_label = "", Scene its_scene = {})
      : name(std::move(its_name)), label(std::move(its_label)), scene(std::move(its_scene)) {}
  /// Returns the metric of every case: the product's slowest tick relative to its limit.
  static Metric worstTick();
};

struct Problem {
  enum class Kind {
    DIAGRAM,  ///< error against run time
    MAP,      ///< stability: cases × step
  };
  std::string id;                           ///< value of `problem=…`
  std::string name;                         ///< the id as a word
  std::function<std::vector<Case>()> make;  ///< makes the cases; takes time, for their references
  std::string title;
  std::string why;  ///< purpose, as a sentence
  Kind kind = Kind::DIAGRAM;

  /// Returns the registered problems in reading order: 1, 2, 3, 4, 4b and so on.
  static std::vector<Problem> all();
};

class RegisteredProblem {
 public:
  RegisteredProblem(const std::string& id, const std::string& name, std::vector<Case> (*make)(),
                    const std::string& title, const std::string& why,
                    Problem::Kind kind = Problem::Kind::DIAGRAM);
};

}  // namespace lab

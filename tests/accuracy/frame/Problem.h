// A problem of the laboratory: scenes, what is right in them, and how far off a method is. A problem is a
// source file that registers itself; it is made only when it is asked for, since its references take time.
//
//     const RegisteredProblem problem("5", "pendulum", [] { Problem p; …; return p; });
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "Scene.h"
#include "Trial.h"

namespace lab {

struct Metric {
  std::string name;    ///< as in `metric=…`: lower case, the unit last unless it is a ratio
  std::string label;   ///< for an axis
  double target = -1;  ///< what the product must reach; negative: nothing is asked
  double floor = 0;    ///< below it lies what rounding or the reference leaves uncertain; 0: none
  std::string peers;   ///< what peers are known to reach, in words
};

/// A bound on time that is asked for in terms of another method's in the same run.
struct CpuBound {
  std::string name;    ///< as in `metric=…`
  std::string method;  ///< whose time is 1 …
  int substeps = 1;    ///< … at this many sub-steps
  double target = 0;   ///< how many of them the product may take
};

/// One scene and what is measured in it.
struct Case {
  std::string name;  ///< empty if a problem has one case only; a suffix of its metrics
  Scene scene;       ///< what is timed; a judge may run others
  std::vector<Metric> metrics;
  /// The error for each metric, in that order; what is not a number, or infinite, is drawn as a failure.
  std::function<std::vector<double>(const Trial&)> judge;
  std::vector<CpuBound> cpu_bounds;
  bool long_run = false;   ///< left out by --quick
  int most_substeps = 64;  ///< where more would take minutes and tell nothing
  double x = 0;            ///< its place in a map: stiffness, mass ratio
};

struct Problem {
  enum class Kind {
    DIAGRAM,  ///< error against run time
    MAP,      ///< what stays bounded: cases × step
    COST,     ///< nanoseconds per body
  };
  std::string id;    ///< as in `problem=…`
  std::string name;  ///< the same, as a word
  std::string title;
  std::string text;       ///< what happens in it
  std::string reference;  ///< what is right, and how it is known
  Kind kind = Kind::DIAGRAM;
  std::vector<Case> cases;
};

/// The registered problems' ids and names, in reading order: 1, 2, 3, 4, 4b, …
struct ProblemEntry {
  std::string id;
  std::string name;
  std::function<Problem()> make;
};
std::vector<ProblemEntry> allProblems();

class RegisteredProblem {
 public:
  RegisteredProblem(const std::string& id, const std::string& name, std::function<Problem()> make);
};

}  // namespace lab

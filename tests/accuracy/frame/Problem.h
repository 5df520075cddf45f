// A problem of the laboratory: scenes, what is right in them, and how far off a method is. A problem is a
// source file that registers itself; it is made only when it is asked for, since its references take time.
//
//     const RegisteredProblem problem("5", "pendulum", [] { Problem p; …; return p; });
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "Method.h"
#include "Scene.h"
#include "Trial.h"

namespace lab {

struct Metric {
  std::string name;         ///< as in `metric=…`: lower case, the unit last unless it is a ratio
  std::string label;        ///< for an axis
  double target = -1;       ///< what the product must reach; negative: nothing is asked
  double floor = 0;         ///< below it lies what rounding or the reference leaves uncertain; 0: none
  std::string peers;        ///< what peers are known to reach, in words
  double fast_target = -1;  ///< what the product's fast level must reach; negative: nothing is asked

  double targetOf(const Method& method) const {
    return method.kind == Method::Kind::FAST ? fast_target : target;
  }
};

/// A bound on time that is asked for in terms of another time of the same run.
struct CpuBound {
  std::string name;         ///< as in `metric=…`
  std::string method;       ///< whose time is 1 …
  int substeps = 1;         ///< … at this many sub-steps
  double target = -1;       ///< how many of them the product may take; negative: nothing is asked
  double fast_target = -1;  ///< the same for its fast level
  std::string peers = {};   ///< what peers are known to reach, in words
  // Without a method 1 is one of these:
  std::string of_case = {};     ///< the method's own time in the problem's case of this name
  double unit_us = 0;           ///< so many microseconds
  bool is_of_later = false;     ///< of the first tick: the method's median tick
  std::string unit_label = {};  ///< what 1 is, in words

  Metric metric() const;
};

/// What a tick may cost at most: 1 ms, 5 µs for each body, contact and joint, and 1 µs for each impact of the
/// reserve.
struct TickBound {
  double base_us = 1000;
  double each_us = 5;
  double impact_us = 1;
  double most_impacts = 20000;

  double allowedUs(double bodies, double contacts, double joints, double impacts) const;
};

/// One scene and what is measured in it.
struct Case {
  std::string name;   ///< empty if a problem has one case only; a suffix of its metrics
  std::string label;  ///< the same in words; empty: its name
  Scene scene;        ///< what is timed; a judge may run others
  std::vector<Metric> metrics;
  /// The error for each metric, in that order; what is not a number, or infinite, is drawn as a failure.
  std::function<std::vector<double>(const Trial&)> judge;
  std::vector<CpuBound> cpu_bounds;
  bool long_run = false;   ///< left out by --quick
  int most_substeps = 64;  ///< where more would take minutes and tell nothing
  double x = 0;            ///< its place in a map: stiffness, mass ratio
  /// The product is drawn as a curve: also with more, shorter ticks, of which nothing is asked.
  bool draws_levels = false;
  bool is_crowd = false;  ///< too many bodies for candidates and textbooks
  TickBound tick_bound;

  /// The product's dearest tick in parts of what it may cost: a metric of every case.
  static Metric worstTick();
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
  std::string why;        ///< why it is asked: a sentence
  std::string quoted;     ///< figures that were measured elsewhere, and where: Markdown
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

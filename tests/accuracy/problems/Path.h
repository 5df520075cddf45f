// Judges of several problems. Most measure how far a run deviates from a known path, that is, from exact
// values at the ends of ticks.
#pragma once

#include <functional>
#include <vector>

#include "Problem.h"
#include "Real.h"

namespace lab {

/// Reference values at the end of each tick, from tick 0 on.
using Path = std::vector<std::vector<double>>;

/// Computes the path by `place`, a closed formula in time, and rounds it to double.
Path pathOf(int ticks, const std::function<std::vector<Quad>(Quad t)>& place);

using Read = std::function<std::vector<double>(const Simulation&)>;

struct PathErrors {
  double end = 0;
  double sup = 0;  ///< maximum over the run
};

/// Compares the values that `read` returns with the path: Euclidean distances, divided by `scale`.
PathErrors compare(const Trial& trial, const Scene& scene, const Path& reference, double scale,
                   const Read& read);

/// Returns x and y of a body.
std::vector<double> positionOf(const Simulation& simulation, int index = 0);
/// Returns the coordinates of the scene's equations. Throws Inexpressible if the method has none.
std::vector<double> coordinatesOf(const Simulation& simulation);

using Judge = std::function<std::vector<double>(const Trial&)>;

/// Returns end_error and sup_error.
std::vector<Metric> pathMetrics(double target, double floor);
std::vector<double> inOrder(const PathErrors& errors);
/// Returns a judge (Case::judge) for pathMetrics().
Judge alongPath(const Scene& scene, const Path& path, double scale, const Read& read);

/// Returns a judge (Case::judge) whose only error is that of the run's end.
Judge atEnd(const Scene& scene, const std::function<double(const Simulation& end)>& error);

/// Momentum and energy of motion, summed over all bodies.
struct Whole {
  Vec momentum;
  double energy = 0;
  double sum = 0;  ///< sum of the magnitudes of momenta; errors are relative to it
};
Whole motionOf(const Scene& scene, const Simulation& simulation);

/// Returns the cases of a stability map, from 1 on at each power of ten up to `most`. A cell shows the first
/// error of the case, in units of `unit`.
std::vector<Case> mapOf(double most, Case (*make)(double value), const Metric& metric, double unit = 1);

/// Returns "1e2" for 1e2, for names of cases.
std::string power(double value);

}  // namespace lab

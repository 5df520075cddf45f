// How far a run strays from a known path.
#pragma once

#include <functional>
#include <vector>

#include "Problem.h"
#include "Real.h"

namespace lab {

/// What is compared, at the end of ticks 0, 1, 2, …
using Path = std::vector<std::vector<double>>;

/// By a closed form of time, rounded to double.
Path pathOf(int ticks, const std::function<std::vector<Quad>(Quad t)>& place);

using Read = std::function<std::vector<double>(const Simulation&)>;

struct PathErrors {
  double end = 0;
  double sup = 0;  ///< the largest over the run
  double l2 = 0;   ///< root mean square over the run
};

/// Differences in the Euclidean norm, divided by `scale`.
PathErrors compare(const Trial& trial, const Scene& scene, const Path& reference, double scale,
                   const Read& read);

/// x and y of a body.
std::vector<double> positionOf(const Simulation& simulation, int index = 0);
/// The coordinates of the scene's equations. Throws Inexpressible if the method has none.
std::vector<double> coordinatesOf(const Simulation& simulation);

/// end_error, sup_error and l2_error; the target belongs to the first two.
std::vector<Metric> pathMetrics(double target, double floor, const std::string& peers = "");
std::vector<double> inOrder(const PathErrors& errors);
/// A judge for these metrics.
std::function<std::vector<double>(const Trial&)> alongPath(const Scene& scene, const Path& path, double scale,
                                                           const Read& read);

/// 1e2 → "1e2": for names of cases.
std::string power(double value);

}  // namespace lab

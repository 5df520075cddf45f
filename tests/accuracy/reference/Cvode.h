// Reference solutions by SUNDIALS' CVODE.
#pragma once

#include <functional>
#include <vector>

namespace lab {

struct OdeFunctions {
  int dimension = 0;
  std::function<void(double t, const double* y, double* rates)> rate;
  /// ∂f/∂y in column order.
  std::function<void(double t, const double* y, double* columns)> jacobian;
};

struct CvodeOptions {
  bool stiff = false;       ///< true: backward differences with the Jacobian; false: Adams
  double relative = 1e-12;  ///< relative tolerance
  double absolute = 1e-14;  ///< absolute tolerance, in each coordinate's unit
};

/// Returns the states at the ends of ticks 0 … `ticks`. Throws std::runtime_error if CVODE fails.
std::vector<std::vector<double>> solveByCvode(const OdeFunctions& functions, const std::vector<double>& start,
                                              double tick, int ticks, const CvodeOptions& options);

}  // namespace lab

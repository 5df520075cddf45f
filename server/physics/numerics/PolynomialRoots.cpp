#include "physics/numerics/PolynomialRoots.h"

#include <cmath>
#include <utility>

namespace naiad::physics {

namespace {

constexpr int kHighestDegree = 6;

// Finds a root by Newton's method, kept within an interval at whose ends the polynomial has different signs.
double rootBetween(const double* c, int degree, double low, double high) {
  const bool is_low_negative = evaluate(c, degree, low) < 0;
  double slope[kHighestDegree];
  for (int i = 0; i < degree; ++i) slope[i] = (i + 1) * c[i + 1];
  double s = 0.5 * (low + high);
  for (int i = 0; i < 120; ++i) {
    const double value = evaluate(c, degree, s);
    ((value < 0) == is_low_negative ? low : high) = s;
    double next = s - value / evaluate(slope, degree - 1, s);
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (next == s || next <= low || next >= high) break;
    s = next;
  }
  return s;
}

// Writes the points where the polynomial may turn, and both ends, in ascending order. Returns their number.
int turningPoints(const double* c, int degree, double low, double high, double* out) {
  out[0] = low;
  int count = 1;
  if (degree >= 2) {
    double slope[kHighestDegree], pieces[kHighestDegree + 2];
    for (int i = 0; i < degree; ++i) slope[i] = (i + 1) * c[i + 1];
    const int ends = turningPoints(slope, degree - 1, low, high, pieces);
    for (int i = 0; i + 1 < ends; ++i) {
      const double at_begin = evaluate(slope, degree - 1, pieces[i]);
      const double at_end = evaluate(slope, degree - 1, pieces[i + 1]);
      if ((at_begin < 0) == (at_end < 0)) continue;
      out[count++] = rootBetween(slope, degree - 1, pieces[i], pieces[i + 1]);
    }
  }
  out[count++] = high;
  return count;
}

// Writes the roots of r + v·s + ½a·s² in (0, horizon), ascending, without cancellation. Returns their number.
int quadraticRoots(double r, double v, double a, double horizon, double* out) {
  int count = 0;
  const auto add = [&](double s) {
    if (s > 0 && s < horizon) out[count++] = s;
  };
  if (a == 0) {
    if (v != 0) add(-r / v);
    return count;
  }
  const double discriminant = v * v - 2 * a * r;
  if (!(discriminant > 0)) return 0;
  const double q = -(v + std::copysign(std::sqrt(discriminant), v));
  add(q / a);
  if (q != 0) add(2 * r / q);
  if (count == 2 && out[0] > out[1]) std::swap(out[0], out[1]);
  return count;
}

}  // namespace

double evaluate(const double* c, int degree, double s) {
  double value = c[degree];
  for (int i = degree - 1; i >= 0; --i) value = value * s + c[i];
  return value;
}

double firstBelowZero(const double* c, int degree, double low, double high) {
  if (evaluate(c, degree, low) < 0) return low;
  double points[kHighestDegree + 2];
  const int count = turningPoints(c, degree, low, high, points);
  for (int i = 0; i + 1 < count; ++i) {
    if (evaluate(c, degree, points[i + 1]) < 0) return rootBetween(c, degree, points[i], points[i + 1]);
  }
  return -1;
}

double lastFallBelowZero(const double* c, int degree, double low, double high) {
  double points[kHighestDegree + 2];
  for (int i = turningPoints(c, degree, low, high, points) - 2; i >= 0; --i) {
    if (evaluate(c, degree, points[i]) >= 0 && evaluate(c, degree, points[i + 1]) < 0) {
      return rootBetween(c, degree, points[i], points[i + 1]);
    }
  }
  return low;
}

int insideIntervals(double r, double v, double a, double half, double horizon, Interval out[3]) {
  if (!(half > 0)) return 0;
  double cuts[6];
  int ends = 0;
  cuts[ends++] = 0;
  ends += quadraticRoots(r - half, v, a, horizon, cuts + ends);
  ends += quadraticRoots(r + half, v, a, horizon, cuts + ends);
  for (int i = 2; i < ends; ++i) {  // at most four roots
    for (int j = i; j > 1 && cuts[j] < cuts[j - 1]; --j) std::swap(cuts[j], cuts[j - 1]);
  }
  cuts[ends++] = horizon;
  int count = 0;
  for (int i = 0; i + 1 < ends; ++i) {
    const double middle = 0.5 * (cuts[i] + cuts[i + 1]);
    if (!(std::fabs(r + middle * (v + 0.5 * a * middle)) < half)) continue;
    if (count > 0 && out[count - 1].end == cuts[i]) {
      out[count - 1].end = cuts[i + 1];
    } else {
      out[count++] = {cuts[i], cuts[i + 1]};
    }
  }
  return count;
}

}  // namespace naiad::physics

// Roots of polynomials of time, for finding the moment of an impact.
#pragma once

namespace naiad::physics {

/// Returns c[0] + c[1]·s + … + c[degree]·s^degree.
double evaluate(const double* c, int degree, double s);

/// Returns the first s in [low, high] at which the polynomial becomes negative; `low` if it is negative
/// there, −1 if it never is. The polynomial's derivatives divide the interval into monotone pieces, so no
/// crossing larger than rounding is missed. 1 <= degree <= 6.
double firstBelowZero(const double* c, int degree, double low, double high);

/// Returns the last s in [low, high] at which the polynomial falls from >= 0 to negative; `low` if never.
double lastFallBelowZero(const double* c, int degree, double low, double high);

struct Interval {
  double begin;
  double end;
};

/// Writes the open intervals in [0, horizon] in which |r + v·s + ½a·s²| < half. Returns their number.
int insideIntervals(double r, double v, double a, double half, double horizon, Interval out[3]);

}  // namespace naiad::physics

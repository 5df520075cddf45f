// When a polynomial of time crosses zero: what finding the moment of an impact comes down to.
#pragma once

namespace naiad::physics {

/// c[0] + c[1]·s + … + c[degree]·s^degree.
double evaluate(const double* c, int degree, double s);

/// The first s in [low, high] from which on the polynomial is negative (low if it is so there), or −1. The
/// polynomial's derivatives cut the interval into monotone pieces, so no crossing is missed that reaches
/// beyond rounding. 1 <= degree <= 6.
double firstBelowZero(const double* c, int degree, double low, double high);

/// The last s in [low, high] at which the polynomial goes from >= 0 to negative; low if there is none.
double lastFallThroughZero(const double* c, int degree, double low, double high);

/// From when to when.
struct Interval {
  double begin;
  double end;
};

/// The open intervals in [0, horizon], at most 3, in which |r + v·s + ½a·s²| < half. Returns how many.
int insideIntervals(double r, double v, double a, double half, double horizon, Interval out[3]);

}  // namespace naiad::physics

// The factors of J·M⁻¹·Jᵀ. Their solutions are checked by multiplication with the matrix itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "engine/world/Random.h"
#include "physics/numerics/JointMatrix.h"

namespace naiad::physics {
namespace {

struct System {
  std::vector<JointRow> rows;
  std::vector<JointMass> masses;
};

/// Adds two rows between two bodies, like those of a hinge.
void addHinge(System& system, int a, int b, df::Random& random) {
  const auto number = [&] { return 0.01 * static_cast<double>(random.below(200) - 100); };
  system.rows.push_back({{1, 0}, number(), number(), a, b});
  system.rows.push_back({{0, 1}, number(), number(), a, b});
}

System chainOfHinges(int links) {
  df::Random random(3);
  System system;
  system.masses.push_back({});  // body 0 is an immovable wall
  for (int i = 1; i <= links; ++i) {
    system.masses.push_back({1 + 0.5 * (i % 3), 2});
    addHinge(system, i - 1, i, random);
  }
  return system;
}

/// Returns a system in which all bodies hang on the first one.
System star(int arms) {
  df::Random random(4);
  System system;
  system.masses.push_back({1, 1});
  for (int i = 1; i <= arms; ++i) {
    system.masses.push_back({1, 3});
    addHinge(system, 0, i, random);
  }
  return system;
}

System inOrder(const System& system) {
  System sorted{{}, system.masses};
  for (const int row : eliminationOrder(system.rows, system.masses))
    sorted.rows.push_back(system.rows[static_cast<std::size_t>(row)]);
  return sorted;
}

/// Returns J·M⁻¹·Jᵀ·x.
std::vector<double> multiplied(const System& system, const std::vector<double>& x) {
  struct Motion {
    Vec2 velocity;
    double spin = 0;
  };
  std::vector<Motion> moved(system.masses.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    const JointRow& row = system.rows[i];
    const auto push = [&](int body, double sign, double arm) {
      const JointMass& mass = system.masses[static_cast<std::size_t>(body)];
      Motion& its = moved[static_cast<std::size_t>(body)];
      its.velocity += (sign * x[i] * mass.inverse_mass) * row.n;
      its.spin += x[i] * mass.inverse_inertia * arm;
    };
    push(row.a, -1, row.ja);
    push(row.b, 1, row.jb);
  }
  std::vector<double> result;
  for (const JointRow& row : system.rows) {
    const Motion& a = moved[static_cast<std::size_t>(row.a)];
    const Motion& b = moved[static_cast<std::size_t>(row.b)];
    result.push_back(dot(row.n, b.velocity - a.velocity) + row.jb * b.spin + row.ja * a.spin);
  }
  return result;
}

/// Returns the largest difference between the computed solution and a known one.
double errorOf(const System& system, JointMatrix& matrix) {
  matrix.analyse(system.rows, system.masses);
  EXPECT_EQ(matrix.factor(system.rows.data(), system.masses.data()), 0);
  std::vector<double> known;
  for (std::size_t i = 0; i < system.rows.size(); ++i) known.push_back(1 + 0.25 * static_cast<double>(i % 7));
  std::vector<double> found = multiplied(system, known);
  matrix.solve(found.data());
  double worst = 0;
  for (std::size_t i = 0; i < found.size(); ++i) worst = std::max(worst, std::abs(found[i] - known[i]));
  return worst;
}

TEST(JointMatrix, ChainOfRodsIsSolvedAsAChain) {
  for (const int links : {1, 2, 3, 20}) {
    System system;
    system.masses.push_back({});
    for (int i = 1; i <= links; ++i) {
      system.masses.push_back({1 + 0.5 * (i % 3), 0});
      system.rows.push_back({{0.6, i % 2 == 0 ? 0.8 : -0.8}, 0, 0, i - 1, i});
    }
    JointMatrix matrix;
    EXPECT_LT(errorOf(inOrder(system), matrix), 1e-9) << links;
    EXPECT_TRUE(matrix.isChain()) << links;
  }
}

TEST(JointMatrix, ChainOfHingesIsSolvedAsABand) {
  for (const int links : {1, 2, 3, 5, 20}) {
    JointMatrix matrix;
    EXPECT_LT(errorOf(inOrder(chainOfHinges(links)), matrix), 1e-9) << links;
    EXPECT_TRUE(matrix.isBand()) << links;
  }
}

TEST(JointMatrix, SolvesMatricesThatAreNoBand) {
  JointMatrix matrix;
  EXPECT_LT(errorOf(inOrder(star(6)), matrix), 1e-9);
  EXPECT_FALSE(matrix.isBand());
  // Interleaves the rows of the chain's ends and its middle.
  System mixed = chainOfHinges(12);
  std::vector<JointRow> rows;
  for (std::size_t i = 0; i < 8; ++i) {
    for (const std::size_t from : {std::size_t{0}, std::size_t{8}, std::size_t{16}})
      rows.push_back(mixed.rows[from + i]);
  }
  mixed.rows = rows;
  EXPECT_LT(errorOf(mixed, matrix), 1e-9);
  EXPECT_FALSE(matrix.isBand());
}

TEST(JointMatrix, BandRowsCanBeExcluded) {
  const System system = inOrder(chainOfHinges(9));
  JointMatrix matrix;
  matrix.analyse(system.rows, system.masses);
  std::vector<std::uint8_t> is_out(system.rows.size());
  for (std::size_t i = 0; i < is_out.size(); i += 4) is_out[i] = 1;
  const std::vector<double> softness(is_out.size());
  matrix.factor(system.rows.data(), system.masses.data(), is_out.data(), softness.data(), 0);
  std::vector<double> known;
  for (std::size_t i = 0; i < is_out.size(); ++i) known.push_back(is_out[i] != 0 ? 0 : 1);
  std::vector<double> found = multiplied(system, known);
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (is_out[i] != 0) found[i] = 0;
  }
  matrix.solve(found.data());
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], known[i], 1e-9) << i;
}

}  // namespace
}  // namespace naiad::physics

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "physics/numerics/SoftBand.h"
#include "shared/values/SplitMix64.h"

namespace naiad::physics {
namespace {

struct BandSystem {
  int size, band;
  std::vector<double> matrix;  // the lower triangle, row by row

  double& at(int i, int j) { return matrix[static_cast<std::size_t>(i * size + j)]; }
};

// Makes a positive definite matrix: each diagonal entry exceeds the sum of its row. A third of the other
// entries are 0.
BandSystem randomSystem(SplitMix64& random, int size, int band) {
  BandSystem made = {size, band, std::vector<double>(static_cast<std::size_t>(size * size), 0)};
  for (int i = 0; i < size; ++i) {
    made.at(i, i) = 2 * band + 1 + random.unit();
    for (int j = std::max(0, i - band); j < i; ++j)
      made.at(i, j) = random.unit() < 0.33 ? 0 : 2 * random.unit() - 1;
  }
  return made;
}

SoftBand bandOf(BandSystem& system) {
  SoftBand band;
  band.resize(system.size, system.band);
  for (int i = 0; i < system.size; ++i) {
    for (int j = std::max(0, i - system.band); j <= i; ++j) band.entry(i, j) = system.at(i, j);
  }
  return band;
}

// Factors the matrix in place as in textbooks, column by column: L, and 1/D.
void decomposePlainly(BandSystem& system) {
  for (int j = 0; j < system.size; ++j) {
    const double inverse = 1 / system.at(j, j);
    system.at(j, j) = inverse;
    for (int i = j + 1; i < system.size; ++i) {
      const double factor = system.at(i, j) * inverse;
      for (int k = i; k < system.size; ++k) system.at(k, i) -= factor * system.at(k, j);
    }
    for (int i = j + 1; i < system.size; ++i) system.at(i, j) *= inverse;
  }
}

// In the product, pivots are eliminated one at a time or four together, and a band may end at any column.
TEST(SoftBand, MatchesThePlainDecompositionBitForBit) {
  SplitMix64 random(4);
  for (const int size : {1, 2, 3, 4, 5, 7, 8, 20, 41, 90}) {
    for (const int width : {0, 1, 3, 11, 12, 13, 14, 15, 30, 53, 89}) {
      if (width >= size && width > 15) continue;
      BandSystem system = randomSystem(random, size, width);
      SoftBand band = bandOf(system);
      ASSERT_TRUE(band.decompose());
      decomposePlainly(system);
      for (int i = 0; i < size; ++i) {
        for (int j = std::max(0, i - width); j <= i; ++j)
          ASSERT_EQ(band.entry(i, j), system.at(i, j)) << size << ' ' << width << ' ' << i << ' ' << j;
      }
    }
  }
}

TEST(SoftBand, SolvesTheDecomposedSystem) {
  SplitMix64 random(5);
  for (const int width : {1, 5, 12, 40}) {
    constexpr int kSize = 83;
    BandSystem system = randomSystem(random, kSize, width);
    std::vector<double> expected, right(kSize, 0);
    for (int i = 0; i < kSize; ++i) expected.push_back(2 * random.unit() - 1);
    for (int i = 0; i < kSize; ++i) {
      for (int j = 0; j < kSize; ++j)
        right[static_cast<std::size_t>(i)] +=
            (i > j ? system.at(i, j) : system.at(j, i)) * expected[static_cast<std::size_t>(j)];
    }
    SoftBand band = bandOf(system);
    ASSERT_TRUE(band.decompose());
    band.solve(right.data());
    for (std::size_t i = 0; i < kSize; ++i) EXPECT_NEAR(right[i], expected[i], 1e-13) << width << ' ' << i;
  }
}

TEST(SoftBand, RefusesMatricesThatAreNotPositive) {
  SplitMix64 random(6);
  for (const int width : {2, 20}) {
    for (const double bad : {0.0, -100.0, 1e301, std::nan("")}) {
      for (const int where : {0, 3, 17, 29}) {
        BandSystem system = randomSystem(random, 30, width);
        SoftBand band = bandOf(system);
        band.entry(where, where) = bad;
        EXPECT_FALSE(band.decompose()) << width << ' ' << bad << ' ' << where;
      }
    }
  }
}

}  // namespace
}  // namespace naiad::physics

#include "Casts.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <optional>

#include "shared/values/SplitMix64.h"
#include "tests/server/engine/oracle/OracleGeometry.h"

namespace bench {
namespace {

constexpr double kBin = 4;  // cells
constexpr double kSameTime = 1e-9;

df::Fixed fixed(double cells) {
  return std::llrint(cells * static_cast<double>(df::kFixedOne));
}

df::FixedVector randomPlace(double side, naiad::SplitMix64& random) {
  const double x = side * random.unit();
  const double y = side * random.unit();
  return {fixed(x), fixed(y)};
}

constexpr df::FixedBox kUnit{{-df::kFixedOne / 2, -df::kFixedOne / 2}, {df::kFixedOne, df::kFixedOne}};

std::vector<df::FixedBox> scatter(int n, double side) {
  naiad::SplitMix64 random(20240607);
  std::vector<df::FixedBox> boxes(static_cast<std::size_t>(n));
  for (df::FixedBox& box : boxes) box = translate(kUnit, randomPlace(side, random));
  return boxes;
}

bool isFree(const Field& field, const df::FixedBox& box) {
  bool is_free = true;
  field.bins.near(box, [&](std::uint32_t i) {
    if (oracle::boxIntersectsBox(box, field.obstacles[i])) is_free = false;
  });
  return is_free;
}

bool isInside(const Field& field, df::FixedVector place) {
  const df::Fixed side = fixed(field.side);
  return place.x >= 0 && place.x < side && place.y >= 0 && place.y < side;
}

}  // namespace

Field::Field(int n, double density)
    : side(std::ceil(std::sqrt(n / density))), obstacles(scatter(n, side)), bins(obstacles, side, kBin, 1) {}

std::vector<Cast> drawCasts(const Field& field, int count, double length) {
  naiad::SplitMix64 random(17);
  std::vector<Cast> casts(static_cast<std::size_t>(count));
  const bool has_room = field.side > 2 * length;
  for (Cast& cast : casts) {
    do {
      cast.from = randomPlace(field.side, random);
      const double angle = 2 * std::numbers::pi * random.unit();
      cast.to = cast.from + df::FixedVector{fixed(length * std::cos(angle)), fixed(length * std::sin(angle))};
    } while (!isFree(field, translate(kUnit, cast.from)) || (has_room && !isInside(field, cast.to)));
  }
  return casts;
}

Answer solve(const Field& field, const Cast& cast) {
  const oracle::SweepPath path{cast.from, cast.to};
  const df::FixedVector way = cast.to - cast.from;
  df::FixedBox area = translate(kUnit, {std::min(cast.from.x, cast.to.x), std::min(cast.from.y, cast.to.y)});
  area.size = {df::kFixedOne + std::abs(way.x), df::kFixedOne + std::abs(way.y)};
  Answer answer{kNobody, 1, cast.to};
  oracle::Time first{2, 1};
  field.bins.near(area, [&](std::uint32_t i) {
    const std::optional<oracle::Time> time = oracle::firstTouch(path, kUnit, field.obstacles[i]);
    if (!time || first < *time || (!(*time < first) && answer.who < i)) return;
    first = *time;
    answer = {i, time->toDouble(), path.before(*time)};
  });
  return answer;
}

bool areEqual(const Answer& a, const Answer& b) {
  return a.who == b.who && std::abs(a.time - b.time) <= kSameTime && a.position == b.position;
}

}  // namespace bench

#include "Casts.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <optional>

#include "shared/values/SplitMix64.h"

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

df::FixedBox boxAt(df::FixedVector middle) {
  return {{middle.x - df::kFixedOne / 2, middle.y - df::kFixedOne / 2}, {df::kFixedOne, df::kFixedOne}};
}

std::vector<df::FixedBox> scatter(int n, double side) {
  naiad::SplitMix64 random(20240607);
  std::vector<df::FixedBox> boxes(static_cast<std::size_t>(n));
  for (df::FixedBox& box : boxes) box = boxAt(randomPlace(side, random));
  return boxes;
}

bool isFree(const Field& field, const df::FixedBox& box) {
  bool is_free = true;
  field.bins.near(box, [&](std::uint32_t i) {
    if (areTouching(box, field.obstacles[i])) is_free = false;
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
    } while (!isFree(field, boxAt(cast.from)) || (has_room && !isInside(field, cast.to)));
  }
  return casts;
}

Answer solve(const Field& field, const Cast& cast) {
  const Path path(boxAt(cast.from), cast.to - cast.from);
  const df::FixedVector corner = path.start().corner;
  const df::FixedVector least = {std::min(corner.x, corner.x + path.way().x),
                                 std::min(corner.y, corner.y + path.way().y)};
  const df::FixedBox area = {
      least, {df::kFixedOne + std::abs(path.way().x), df::kFixedOne + std::abs(path.way().y)}};
  Answer answer{kNobody, 1, cast.to};
  Fraction first{2, 1};
  field.bins.near(area, [&](std::uint32_t i) {
    const std::optional<Fraction> time = path.firstTouch(field.obstacles[i]);
    if (!time || first < *time || (!(*time < first) && answer.who < i)) return;
    first = *time;
    answer = {i, time->value(), cast.from + path.goneBefore(*time)};
  });
  return answer;
}

bool areEqual(const Answer& a, const Answer& b) {
  return a.who == b.who && std::abs(a.time - b.time) <= kSameTime && a.position == b.position;
}

}  // namespace bench

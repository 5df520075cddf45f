#include "Status.h"

#include <algorithm>
#include <cstdio>

namespace bench::path {
namespace {

constexpr int kDigitsColumn = 5;  // after "tick="
constexpr int kDigits = 7;

int cellOf(int coordinate) {
  return (coordinate + kUnits / 2) / kUnits;
}

}  // namespace

MarkerCell markerAfter(std::uint32_t arrows) {
  const std::uint32_t corner = arrows % 4;
  return {kMarkerColumn + (corner == 1 || corner == 2 ? 1 : 0), kMarkerRow + (corner >= 2 ? 1 : 0)};
}

std::optional<std::uint32_t> markerIn(const Picture& picture) {
  std::optional<std::uint32_t> found;
  for (std::uint32_t corner = 0; corner < 4; ++corner) {
    const MarkerCell cell = markerAfter(corner);
    if (picture.at(cell.x, cell.y).ch != '@') continue;
    if (found) return std::nullopt;
    found = corner;
  }
  return found;
}

std::string counterText(std::uint32_t tick) {
  char text[32];
  std::snprintf(text, sizeof text, "tick=%07u:", tick % 10'000'000);
  return text;
}

std::optional<std::uint32_t> counterIn(const Picture& picture) {
  std::uint32_t tick = 0;
  for (int x = kDigitsColumn; x < kDigitsColumn + kDigits; ++x) {
    const char ch = picture.at(x, kStatusRow).ch;
    if (ch < '0' || ch > '9') return std::nullopt;
    tick = tick * 10 + static_cast<std::uint32_t>(ch - '0');
  }
  if (counterText(tick)[0] != picture.at(0, kStatusRow).ch) return std::nullopt;
  return tick;
}

Picture drawScene(const Crowd& crowd) {
  Picture picture;
  for (const Walker& walker : crowd.walkers()) {
    picture.at(cellOf(walker.x), cellOf(walker.y)) = {walker.ch, walker.color};
  }
  int x = 0;
  for (const char ch : counterText(crowd.ticks())) picture.at(x++, kStatusRow) = {ch, kStatusColor};
  return picture;
}

bool isJudged(int x, int y) {
  if (y == kStatusRow && x <= kEchoColumn) return false;
  return y < kMarkerRow || x < kMarkerColumn || x > kMarkerColumn + 1;
}

double likeness(const Picture& screen, const Picture& truth, std::span<const Picture* const> around) {
  int set = 0;
  int equal = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      if (!isJudged(x, y) || (screen.at(x, y).ch == ' ' && truth.at(x, y).ch == ' ')) continue;
      ++set;
      const bool right = std::any_of(around.begin(), around.end(),
                                     [&](const Picture* p) { return p->at(x, y) == screen.at(x, y); });
      if (right) ++equal;
    }
  }
  return set == 0 ? 100 : 100.0 * equal / set;
}

double likeness(const Picture& a, const Picture& b) {
  const Picture* const only = &b;
  return likeness(a, b, {&only, 1});
}

}  // namespace bench::path

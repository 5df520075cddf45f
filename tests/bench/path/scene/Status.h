// The status in the last two rows over the crowd: the tick counter, the echo of the last letter pressed, and
// a marker that moves with the arrow keys.
//
//     column    0          11 13      20 21
//     row 22                           @         the marker is on one of four cells, and goes
//     row 23    tick=0001234:a                   right, down, left, up
//
// The counter is at the end of the screen because terminal programs paint from top to bottom: when it has
// changed, the rest has, too.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <span>
#include <string>

#include "Crowd.h"
#include "Picture.h"

namespace bench::path {

inline constexpr int kStatusRow = kHeight - 1;
inline constexpr int kEchoColumn = 13;
inline constexpr int kMarkerColumn = 20;
inline constexpr int kMarkerRow = kHeight - 2;
inline constexpr std::uint8_t kStatusColor = 7;
inline constexpr char kNoKey = '-';  ///< shown before the first key

/// The cell of the marker. markerAfter() returns it for a number of arrow keys: right, down, left, up, and so
/// on.
struct MarkerCell {
  int x = kMarkerColumn;
  int y = kMarkerRow;
};
inline MarkerCell markerAfter(std::uint32_t arrows) {
  const std::uint32_t corner = arrows % 4;
  return {kMarkerColumn + (corner == 1 || corner == 2 ? 1 : 0), kMarkerRow + (corner >= 2 ? 1 : 0)};
}
/// Returns how many arrow keys, modulo 4, have moved the marker in this picture. Nullopt unless there is
/// exactly one marker; there may be two while it is being painted.
inline std::optional<std::uint32_t> markerIn(const Picture& picture) {
  std::optional<std::uint32_t> found;
  for (std::uint32_t corner = 0; corner < 4; ++corner) {
    const MarkerCell cell = markerAfter(corner);
    if (picture.at(cell.x, cell.y).ch != '@') continue;
    if (found) return std::nullopt;
    found = corner;
  }
  return found;
}

/// Returns the text, for example "tick=0001234:".
inline std::string counterText(std::uint32_t tick) {
  char text[32];
  std::snprintf(text, sizeof text, "tick=%07u:", tick % 10'000'000);
  return text;
}
/// Returns the counter in this picture; nullopt if missing.
inline std::optional<std::uint32_t> counterIn(const Picture& picture) {
  std::uint32_t tick = 0;
  for (int x = 5; x < 12; ++x) {  // seven digits after "tick="
    const char ch = picture.at(x, kStatusRow).ch;
    if (ch < '0' || ch > '9') return std::nullopt;
    tick = tick * 10 + static_cast<std::uint32_t>(ch - '0');
  }
  if (counterText(tick)[0] != picture.at(0, kStatusRow).ch) return std::nullopt;
  return tick;
}

inline int cellOf(int coordinate) {
  return (coordinate + kUnits / 2) / kUnits;
}
/// Returns the true picture: crowd and counter.
inline Picture drawScene(const Crowd& crowd) {
  Picture picture;
  for (const Walker& walker : crowd.walkers()) {
    picture.at(cellOf(walker.x), cellOf(walker.y)) = {walker.ch, walker.color};
  }
  int x = 0;
  for (const char ch : counterText(crowd.ticks())) picture.at(x++, kStatusRow) = {ch, kStatusColor};
  return picture;
}

/// True if all programs must show this cell equally at a tick, that is, if it is not part of counter, echo or
/// marker.
inline bool isJudged(int x, int y) {
  if (y == kStatusRow && x <= kEchoColumn) return false;
  return y < kMarkerRow || x < kMarkerColumn || x > kMarkerColumn + 1;
}
/// Returns the percentage of cells that equal any picture in `around`, among the judged cells that are not
/// blank in at least one of the two pictures; 100 if all are blank.
inline double likeness(const Picture& screen, const Picture& truth, std::span<const Picture* const> around) {
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
/// Like likeness() above, where only the truth counts as equal.
inline double likeness(const Picture& a, const Picture& b) {
  const Picture* const only = &b;
  return likeness(a, b, {&only, 1});
}

}  // namespace bench::path

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

#include <cstdint>
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
MarkerCell markerAfter(std::uint32_t arrows);
/// Returns how many arrow keys, modulo 4, have moved the marker in this picture. Nullopt unless there is
/// exactly one marker; there may be two while it is being painted.
std::optional<std::uint32_t> markerIn(const Picture& picture);

/// Returns the text, for example "tick=0001234:".
std::string counterText(std::uint32_t tick);
/// Returns the counter in this picture; nullopt if missing.
std::optional<std::uint32_t> counterIn(const Picture& picture);

/// Returns the true picture: crowd and counter.
Picture drawScene(const Crowd& crowd);

/// True if all programs must show this cell equally at a tick, that is, if it is not part of counter, echo or
/// marker.
bool isJudged(int x, int y);
/// Returns the percentage of equal cells, among the judged cells that are not blank in at least one of the
/// two pictures; 100 if all are blank.
double likeness(const Picture& a, const Picture& b);
/// Like likeness(a, b), but a cell also counts as equal if it equals any picture in `around`.
double likeness(const Picture& screen, const Picture& truth, std::span<const Picture* const> around);

}  // namespace bench::path

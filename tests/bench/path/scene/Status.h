// What lies over the crowd, in the last two rows: the tick counter, the echo of the last letter that was
// pressed, and a marker that walks with the arrow keys.
//
//     column    0          11 13      20 21
//     row 22                           @         the marker is on one of four cells, and goes
//     row 23    tick=0001234:a                   right, down, left, up
//
// The counter lies at the end of the screen because terminal programs paint from top to bottom: when it has
// changed, so has the rest.
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

/// The cell of the marker after so many of the keys right, down, left, up, right, …
struct MarkerCell {
  int x = kMarkerColumn;
  int y = kMarkerRow;
};
MarkerCell markerAfter(std::uint32_t arrows);
/// 0 to 3: how many arrows, modulo 4, have been obeyed in this picture. Nothing if there is no marker, or
/// more than one, as there is while it is being painted.
std::optional<std::uint32_t> markerIn(const Picture& picture);

/// "tick=0001234:"
std::string counterText(std::uint32_t tick);
/// The counter in this picture; nothing if there is none.
std::optional<std::uint32_t> counterIn(const Picture& picture);

/// The truth: crowd and counter.
Picture drawScene(const Crowd& crowd);

/// The part of the screen that says the same in every program at a tick: all but counter, echo and marker.
bool isJudged(int x, int y);
/// Of the judged cells that are not blank in either picture, how many percent are equal. 100 if all are
/// blank.
double likeness(const Picture& a, const Picture& b);
/// The same of a screen and its truth, where a cell also counts as equal if it is so in any picture `around`.
double likeness(const Picture& screen, const Picture& truth, std::span<const Picture* const> around);

}  // namespace bench::path

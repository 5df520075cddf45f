// Reads sprite files in the three formats that are in use (docs/dragonfly-api.md shows one of each):
//
// - header: <HEADER> frames, width, height, optionally color, slowdown, transparency, in any order </HEADER>
//   <BODY> the rows of each frame, then a line "end" </BODY> optionally <FOOTER> version </FOOTER>;
// - old: lines frames, width, height, optionally color and slowdown; the rows of each frame, then "end"; at
//   last, optionally, "eof";
// - simple: five lines with the numbers of frames, width, height and slowdown and the colour; then all rows.
//
// Lines end in LF or CR LF; the last needs no end. A row has exactly `width` characters, with final blanks.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/sprites/Sprite.h"
#include "shared/values/Color.h"

namespace df {

/// Maximum number of frames of a sprite, and of characters in its width or height.
inline constexpr int kMaxSpriteFrames = 10'000;
inline constexpr int kMaxSpriteSide = 1024;

/// Parses the sprite in `text` and gives it this label. On failure, returns null and sets `error` to the
/// number of the line and the reason, as in "12: the row has 5 characters instead of 6". With `p_warnings`
/// the published engine's rules hold: `slowdown -1`, a line `slowdown` without a value, `transparency " "`
/// (only its first character is used), text after a number (`3.5` is 3), a line `color` without a value,
/// unknown fields, and text after `</FOOTER>` or `eof` (both ignored) are accepted, and listed there like
/// errors. A missing slowdown is 0, and the animation never stands still (Sprite::setNeverStill).
std::unique_ptr<Sprite> parseSprite(const std::string& text, const std::string& label, std::string& error,
                                    std::vector<std::string>* p_warnings = nullptr);

/// Returns the colour with this name, in small or capital letters; UNDEFINED_COLOR if there is none.
Color colorOfName(const std::string& name);

}  // namespace df

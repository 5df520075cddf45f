// Converts between the eight colours of terminals and mixes of red, green and blue.
#pragma once

#include "Color.h"

namespace df {

/// Splits a colour into red, green and blue, 0 to 255 each.
void colorToRGB(Color color, unsigned char& r, unsigned char& g, unsigned char& b);
/// Returns the nearest of the eight colours. Only (0,0,0) becomes BLACK, so that dark Objects stay visible on
/// a black background.
Color nearestColor(unsigned char r, unsigned char g, unsigned char b);

}  // namespace df

// Mixes of red, green and blue, and the eight colours that terminals have.
#pragma once

#include "Color.h"

namespace df {

/// Red, green and blue of a colour, 0 to 255 each.
void colorToRGB(Color color, unsigned char& r, unsigned char& g, unsigned char& b);
/// The one of the eight colours that is nearest to this mix. Black only for black itself: on a black ground
/// a dark thing is to be seen.
Color nearestColor(unsigned char r, unsigned char g, unsigned char b);

}  // namespace df

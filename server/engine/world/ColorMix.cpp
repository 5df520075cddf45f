#include "engine/world/ColorMix.h"

#include <algorithm>

namespace df {

namespace {

struct Mix {
  unsigned char r;
  unsigned char g;
  unsigned char b;
};

constexpr Mix kMixes[] = {{0, 0, 0},   {255, 0, 0},   {0, 255, 0},   {255, 255, 0},
                          {0, 0, 255}, {255, 0, 255}, {0, 255, 255}, {255, 255, 255}};

}  // namespace

void colorToRGB(Color color, unsigned char& r, unsigned char& g, unsigned char& b) {
  const Mix& mix = kMixes[color >= BLACK && color <= WHITE ? color : COLOR_DEFAULT];
  r = mix.r;
  g = mix.g;
  b = mix.b;
}

// Compares hues, so that a dim yellow is yellow: a part counts if it is above half of the strongest part.
Color nearestColor(unsigned char r, unsigned char g, unsigned char b) {
  const int strongest = std::max({r, g, b});
  if (strongest == 0) return BLACK;
  const auto on = [strongest](unsigned char part) { return 2 * part > strongest ? 1 : 0; };
  return static_cast<Color>(RED * on(r) + GREEN * on(g) + BLUE * on(b));
}

}  // namespace df

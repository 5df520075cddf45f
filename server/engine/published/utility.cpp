#include "engine/published/utility.h"

namespace df {

sf::Color colorToSFML(Color color) {
  unsigned char r = 0;
  unsigned char g = 0;
  unsigned char b = 0;
  colorToRGB(color, r, g, b);
  return {r, g, b};
}

}  // namespace df

// Small functions that games expect in one header (book, Listings 4.107, 4.124, 4.135 and 4.144), and the
// standard headers that they expect with it. Geometry, colours, keys and particles have headers of their own
// behind it.
#pragma once

#include <iosfwd>
#include <string>

#include "Box.h"
#include "Circle.h"
#include "Color.h"
#include "EventKeyboard.h"
#include "EventMouse.h"
#include "Line.h"
#include "Object.h"
#include "Particle.h"
#include "Path.h"
#include "Precipitation.h"
#include "Sfml.h"
#include "StandardHeaders.h"
#include "ViewObject.h"
#include "detail/ColorMix.h"
#include "detail/Geometry.h"
#include "detail/KeyCharacter.h"
#include "detail/Particles.h"

namespace df {

/// As text, for log lines.
std::string toString(int i);
std::string toString(float f);
std::string toString(char c);
std::string toString(bool b);
std::string toString(Color color);
std::string toString(const Shape& shape);
std::string toString(const Path& path);
/// The key's name: "space", "a", "f1", …
std::string toString(Keyboard::Key key_val);
std::string toString(Solidness solid);
std::string toString(ViewObjectLocation location);
/// Ones and zeros, the highest bit first.
std::string maskToString(unsigned int mask);
/// The value of the key `find` in "key:value,key:value,…", blanks left out; empty if there is none. An empty
/// `str` is the one of the last call.
std::string match(const std::string& str, const std::string& find);
/// The game's time as "hh:mm:ss", in a place that the next call uses again.
char* getTimeString();
/// Log it if a stream has failed. Return 0, or -1 if it has.
int stringStreamCheck(const char* prefix, std::stringstream* p_ss);

/// The colour as a value of the graphics library (Sfml.h).
sf::Color colorToSFML(Color color);

}  // namespace df

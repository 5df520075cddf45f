// Small functions that games expect in one header (book, Listings 4.107, 4.124, 4.135 and 4.144), and the
// standard headers that they expect with it. Geometry, colours, keys and particles have headers of their own,
// which this one includes.
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

/// Returns a value as text, for log lines.
std::string toString(int i);
std::string toString(float f);
std::string toString(char c);
std::string toString(bool b);
std::string toString(Color color);
std::string toString(const Shape& shape);
std::string toString(const Path& path);
/// Returns the key's name, such as "space", "a" or "f1".
std::string toString(Keyboard::Key key_val);
std::string toString(Solidness solid);
std::string toString(ViewObjectLocation location);
/// Returns ones and zeros, the highest bit first.
std::string maskToString(unsigned int mask);
/// Returns the value of the key `find` in "key:value,key:value,…", without blanks; empty if there is none. An
/// empty `str` means that of the last call.
std::string match(const std::string& str, const std::string& find);
/// Returns the game's time as "hh:mm:ss", in a buffer that the next call reuses.
char* getTimeString();
/// Logs a line if the stream has failed or is null. Returns 0, or -1 if so.
int stringStreamCheck(const char* prefix, std::stringstream* p_ss);

/// Returns the colour as a value of the graphics library (Sfml.h).
sf::Color colorToSFML(Color color);

}  // namespace df

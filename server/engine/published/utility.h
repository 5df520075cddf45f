// Small functions that games expect in one header (book, Listings 4.107, 4.124, 4.135 and 4.144), with the
// standard headers that games expect it to include. Functions for geometry, colours, keys and particles are
// in headers of their own, which this one includes.
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
/// Returns the key's name, such as "space", "a" or "f1"; "undefined" for an unknown key.
std::string toString(Keyboard::Key key_val);
std::string toString(Solidness solid);
std::string toString(ViewObjectLocation location);
/// Returns the bits as a text of ones and zeros, the highest bit first.
std::string maskToString(unsigned int mask);
/// Returns the value of the key `find` in the text `str` "key:value,key:value,…", without blanks; empty if
/// the key is missing. An empty `str` means the text of the last call.
std::string match(const std::string& str, const std::string& find);
/// Returns the game's time as "hh:mm:ss", in a buffer that the next call reuses.
char* getTimeString();
/// If the stream has failed or is null, logs a line and returns -1. Otherwise returns 0.
int stringStreamCheck(const char* prefix, std::stringstream* p_ss);

/// Returns the colour as a value of the graphics library (Sfml.h).
sf::Color colorToSFML(Color color);

}  // namespace df

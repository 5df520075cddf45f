// Small functions about positions and boxes (book, Listings 4.107, 4.124, 4.135 and 4.144), and the standard
// headers that games expect the engine to bring.
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
#include "Vector.h"
#include "ViewObject.h"

namespace df {

/// Do two single characters collide: |dx| <= 1 and |dy| <= 1?
bool positionsIntersect(Vector p1, Vector p2);

/// Do two boxes share a point? Touching edges do.
bool boxIntersectsBox(Box a, Box b);
/// Is a position in a box, edges included?
bool boxContainsPosition(Box b, Vector p);

/// An Object's box in world coordinates, where it is. The empty box for null.
Box getWorldBox(const Object* p_o);
/// An Object's box in world coordinates, if it were at `where`.
Box getWorldBox(const Object* p_o, Vector where);

/// From world coordinates to those of the current view (WM.getView), and back.
Vector worldToView(Vector world_pos);
Vector viewToWorld(Vector view_pos);

/// Straight distance between two positions, in cells.
float distance(Vector p1, Vector p2);
/// Between the positions of two Objects; -1 if one is null.
float distance(const Object* p_o1, const Object* p_o2);

// Geometry. Edges belong to boxes, circles and lines.

/// min <= value <= max?
bool valueInRange(float value, float min, float max);
/// Does box 1 contain all of box 2?
bool boxContainsBox(Box b1, Box b2);
/// Do two line segments cross? Parallel ones do not.
bool lineIntersectsLine(Line line1, Line line2);
/// Is a part of the segment in the box?
bool lineIntersectsBox(Line line, Box b);
bool circleIntersectsBox(Circle circle, Box b);
/// From which side Object 1, which moved, came upon Object 2: a vector of length 1 away from Object 2, along
/// the axis on which their boxes overlap least; (0,0) if they do not touch, or if the position of Object 1 is
/// the middle of Object 2.
Vector getNormal(const Object* p_o1, const Object* p_o2);
/// The direction of a vector in degrees, 0 to 360: 0 to the right, 90 downward.
float vectorToAngle(Vector v);

// Text.

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
/// The character that a key types; 0 for none.
char characterOf(Keyboard::Key key, bool shift);
/// Log it if a stream has failed. Return 0, or -1 if it has.
int stringStreamCheck(const char* prefix, std::stringstream* p_ss);

// What is only seen. None of it changes the numbers of WM.randomInt().

/// Add about `count` particles, give or take count_spread, as for the others: around a position; in a
/// direction, (0,0) for any; size in pixels; speed in cells per tick; age in ticks; opacity 0 to 255; a
/// colour. At most 1000. Return 0, or -1 for a class that there is none of.
int addParticles(int count, int count_spread, Vector position, float position_spread, Vector direction,
                 float direction_spread, float size, float size_spread, float speed, float speed_spread,
                 int age, int age_spread, unsigned char opacity, char opacity_spread, unsigned char r,
                 unsigned char g, unsigned char b, unsigned char color_spread,
                 ParticleClass particle_class = PARTICLE);
/// Smoke, sparks, rings or fireworks, in their own colours for CUSTOM. Return 0, else -1.
int addParticles(ParticleType type, Vector position, float scale = 1.0, Color color = CUSTOM);
/// Snow, rain or stars all over the world, for ever. Return 0, else -1.
int addParticles(PrecipitationType type, Direction direction, float scale = 1.0, Color color = CUSTOM);
/// A frame's characters fly apart (together, if `speed` is negative), for `age` ticks. Return 0, or -1 for
/// null and for a number without a frame.
int explode(const Sprite* p_sprite, int index, Vector position, int age, float speed, float rotate);
/// The published engine shows its name here before the game begins. Nobody would be there to see it: it
/// returns at once. Return 0.
int splash();

/// Red, green and blue of a colour, 0 to 255 each.
void colorToRGB(Color color, unsigned char& r, unsigned char& g, unsigned char& b);
/// The one of the eight colours that is nearest to this mix. Black only for black itself: on a black ground
/// a dark thing is to be seen.
Color nearestColor(unsigned char r, unsigned char g, unsigned char b);
/// The same as a value of the graphics library (Sfml.h).
sf::Color colorToSFML(Color color);

}  // namespace df

// A thing in the world (book, Listings 4.34, 4.99, 4.104, 4.110, 4.122): games derive theirs from it.
//
// Constructing an Object puts it into the calling thread's current World, destroying it takes it out. It
// may be made with `new`, be a static or automatic variable or a member, and be deleted by hand at any
// time, also inside an event handler; `WM.markForDelete()` is the usual way. The world deletes only what
// was made with `new`.
//
// An Object is a handle: position, velocity, box and the like live in arrays of the world's store. Lengths
// are in cells, velocities in cells per tick; both are kept in fixed point (Fixed.h). A setter that is given
// a number that is not finite or out of range returns -1, changes nothing, is counted by the world
// (World::getRefusals) and logged once per type of Object.
//
// All calls on the thread that runs the world's tick.
#pragma once

#include <cstddef>
#include <cstdint>
#include <new>
#include <string>
#include <vector>

#include "Box.h"
#include "Event.h"
#include "Solidness.h"
#include "Vector.h"
#include "WorldView.h"

namespace df {

class World;
class WorldStore;

/// Highest altitude; 0 is the lowest, drawn first.
inline constexpr int MAX_ALTITUDE = 4;

class Object {
 public:
  /// An active, visible, HARD Object of type "Object" at (0,0), altitude 2, at rest, with the box of a
  /// single character, as the last one in the current world's creation order.
  Object();
  Object(const Object&) = delete;
  Object& operator=(const Object&) = delete;
  virtual ~Object();

  /// A name by which game code tells its Objects apart.
  void setType(std::string new_type);
  const std::string& getType() const { return m_type; }

  /// Place in the world's creation order: unique in a world, never used again, ascending. It changes only
  /// when a removed Object is inserted again.
  int getId() const;

  // Where.

  /// Put the Object at `new_pos`, |coordinate| <= 2e9. No collision is tested, no event sent, no view
  /// moved: for that there is WM.moveObject(). Return 0, else -1.
  int setPosition(Vector new_pos);
  Vector getPosition() const;
  /// Drawing order, 0 to MAX_ALTITUDE, higher ones on top. Return 0, else -1.
  int setAltitude(int new_altitude);
  int getAltitude() const;
  /// The bounding box, corner relative to the position. Used for collisions (edges included) and to find
  /// what is in view. Default: corner (-0.5,-0.5), 1 by 1, which equals the book's test for single
  /// characters. Corner and size up to 1e6 cells. Return 0, else -1.
  int setBox(Box new_box);
  Box getBox() const;

  // How it moves. Velocity = direction × speed, rounded once to 2^-32 cell when one of them is set.

  /// Cells per tick, in the present direction. Return 0, or -1 if not finite or if a component of the
  /// velocity would exceed 2^24.
  int setSpeed(double speed);
  float getSpeed() const;
  /// The direction as it is given, not normalised: (2,0) doubles the velocity. Return 0, else -1.
  int setDirection(Vector new_direction);
  Vector getDirection() const;
  /// Set speed to the length of `new_velocity` and direction to the normalised vector; (0,0) zeroes both.
  /// From the next move on. Return 0, or -1 if a component exceeds 2^24 cells per tick.
  int setVelocity(Vector new_velocity);
  /// What WM.update() adds to the position.
  Vector getVelocity() const;
  /// What WM.update() adds to the velocity after each move, blocked or not (position first, with the old
  /// velocity): `setAcceleration(Vector(0, 0.02))` is gravity. Speed and direction follow. A velocity that
  /// would leave its range stays as it is. Return 0, else -1.
  int setAcceleration(Vector new_acceleration);
  Vector getAcceleration() const;
  /// Position plus velocity: where the next WM.update() tries to move it.
  Vector predictPosition() const;

  // How it collides.

  /// HARD by default. Return 0, or -1 if `new_solid` is none of the three.
  int setSolidness(Solidness new_solid);
  Solidness getSolidness() const;
  /// True if HARD or SOFT.
  bool isSolid() const;
  /// If set, this Object does not move onto SOFT ones either (both still get the collision event).
  void setNoSoft(bool new_no_soft = true);
  bool getNoSoft() const;
  /// Test for collisions all along the way of each move, not only where it ends: for what is fast. Off by
  /// default, as in the book. WM.setSweptCollisions() does it for all. docs/collisions.md has the rules.
  void setSwept(bool swept = true);
  bool isSwept() const;
  /// Where the boxes touch, also compare the characters: two set ones must share a drawn cell. A pair is
  /// tested so if either of the two is precise. Off by default.
  void setPrecise(bool precise = true);
  bool isPrecise() const;
  /// Which characters of the Object are set, a string (UTF-8) per row from the box's upper left cell on;
  /// blanks are holes. No rows: the whole box counts, as by default. What draw() does is never looked at.
  /// Return 0, or -1 (and no change) for rows without any character or a side above 1024.
  int setMask(const std::vector<std::string>& rows);
  /// At rest, test for collisions at each turn as if it had moved to where it stands: to hear of what
  /// touches it. Off by default.
  void setRestContacts(bool rest_contacts = true);
  bool hasRestContacts() const;
  /// What the Object touches where a move begins does not block it if the gap is larger at the end: it
  /// may leave a wall in which it was placed. Both still hear. Off by default.
  void setMayMoveOut(bool may_move_out = true);
  bool getMayMoveOut() const;

  /// An inactive Object gets no events, is not moved by update(), takes no part in collisions and is not
  /// drawn. It stays in the world.
  void setActive(bool active = true);
  bool isActive() const;
  /// An invisible Object is not drawn; everything else goes on.
  void setVisible(bool visible = true);
  bool isVisible() const;

  // What it hears.

  /// Receive events of this type (step, keyboard, mouse, join, leave, or a game's own) through
  /// eventHandler(). Collision and out events come without it. Registering twice is once. Return 0, or
  /// -1 if the Object is in no world.
  int registerInterest(const std::string& event_type);
  /// Return 0, or -1 if it was not registered.
  int unregisterInterest(const std::string& event_type);
  /// Called for each event. Return 1 if it was handled, else 0 (for readers of the book; the engine does
  /// not mind). What it throws costs this Object its life (World::deliver), not the world.
  virtual int eventHandler(const Event* p_e);

  // How it looks.

  /// Called once a tick while the Object is active, visible and in view, to put characters on the screen
  /// with DM.drawCh() and DM.drawString(). Return 0, else -1.
  virtual int draw();
  /// Promise that draw() puts the same characters at the same places relative to the position every time:
  /// it is then called once, and its result moves with the Object. Setting it anew has it called again.
  void setStaticLook(bool static_look = true);
  bool hasStaticLook() const;

  // The engine's view of it.

  /// Handle of the Object: what lists and the host hold.
  ObjectKey key() const;
  /// The world it was made in; null once that is gone.
  World* getWorld() const;

  /// These note which Objects were made with `new`, so that the world knows which ones are its to delete.
  /// (Elements of an array made with `new[]` are not.)
  static void* operator new(std::size_t size);
  static void* operator new(std::size_t size, std::align_val_t align);
  static void* operator new(std::size_t size, const std::nothrow_t& nothrow) noexcept;
  static void* operator new(std::size_t, void* p_place) noexcept { return p_place; }
  static void operator delete(void* p) noexcept;
  static void operator delete(void* p, std::align_val_t align) noexcept;
  static void operator delete(void* p, const std::nothrow_t& /*nothrow*/) noexcept { operator delete(p); }
  static void operator delete(void*, void*) noexcept {}

 private:
  friend class World;
  friend class Interests;
  friend class ObjectList;
  friend class Views;

  int applyVelocity(double speed, Vector direction);
  void deriveKinematics() const;
  int refuse(const char* what) const;
  bool isDeaf() const;  // does its class leave eventHandler() as it is here?

  WorldStore* m_p_store;  // never null: a store lives as long as its last Object
  std::uint32_t m_slot;
  std::string m_type = "Object";
  // What setSpeed and setDirection said. After an acceleration (a flag in the store) or setVelocity, which
  // leaves the vector it got in the direction, they are derived when somebody asks.
  mutable double m_speed = 0;
  mutable Vector m_direction;
  mutable bool m_direction_is_velocity = false;
  std::vector<std::uint32_t> m_interests;  // numbers of event types, see Interests.h
};

}  // namespace df

// A thing in the world (book, Listings 4.34, 4.99, 4.104, 4.110, 4.122). Games derive classes from it.
//
// Constructing an Object puts it into the calling thread's current World, destroying it removes it. It may be
// made with `new`, or be a static or automatic variable or a member. Usually `WM.markForDelete()` deletes it,
// but `delete` is allowed at any time, even inside an event handler. The world deletes only Objects that were
// made with `new`.
//
// An Object is a handle: position, velocity, box and the like are in arrays of the world's store. Lengths are
// in cells, velocities in cells per tick; both are kept in fixed point (Fixed.h). A setter that gets a number
// that is not finite or out of range returns -1 and changes nothing. The world counts such calls
// (WorldLog::refusals) and logs each once per type of Object.
//
// Call all functions on the thread that runs the world's tick.
#pragma once

#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <memory>
#include <new>
#include <string>
#include <type_traits>
#include <vector>

#include "Animation.h"
#include "Box.h"
#include "Event.h"
#include "EventPath.h"
#include "ObjectAttributes.h"
#include "Path.h"
#include "Shape.h"
#include "Solidness.h"
#include "StandardHeaders.h"
#include "Vector.h"
#include "detail/ObjectProfile.h"
#include "detail/WorldView.h"

/// Return type of draw(): int. Games of the published engine's first versions have a `void draw()` and are
/// compiled with -DDF_DRAW=void; the engine ignores the result.
#if !defined(DF_DRAW)
#define DF_DRAW int
#endif

/// Return type of five setters that classes may override: setVelocity(), setDirection(), setAcceleration(),
/// setBox() and setAnimation(). It is void for games of the published engine, which override or hide a `void
/// setVelocity()`. It is int, as for all setters, for Naiad's games, which are compiled with -DDF_COMPAT=0
/// (dragonfly_game() does). -DDF_SETTER=int or =void overrides this. The library works with both.
#if !defined(DF_SETTER)
#if defined(DF_COMPAT) && !DF_COMPAT
#define DF_SETTER int
#else
#define DF_SETTER void
#endif
#endif

namespace naiad {
struct Look;
}

namespace df {

class World;
class WorldStore;
struct ObjectExtras;

/// Highest altitude; 0 is the lowest, drawn first.
inline constexpr int MAX_ALTITUDE = 4;
/// The published engine's limit, for games that use the name. Naiad does not limit an Object's interests.
inline constexpr int MAX_OBJ_EVENTS = 100;

class Object {
 public:
  /// Makes an active, visible, HARD Object of type "Object" at (0,0) (compat: "(Undefined)" at (1,1)),
  /// altitude 2, at rest, with the default box (setBox()), last in the current world's creation order.
  Object();
  /// Makes a copy that is not in the world, so that it is neither drawn nor moved and gets no events. It has
  /// the same attributes except receiveWhilePaused(), another id, and no interests, mask or path.
  /// WM.insertObject() inserts it.
  Object(const Object& other);
  /// Copies the other's attributes. Keeps its own id, interests, mask, path and place in the creation order.
  Object& operator=(const Object& other);
  virtual ~Object();

  /// Name by which game code distinguishes the kinds of its Objects.
  virtual void setType(std::string new_type);
  const std::string& getType() const { return m_p_profile->type; }

  /// The Object's place in the world's creation order: unique in a world, never reused, ascending. The id
  /// changes only when a removed Object is inserted again, and with setId().
  int getId() const;
  /// Replaces the id by a number of the game's choice. The creation order does not change.
  void setId(int new_id);
  /// Converts to the highest id that the current world has assigned so far, which excludes ids of setId().
  /// Assignments have no effect.
  struct MaxId {
    operator int() const;
    MaxId& operator=(int /*id*/) { return *this; }
  };
  /// The highest id that the current world has assigned so far.
  inline static MaxId max_id;

  // Position and box.

  /// Puts the Object at `new_pos`, |coordinate| <= 2e9. Tests no collisions, sends no events and moves no
  /// views: see WM.moveObject(). Returns 0, else -1.
  virtual int setPosition(Vector new_pos);
  Vector getPosition() const;
  /// Drawing order, 0 to MAX_ALTITUDE; higher Objects are drawn on top. setAltitude() returns 0, else -1.
  virtual int setAltitude(int new_altitude);
  int getAltitude() const;
  /// Bounding box, its corner relative to the position. It decides collisions (edges included) and whether
  /// the Object is in view. Default: corner (-0.5,-0.5), 1 by 1 (compat: 0.99 by 0.99), which equals the
  /// book's test for single characters. Corner and size are up to 1e6 cells. setBox() returns 0, else -1.
  virtual DF_SETTER setBox(Box new_box);
  Box getBox() const;

  // Motion. Velocity = direction × speed, rounded to 2^-32 cell when either is set.

  /// Speed in cells per tick, in the present direction. setSpeed() returns 0, or -1 if it is not finite or if
  /// a component of the velocity would exceed 2^24.
  int setSpeed(double speed);
  float getSpeed() const;
  /// Direction, not normalised: (2,0) gives twice the velocity of (1,0). setDirection() returns 0, else -1.
  virtual DF_SETTER setDirection(Vector new_direction);
  Vector getDirection() const;
  /// Sets speed to the length of `new_velocity` and direction to the normalised vector; (0,0) zeroes both.
  /// Takes effect with the next move. Returns 0, or -1 if a component exceeds 2^24 cells per tick.
  virtual DF_SETTER setVelocity(Vector new_velocity);
  /// Returns the vector that WM.update() adds to the position.
  Vector getVelocity() const;
  /// Components of the velocity, as published engines up to 4.1 have them.
  void setXVelocity(float x) { setVelocity(Vector(x, getVelocity().getY())); }
  void setYVelocity(float y) { setVelocity(Vector(getVelocity().getX(), y)); }
  float getXVelocity() const { return getVelocity().getX(); }
  float getYVelocity() const { return getVelocity().getY(); }
  /// Vector that WM.update() adds to the velocity after each move, blocked or not (position first, with the
  /// old velocity): `setAcceleration(Vector(0, 0.02))` is gravity. Speed and direction follow. A velocity
  /// that would leave its range stays as it is. setAcceleration() returns 0, else -1.
  virtual DF_SETTER setAcceleration(Vector new_acceleration);
  Vector getAcceleration() const;
  /// Adds the acceleration to the velocity, as update() does after each move.
  void accelerate() { setVelocity(getVelocity() + getAcceleration()); }
  /// Returns position plus velocity: the target of the next move in WM.update().
  Vector predictPosition() const;

  // Collisions.

  /// Solidness, HARD by default. setSolidness() returns 0, or -1 if `new_solid` is not one of the three.
  virtual int setSolidness(Solidness new_solid);
  Solidness getSolidness() const;
  /// True if HARD or SOFT.
  bool isSolid() const;
  /// If set, SOFT Objects block this Object, too. Both still get the collision event.
  void setNoSoft(bool new_no_soft = true);
  bool getNoSoft() const;
  /// If set, collisions are tested along the whole path of each move, not only at its end. Use it for fast
  /// Objects. Off by default. WM.setSweptCollisions() sets it for all. Rules: docs/collisions.md.
  void setSwept(bool swept = true);
  bool isSwept() const;
  /// If set, touching boxes are not enough: the two Objects must share a cell in which both draw a set
  /// character. A pair is tested like this if either Object is precise. Off by default.
  void setPrecise(bool precise = true);
  bool isPrecise() const;
  /// Sets the characters that setPrecise() compares: a string (UTF-8) per row, from the box's upper left cell
  /// on; blanks are holes. Without rows, as by default, the characters of the sprite's frame are compared if
  /// they are drawn in the box, else the whole box counts. The characters that an override of draw() draws do
  /// not matter. Returns 0, or -1 without change for rows without any character or a side above 1024.
  int setMask(const std::vector<std::string>& rows);
  /// If set, an Object at rest is tested for collisions in each update() as if it had moved to its position,
  /// so that it gets collision events with the Objects that touch it. Off by default.
  void setRestContacts(bool rest_contacts = true);
  bool hasRestContacts() const;
  /// If set, an Object that this one touches at the start of a move does not block it if the gap is larger at
  /// the end. So it may leave a wall in which it was placed. Both still get the event. Off by default.
  void setMayMoveOut(bool may_move_out = true);
  bool getMayMoveOut() const;

  /// An inactive Object gets no events, is not moved by update(), takes no part in collisions and is not
  /// drawn. It stays in the world. setActive() returns 0.
  virtual int setActive(bool active = true);
  bool isActive() const;
  /// An invisible Object is not drawn, but moves, collides and gets events. Returns 0.
  int setVisible(bool visible = true);
  /// Returns the flag of setVisible(). An override has no effect on the engine, which reads the flag.
  virtual bool isVisible() const;

  // Events.

  /// Registers for events of this type (step, keyboard, mouse, join, leave, or a game's own), which then come
  /// to eventHandler(). Collision and out events need no registration. A second registration has no effect.
  /// Returns 0, or -1 if the Object is not in a world.
  int registerInterest(const std::string& event_type);
  /// Ends an interest. Returns 0; -1 if it was not registered (compat: 0) or the Object is not in a world.
  int unregisterInterest(const std::string& event_type);
  /// Returns the number of registered interests.
  int getEventCount() const { return static_cast<int>(m_p_profile->interests.size()); }
  /// Handles an event. Returns 1 if the event was handled, else 0 (as in the book; the engine ignores the
  /// result). If the handler throws, the Object is deleted (EventDispatch::deliver) and the world continues.
  virtual int eventHandler(const Event* p_e);

  // Look.

  /// Called once a tick while the Object is active, visible and in view, to put characters on the screen with
  /// DM.drawCh() and DM.drawString(). By default, shows the sprite, the shape and the present frame, if the
  /// Object has them. Returns 0, else -1.
  virtual DF_DRAW draw();

  /// Shows this sprite (RM.loadSprite), from its first frame on. Unless `set_box` is false, the box becomes
  /// the sprite's: its size, the position in the middle. If characters are compared (setPrecise), they are
  /// those of the frame. Returns 0, or -1 for an Object without a world or a label that is not loaded. For
  /// such a label, an Object without a sprite then shows a '?' (compat: nothing).
  virtual int setSprite(std::string sprite_label);
  int setSprite(const std::string& sprite_label, bool set_box);
  /// Shows a sprite owned by the game, which must keep it as long as it is shown; null: none.
  int setSprite(Sprite* p_new_sprite, bool set_box = true);
  /// Returns the sprite; null for none.
  Sprite* getSprite() const { return getAnimation().getSprite(); }
  /// Sets the animation with its sprite. Unless `set_box` is false, the box becomes the sprite's.
  virtual DF_SETTER setAnimation(Animation new_animation, bool set_box = true);
  /// Returns a copy; to change the animation, pass it to setAnimation().
  Animation getAnimation() const;
  /// Index of the frame that is shown.
  void setSpriteIndex(int new_index);
  int getSpriteIndex() const { return getAnimation().getIndex(); }
  /// Ticks per frame of the sprite, for all Objects that share it; 0: no animation.
  void setSpriteSlowdown(int new_slowdown);
  int getSpriteSlowdown() const;
  /// Number of ticks for which the frame has been shown; -1 stops the animation.
  void setSpriteSlowdownCount(int new_slowdown_count);
  int getSpriteSlowdownCount() const { return getAnimation().getSlowdownCount(); }
  /// Label of the sprite. Setting it changes only the name.
  void setSpriteName(std::string new_name);
  std::string getSpriteName() const { return getAnimation().getName(); }
  /// If set, as by default, the sprite is drawn around the position, otherwise with its upper left character
  /// at the position. Sets the box accordingly.
  void setCentered(bool centered = true);
  bool isCentered() const;
  /// Character of the sprite that is not drawn, for all Objects that share it; 0: all are drawn.
  void setTransparency(char new_transparency = ' ');
  char getTransparency() const;
  /// Shows a circle, square or triangle.
  virtual void setShape(Shape new_shape);
  /// Returns the shape; a white circle if none was set.
  Shape getShape() const;
  /// Promises that draw() always draws equal characters at equal places relative to the position. draw() is
  /// then called only once, and the result moves with the Object. Each further setStaticLook(), and each
  /// change of the sprite, its frame or the shape, makes draw() run once more.
  void setStaticLook(bool static_look = true);
  bool hasStaticLook() const;
  /// Number of a body's frames, and index of the frame shown in this tick. Both are 0 for other Objects.
  int getFrameCount() const;
  int getFrame() const;

  // Text form, for games that save or send their Objects.

  /// Returns the attributes as "id:7,pos-x:2.5,pos-y:3,…": those modified since they were last written, or
  /// those that `attr` names ("pos", "box", …, separated by commas), or all for "ALL". Attributes that were
  /// written count as not modified.
  virtual std::string serialize(std::string attr = "");
  /// Writes all attributes, or only the modified ones, as in the first published versions. Takes only bool.
  template <class Flag>
  typename std::enable_if<std::is_same<Flag, bool>::value, std::string>::type serialize(Flag all) {
    return serialize(std::string(all ? "ALL" : ""));
  }
  /// Writes the attributes in the mask `attr`; 0 means the modified ones. Returns 0, or -1 for null.
  virtual int serialize(std::stringstream* p_ss, unsigned int attr = 0);
  /// Sets the attributes in a text from serialize(), except events, direction, shape and those of paths.
  /// Returns 0, or -1 if a value was refused.
  virtual int deserialize(std::string s);
  /// Like deserialize(s); returns -1 also if p_ss is null. Adds the attributes found to the mask *p_a, if
  /// `p_a` is not null.
  virtual int deserialize(std::stringstream* p_ss, unsigned int* p_a = nullptr);
  /// True if the attribute (without an argument: any attribute) has changed since it was last written, was
  /// never written, or was marked by setModified().
  bool isModified(ObjectAttribute attribute) const;
  virtual bool isModified() const { return getModified() != 0; }
  /// Mask of the modified attributes. setModified() makes the attributes in `new_modified` count as modified
  /// even if they have not changed; this replaces the mask of an earlier call.
  virtual void setModified(unsigned int new_modified);
  virtual unsigned int getModified() const;
  /// Returns type, id and position, for log lines.
  std::string toString() const;

  // Paths.

  /// Makes the Object walk to a position, at its present speed, round HARD Objects (PathFind.h). Each step
  /// sets the velocity towards the next node. An EventPath tells the Object the result of the search.
  void pathTo(Vector position);
  /// Makes the Object walk to the present position of another Object.
  void pathTo(const Object* p_o_target);
  /// Turns the direction towards a position.
  void moveTo(Vector new_position);
  void setPath(Path new_path);  ///< Path for setFollowPath().
  Path getPath() const;
  /// Starts or stops walking along the path, from its next node on.
  virtual void setFollowPath(bool new_follow_path = true);
  bool getFollowPath() const;
  /// Only stored for getAvoidCollisions(), because pathTo() always avoids HARD Objects.
  virtual void setAvoidCollisions(bool new_avoid_collisions = true);
  bool getAvoidCollisions() const;

  // Functions for lists, layers and hosts.

  /// Returns the handle of the Object.
  ObjectKey key() const;
  /// Returns the world in which the Object was made; null if that world or the Object has been destroyed.
  World* getWorld() const;

  /// The operators record which Objects were made with `new`, because the world deletes these (but not
  /// elements of arrays). With compat they clear the memory, because games read members that they never set.
  static void* operator new(std::size_t size);
  static void* operator new(std::size_t size, const std::nothrow_t& nothrow) noexcept;
  static void* operator new(std::size_t, void* p_place) noexcept { return p_place; }
  static void operator delete(void* p) noexcept;
  static void operator delete(void* p, const std::nothrow_t& /*nothrow*/) noexcept { operator delete(p); }
  static void operator delete(void*, void*) noexcept {}
#if defined(__cpp_aligned_new)
  static void* operator new(std::size_t size, std::align_val_t align);
  static void operator delete(void* p, std::align_val_t align) noexcept;
#endif

 protected:
  /// Makes the position a cell of each view, not the world. The Object is then always drawn (ViewObject.h).
  void showOnView();
  /// Makes the Object get events while the game is paused, too (Pause.h).
  void receiveWhilePaused();
  [[deprecated("say receiveWhilePaused")]] void hearWhilePaused() {
    receiveWhilePaused();
  }

 private:
  friend class Capture;
  friend class EventDispatch;
  friend class ObjectRegistry;
  friend class PathFollowers;
  friend const Mask* spriteMaskOf(const Object& object);
  friend class ObjectList;
  friend class ObjectLookAccess;
  friend class Views;

  int applyVelocity(double speed, Vector direction);
  void deriveKinematics() const;
  int refuse(const char* what) const;
  bool receivesWhilePaused() const;
  bool hasNoEventHandler() const;  // true if its class does not override eventHandler()
  void copyAttributes(const Object& other);
  ObjectExtras& extras();
  void dropExtras();
  void leaveWorld();
  void animate();
  void invalidateLook();
  void fitBox();
  std::shared_ptr<const naiad::Look> publishedLook(std::uint32_t tick);
  ObjectAttributes attributes() const;

  // Few members, so that the members of derived classes, which handlers use, share their cache line.
  WorldStore* m_p_store;  // never null: a store lives as long as its last Object
  std::uint32_t m_slot;
  std::unique_ptr<ObjectExtras> m_p_extras;  // rarely used attributes; null until needed
  ObjectProfile* m_p_profile;                // never null; owned by the store
};

}  // namespace df

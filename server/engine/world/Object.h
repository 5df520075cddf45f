// A thing in the world (book, Listings 4.34, 4.99, 4.104, 4.110, 4.122): games derive theirs from it.
//
// Constructing an Object puts it into the calling thread's current World, destroying it takes it out. It
// may be made with `new`, be a static or automatic variable or a member, and be deleted by hand at any
// time, also inside an event handler; usually by `WM.markForDelete()`. The world deletes only what
// was made with `new`.
//
// An Object is a handle: position, velocity, box and the like live in arrays of the world's store. Lengths
// are in cells, velocities in cells per tick; both are kept in fixed point (Fixed.h). A setter that is given
// a number that is not finite or out of range returns -1, changes nothing, is counted by the world
// (WorldLog::refusals) and logged once per type of Object.
//
// All calls on the thread that runs the world's tick.
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

/// What draw() returns: int. Games of the published engine's first versions have a `void draw()`, and are
/// compiled with -DDF_DRAW=void; the engine ignores the result.
#if !defined(DF_DRAW)
#define DF_DRAW int
#endif

/// What five setters return that classes may override: setVelocity(), setDirection(), setAcceleration(),
/// setBox() and setAnimation(). Games of the published engine override, or hide, a `void setVelocity()`;
/// games made for Naiad, which say -DDF_COMPAT=0 (dragonfly_game() does), get 0 or -1 as from all setters.
/// -DDF_SETTER=int or =void decides. The library is the same for both.
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
/// Of the published engine, for games that name it: here an Object may register any number of interests.
inline constexpr int MAX_OBJ_EVENTS = 100;

class Object {
 public:
  /// An active, visible, HARD Object of type "Object" at (0,0) (compat: "(Undefined)" at (1,1)), altitude 2,
  /// at rest, with the box of a single character, as the last one in the current world's creation order.
  Object();
  /// A copy that is not in the world, so that it is neither drawn nor moved and gets no events: the same
  /// attributes, another id, no interests, no mask or path of its own. WM.insertObject() brings it in.
  Object(const Object& other);
  /// Takes over the other's attributes, and keeps its own id, its interests, its place in the world.
  Object& operator=(const Object& other);
  virtual ~Object();

  /// A name by which game code tells its Objects apart.
  virtual void setType(std::string new_type);
  const std::string& getType() const { return m_p_profile->type; }

  /// Place in the world's creation order: unique in a world, never used again, ascending. It changes only
  /// when a removed Object is inserted again, and with setId().
  int getId() const;
  /// Give it a number of the game's own. The creation order stays.
  void setId(int new_id);
  /// The highest id that the current world has given so far. Assignments to it have no effect.
  struct MaxId {
    operator int() const;
    MaxId& operator=(int /*id*/) { return *this; }
  };
  /// The highest id given in the current world.
  inline static MaxId max_id;

  // Where.

  /// Put the Object at `new_pos`, |coordinate| <= 2e9. No collision is tested, no event sent, no view
  /// moved: for that there is WM.moveObject(). Return 0, else -1.
  virtual int setPosition(Vector new_pos);
  Vector getPosition() const;
  /// Drawing order, 0 to MAX_ALTITUDE, higher ones on top. Return 0, else -1.
  virtual int setAltitude(int new_altitude);
  int getAltitude() const;
  /// The bounding box, corner relative to the position. Used for collisions (edges included) and to find
  /// what is in view. Default: corner (-0.5,-0.5), 1 by 1, which equals the book's test for single
  /// characters. Corner and size up to 1e6 cells. Return 0, else -1.
  virtual DF_SETTER setBox(Box new_box);
  Box getBox() const;

  // How it moves. Velocity = direction × speed, rounded once to 2^-32 cell when one of them is set.

  /// Cells per tick, in the present direction. Return 0, or -1 if not finite or if a component of the
  /// velocity would exceed 2^24.
  int setSpeed(double speed);
  float getSpeed() const;
  /// The direction as it is given, not normalised: (2,0) doubles the velocity. Return 0, else -1.
  virtual DF_SETTER setDirection(Vector new_direction);
  Vector getDirection() const;
  /// Set speed to the length of `new_velocity` and direction to the normalised vector; (0,0) zeroes both.
  /// From the next move on. Return 0, or -1 if a component exceeds 2^24 cells per tick.
  virtual DF_SETTER setVelocity(Vector new_velocity);
  /// What WM.update() adds to the position.
  Vector getVelocity() const;
  /// What WM.update() adds to the velocity after each move, blocked or not (position first, with the old
  /// velocity): `setAcceleration(Vector(0, 0.02))` is gravity. Speed and direction follow. A velocity that
  /// would leave its range stays as it is. Return 0, else -1.
  virtual DF_SETTER setAcceleration(Vector new_acceleration);
  Vector getAcceleration() const;
  /// Velocity += acceleration, as update() does it after each move.
  void accelerate() { setVelocity(getVelocity() + getAcceleration()); }
  /// Position plus velocity: where the next WM.update() tries to move it.
  Vector predictPosition() const;

  // How it collides.

  /// HARD by default. Return 0, or -1 if `new_solid` is none of the three.
  virtual int setSolidness(Solidness new_solid);
  Solidness getSolidness() const;
  /// True if HARD or SOFT.
  bool isSolid() const;
  /// If set, this Object does not move onto SOFT ones either (both still get the collision event).
  void setNoSoft(bool new_no_soft = true);
  bool getNoSoft() const;
  /// Test for collisions along the whole path of each move, not only where it ends: for fast Objects. Off by
  /// default, as in the book. WM.setSweptCollisions() does it for all. docs/collisions.md has the rules.
  void setSwept(bool swept = true);
  bool isSwept() const;
  /// Where the boxes touch, also compare the characters: two set ones must share a drawn cell. A pair is
  /// tested so if either of the two is precise. Off by default.
  void setPrecise(bool precise = true);
  bool isPrecise() const;
  /// Which characters of the Object are set, a string (UTF-8) per row from the box's upper left cell on;
  /// blanks are holes. No rows: the whole box counts, as by default. draw() does not count.
  /// Return 0, or -1 (and no change) for rows without any character or a side above 1024.
  int setMask(const std::vector<std::string>& rows);
  /// At rest, test for collisions at each turn as if it had moved to where it stands: to get events of what
  /// touches it. Off by default.
  void setRestContacts(bool rest_contacts = true);
  bool hasRestContacts() const;
  /// What the Object touches where a move begins does not block it if the gap is larger at the end: it
  /// may leave a wall in which it was placed. Both still get the event. Off by default.
  void setMayMoveOut(bool may_move_out = true);
  bool getMayMoveOut() const;

  /// An inactive Object gets no events, is not moved by update(), takes no part in collisions and is not
  /// drawn. It stays in the world. Return 0.
  virtual int setActive(bool active = true);
  bool isActive() const;
  /// An invisible Object is not drawn; everything else goes on. Return 0.
  int setVisible(bool visible = true);
  /// For games: the engine draws what setVisible() says.
  virtual bool isVisible() const;

  // Its events.

  /// Receive events of this type (step, keyboard, mouse, join, leave, or a game's own) through
  /// eventHandler(). Collision and out events come without it. Registering twice is once. Return 0, or
  /// -1 if the Object is in no world.
  int registerInterest(const std::string& event_type);
  /// Return 0, or -1 if it was not registered (compat: 0).
  int unregisterInterest(const std::string& event_type);
  /// How many interests it has registered.
  int getEventCount() const { return static_cast<int>(m_p_profile->interests.size()); }
  /// Called for each event. Return 1 if it was handled, else 0 (as in the book; the engine ignores it). If it
  /// throws, the Object is deleted (EventDispatch::deliver) and the world goes on.
  virtual int eventHandler(const Event* p_e);

  // How it looks.

  /// Called once a tick while the Object is active, visible and in view, to put characters on the screen
  /// with DM.drawCh() and DM.drawString(). As it is here it shows the sprite and the shape, if there are
  /// such, or the frame that shows now, if the Object has frames. Return 0, else -1.
  virtual DF_DRAW draw();

  /// Show this sprite (RM.loadSprite), from its first frame on. Unless `set_box` is false, the box becomes
  /// the sprite's: its size, the position in the middle. Where characters are compared (setPrecise), those of
  /// the frame count. Return 0, or -1 for a label that is not loaded.
  virtual int setSprite(std::string sprite_label);
  int setSprite(const std::string& sprite_label, bool set_box);
  /// The same with a sprite of the game's own, which has to live as long as it is shown; null: none.
  int setSprite(Sprite* p_new_sprite, bool set_box = true);
  /// Null for none.
  Sprite* getSprite() const { return getAnimation().getSprite(); }
  /// The animation, sprite and all. Unless `set_box` is false, the box becomes the sprite's.
  virtual DF_SETTER setAnimation(Animation new_animation, bool set_box = true);
  /// A copy: setAnimation() takes it back.
  Animation getAnimation() const;
  /// Which frame shows.
  void setSpriteIndex(int new_index);
  int getSpriteIndex() const { return getAnimation().getIndex(); }
  /// The pace of the sprite, and so of all Objects that share it: ticks to a frame; 0: no animation.
  void setSpriteSlowdown(int new_slowdown);
  int getSpriteSlowdown() const;
  /// Ticks for which the frame has been shown; -1 stops the animation.
  void setSpriteSlowdownCount(int new_slowdown_count);
  int getSpriteSlowdownCount() const { return getAnimation().getSlowdownCount(); }
  /// The label of the sprite; setting it changes the name alone.
  void setSpriteName(std::string new_name);
  std::string getSpriteName() const { return getAnimation().getName(); }
  /// Draw the sprite around the position, as by default, or with its upper left character there, and set the
  /// box so.
  void setCentered(bool centered = true);
  bool isCentered() const;
  /// The character of the sprite that is not drawn, for all Objects that share it; 0: all are.
  void setTransparency(char new_transparency = ' ');
  char getTransparency() const;
  /// Show a circle, square or triangle.
  virtual void setShape(Shape new_shape);
  /// A white circle if none was set.
  Shape getShape() const;
  /// Promise that draw() puts the same characters at the same places relative to the position every time:
  /// it is then called once, and its result moves with the Object. Setting it again has draw() called again.
  void setStaticLook(bool static_look = true);
  bool hasStaticLook() const;
  /// How many frames a body has, and the index of the one that shows in the present tick (0 if none).
  int getFrameCount() const;
  int getFrame() const;

  // As text, for games that save or send their Objects.

  /// The attributes as "id:7,pos-x:2.5,pos-y:3,…": those modified since they were last written, or those that
  /// `attr` names ("pos", "box", …, separated by commas), or all of them for "ALL". Those written count as
  /// not modified from then on.
  virtual std::string serialize(std::string attr = "");
  /// All of them, or those modified: the first versions' form. (Not for what only converts to bool.)
  template <class Flag>
  typename std::enable_if<std::is_same<Flag, bool>::value, std::string>::type serialize(Flag all) {
    return serialize(std::string(all ? "ALL" : ""));
  }
  /// The same, of the attributes in the mask `attr`; 0: the modified ones. Return 0, or -1 for null.
  virtual int serialize(std::stringstream* p_ss, unsigned int attr = 0);
  /// Take on what such a text says. Return 0, or -1 if a value was refused.
  virtual int deserialize(std::string s);
  /// The same; what attributes it was is added to the mask *p_a, if that is not null.
  virtual int deserialize(std::stringstream* p_ss, unsigned int* p_a = nullptr);
  /// Is an attribute, or any one, another than when it was last written? It has to be written first.
  bool isModified(ObjectAttribute attribute) const;
  virtual bool isModified() const { return getModified() != 0; }
  /// The modified attributes as a mask. To set it makes these count as modified, besides those that are.
  virtual void setModified(unsigned int new_modified);
  virtual unsigned int getModified() const;
  /// What it is and where, for log lines.
  std::string toString() const;

  // Paths.

  /// Walk to a position, with the speed it has, round HARD Objects (PathFind.h): a velocity is set in each
  /// step from node to node, until it is there. An EventPath tells the Object how the search ended.
  void pathTo(Vector position);
  /// To where another Object is now.
  void pathTo(const Object* p_o_target);
  /// Turn towards a position.
  void moveTo(Vector new_position);
  void setPath(Path new_path);  ///< Walk along this one from now on.
  Path getPath() const;
  /// Walk along the path, from its next node on, or stop doing so.
  virtual void setFollowPath(bool new_follow_path = true);
  bool getFollowPath() const;
  /// Whether it walks round others: for getters only, pathTo() always does.
  virtual void setAvoidCollisions(bool new_avoid_collisions = true);
  bool getAvoidCollisions() const;

  // For lists, layers and hosts.

  /// Handle of the Object.
  ObjectKey key() const;
  /// The world it was made in; null once that is gone.
  World* getWorld() const;

  /// These note which Objects were made with `new`: those the world deletes. (Elements of an array made with
  /// `new[]` are not.) With compat the memory is cleared: games read members that they never set.
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
  /// Its position is a cell of every view, and it is always drawn (ViewObject.h).
  void showOnView();
  /// Send it events while the game is paused, too (Pause.h).
  void hearWhilePaused();

 private:
  friend class Capture;
  friend class EventDispatch;
  friend class ObjectRegistry;
  friend class Walkers;
  friend const Mask* spriteMaskOf(const Object& object);
  friend class ObjectList;
  friend class ObjectLookAccess;
  friend class Views;

  int applyVelocity(double speed, Vector direction);
  void deriveKinematics() const;
  int refuse(const char* what) const;
  bool hearsWhilePaused() const;
  bool isDeaf() const;  // does its class leave eventHandler() as it is here?
  void resemble(const Object& other);
  ObjectExtras& extras();
  void dropExtras();
  void leaveWorld();
  void animate();
  void forgetLook();
  void fitBox();
  std::shared_ptr<const naiad::Look> publishedLook(std::uint32_t tick);
  ObjectAttributes attributes() const;

  // Few members, so that a game's own, which its handlers use, lie in the same cache line with these.
  WorldStore* m_p_store;  // never null: a store lives as long as its last Object
  std::uint32_t m_slot;
  std::unique_ptr<ObjectExtras> m_p_extras;  // what only some have; null until it is needed
  ObjectProfile* m_p_profile;                // never null, the store's
};

}  // namespace df

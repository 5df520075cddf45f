// Deformable objects: rope, cloth, blob, beam.
//
//   PM.setGravity(df::Vector(0, 0.02));
//   auto *p_blob = new df::Blob(df::Vector(20, 5), 3);              // radius: 3 widths of a cell
//   auto *p_rope = new df::Rope(df::Vector(10, 4), df::Vector(30, 4));
//   p_rope->pin(0);
//   p_rope->pin(p_rope->getNodeCount() - 1);
//   p_rope->attach(10, p_crate);
//
// A soft body consists of nodes, which are points with mass, and of springs and beams between them. Its
// position is its centre of mass, its velocity that of the centre, and its box encloses it. Setting the
// position moves the whole body, pinned nodes too; setting the velocity does not move pinned nodes. It
// collides with HARD bodies, HARD Objects and other soft bodies. Both sides get an EventCollision when a
// contact begins, and on request an EventContactEnd when it ends. Because it is SPECTRAL, Objects that move
// by the book's rules pass through it.
//
// Units: positions in cells, lengths in cell widths, times in ticks, mass in the game's unit. Stiffness is an
// acceleration (cell widths per tick²), so that it does not depend on the mass.
//
// Setters return 0. For numbers that are not finite or out of range they return -1, change nothing, and the
// world counts the refusal (WorldLog::refusals). Constructors count it too, and use their default instead.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "BodyDrawing.h"
#include "Color.h"
#include "Object.h"
#include "Vector.h"

namespace naiad::physics {
class SoftTable;
struct SoftBody;
struct SoftDrawn;
struct SoftEntry;
}  // namespace naiad::physics

namespace df {

class Body;

/// Common base of ropes, cloths, blobs and beams.
class SoftBody : public Object {
 public:
  SoftBody(const SoftBody&) = delete;
  SoftBody& operator=(const SoftBody&) = delete;
  ~SoftBody() override;

  /// Returns the mass in the game's unit.
  double getMass() const;
  /// Sets the factor of the world's gravity (PM.setGravity), −1e6 … 1e6; 1 by default.
  int setGravityScale(double scale);
  /// Sets Coulomb's coefficient of friction, 0 … 1e6; 0.5 by default. Two bodies have the geometric mean.
  int setFriction(double friction);
  /// Sets drag: speeds decay as exp(−drag · ticks). 0 … 1e6 per tick, 0.02 by default.
  int setDrag(double drag);

  /// Changes the velocity of the whole body at once, by impulse / mass. In mass · cells per tick, up to ±1e9.
  int applyImpulse(Vector impulse);
  /// Like applyImpulse(), for one node.
  int applyImpulse(int node, Vector impulse);
  /// Pushes the whole body during the next tick, each node in proportion to its mass, in mass · cells per
  /// tick². Several pushes add up; limit: ±1e9.
  int applyForce(Vector force);
  /// Like applyForce(), for one node. For a lasting force, apply it in each tick.
  int applyForce(int node, Vector force);

  /// If set, this body gets an EventContactEnd when a contact ends. Off by default.
  void setContactEnds(bool contact_ends = true) { m_has_contact_ends = contact_ends; }
  bool hasContactEnds() const { return m_has_contact_ends; }

  // Nodes, numbered 0 … getNodeCount() - 1.

  /// Returns the number of nodes.
  int getNodeCount() const;
  /// Position in cells, velocity in cells per tick; (0,0) if the node does not exist.
  Vector getNodePosition(int node) const;
  Vector getNodeVelocity(int node) const;
  /// Returns the node nearest to a point; -1 for a point out of range.
  int getNearestNode(Vector where) const;
  /// Pins a node to its present position, so that no force moves it, or releases it.
  int pin(int node, bool pinned = true);
  bool isPinned(int node) const;
  /// Joins a node to the point of a body where the node is now; each pulls the other. The two do not collide.
  /// The attachment ends when the body is deleted. A node has at most one: a new one replaces the old one.
  int attach(int node, Body* p_body);
  /// Ends the node's attachment. Also returns -1 if there is none.
  int detach(int node);

  // Dragging with a mouse: the grabbed node follows a target, with a force of at most `strength`.

  /// Grabs the node nearest to `where` (cells); `strength` is the maximum force. Returns 0, else -1.
  int grab(Vector where, double strength);
  /// Moves the drag target, initially the grabbed node's position. Returns -1 if nothing is grabbed.
  int dragTo(Vector target);
  void release();          ///< Ends dragging; does nothing if no node is grabbed.
  bool isGrabbed() const;  ///< True while a node is grabbed.

  /// True if the body is in quarantine because its motion has no finite solution. It stands still and
  /// collides with nothing until its position or velocity is set; then it has its original shape again.
  bool isFrozen() const;
  /// True while the body sleeps at rest. Then it costs almost nothing until something touches or changes it.
  bool isAsleep() const;

  /// Draws the body as lines (OUTLINE), with the enclosed area (FILL), or not at all, with the character
  /// `ch`. If `ch` is 0, lines have characters by their direction, and a filling has #. Returns 0, else -1.
  int setDrawing(BodyDrawing drawing, char32_t ch = 0, Color color = COLOR_DEFAULT);
  int draw() override;

 protected:
  /// Constructor for derived classes: creates an Object without nodes; then call make() once.
  SoftBody();
  void make(const naiad::physics::SoftBody& body);
  /// Returns `value` if it lies within the limits. Otherwise counts a refusal and returns `usual`.
  double checked(const char* what, double value, double least, double most, double usual) const;
  Vector checked(const char* what, Vector position) const;

 private:
  bool hasNode(int node) const { return node >= 0 && node < getNodeCount(); }
  naiad::physics::SoftEntry& entry() const;
  const naiad::physics::SoftBody& body() const;
  template <class Change>
  int change(Change change);
  void syncFromStore() const;
  int refuseAs(const char* what) const;

  std::shared_ptr<naiad::physics::SoftTable> m_table;
  std::shared_ptr<naiad::physics::SoftDrawn> m_drawn;
  int m_id = -1;  ///< id in m_table; −1 before make()
  bool m_has_contact_ends = false;
};

/// A rope between two points. Its ends are free until they are pinned with pin().
class Rope : public SoftBody {
 public:
  /// `stiffness`, 1e-6 … 1e6: a hanging rope stretches by about gravity / (2 · stiffness) of its length.
  /// `links` is at most 200; 0 chooses the number by the length.
  Rope(Vector from, Vector to, double mass = 1, double stiffness = 20, int links = 0);
};

/// A beam between two points. It keeps its angle at a pinned node only if it has a second pin or is clamped.
class Beam : public SoftBody {
 public:
  /// `stiffness`, 1e-6 … 1e6: a beam clamped at `from` bends under its own weight by gravity / stiffness of
  /// its length. Its bending stiffness EI is stiffness · mass · length² / 8. `elements` is 2 … 100; 0 chooses
  /// the number by the length.
  Beam(Vector from, Vector to, double mass = 1, double stiffness = 1, bool is_clamped = false,
       int elements = 0);
};

/// A piece of cloth, seen from the front. Pin some nodes to hang it up.
class Cloth : public SoftBody {
 public:
  /// `width` and `height` are in cells, 0.5 … 1000. `stiffness`, 1e-6 … 1e6: a hanging cloth stretches by
  /// about gravity / (2 · stiffness) of its height. `columns` and `rows` of threads are 2 … 128; 0 chooses
  /// the number by the size, at most 25. From about 20 × 20 on, another method moves the body, whose cost
  /// grows with the number of nodes (docs/physics/soft.md). If either is given, threads become taut when
  /// stretched by 3 % (or 0.15 / stiffness, if that is more), so that the corners by which a cloth hangs can
  /// bear it.
  Cloth(Vector corner, double width, double height, double mass = 1, double stiffness = 5, int columns = 0,
        int rows = 0);
  /// Return the numbers of columns and rows of threads: one more than those of the meshes between them.
  int getColumns() const { return m_columns; }
  int getRows() const { return m_rows; }
  /// Returns the node where a column and row meet, counted from 0 at the upper left corner; -1 if none.
  int getNode(int column, int row) const;

 private:
  int m_columns = 0;
  int m_rows = 0;
  bool m_is_upright = false;
};

/// A gas-filled elastic skin.
class Blob : public SoftBody {
 public:
  /// `radius` is in cell widths, 0.1 … 1000. `stiffness`, 1e-6 … 1e6: a stiffer blob stays rounder. A blob at
  /// rest under gravity loses about 2 · gravity / stiffness of its height.
  Blob(Vector where, double radius, double mass = 1, double stiffness = 1);
};

}  // namespace df

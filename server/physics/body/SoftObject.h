// Objects that give way: rope, cloth, blob, beam.
//
//   PM.setGravity(df::Vector(0, 0.02));
//   auto *p_blob = new df::Blob(df::Vector(20, 5), 3);              // radius: 3 widths of a cell
//   auto *p_rope = new df::Rope(df::Vector(10, 4), df::Vector(30, 4));
//   p_rope->pin(0);
//   p_rope->pin(p_rope->getNodeCount() - 1);
//   p_rope->attach(10, p_crate);
//
// A soft body consists of nodes, points with mass, and what holds them together. Its position is its centre
// of mass, its velocity that of the centre, its box goes around it; setting position or velocity moves the
// whole, pins too. It hits HARD bodies and HARD Objects and other soft bodies, and both sides get an
// EventCollision, once when a contact begins, and on request by an EventContactEnd. The book's moves pass
// through it: it is SPECTRAL.
//
// Units: positions in cells, lengths in widths of a cell, times in ticks, mass in the game's unit. The
// stiffness is given as an acceleration (widths of a cell per tick²), so that it does not depend on the mass.
//
// Setters return 0, or -1 for numbers that are not finite or out of range: then nothing changes, and the
// world counts it (WorldLog::refusals). A constructor counts it too, and takes its default instead.
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

/// What ropes, cloths, blobs and beams have in common.
class SoftBody : public Object {
 public:
  SoftBody(const SoftBody&) = delete;
  SoftBody& operator=(const SoftBody&) = delete;
  ~SoftBody() override;

  /// In the game's unit.
  double getMass() const;
  /// Factor of the world's gravity (PM.setGravity), −1e6 … 1e6; 1 by default.
  int setGravityScale(double scale);
  /// Coulomb's µ, 0 … 1e6; 0.5 by default. Of two bodies the geometric mean counts.
  int setFriction(double friction);
  /// Drag: speeds fall as exp(-drag · ticks). 0 … 1e6 per tick, 0.02 by default.
  int setDrag(double drag);

  /// Change the velocity of the whole at once, by impulse / mass. Mass · cells per tick, to ±1e9.
  int applyImpulse(Vector impulse);
  /// The same for one node alone.
  int applyImpulse(int node, Vector impulse);
  /// Push the whole during the next tick, each node by its mass; several pushes add up, to ±1e9. Mass · cells
  /// per tick².
  int applyForce(Vector force);
  /// The same for one node alone. For a lasting force, apply it in each tick.
  int applyForce(int node, Vector force);

  /// Does it get an EventContactEnd when a contact ends? Off by default.
  void setContactEnds(bool contact_ends = true) { m_has_contact_ends = contact_ends; }
  bool hasContactEnds() const { return m_has_contact_ends; }

  // Its nodes: 0 … getNodeCount() - 1.

  /// How many nodes it has; they are numbered from 0.
  int getNodeCount() const;
  /// In cells, and in cells per tick; (0,0) if there is no such node.
  Vector getNodePosition(int node) const;
  Vector getNodeVelocity(int node) const;
  /// The node that is nearest to a point; -1 for a point out of range.
  int getNearestNode(Vector where) const;
  /// Hold a node where it is, whatever pulls at it; or release it.
  int pin(int node, bool pinned = true);
  bool isPinned(int node) const;
  /// Join a node to the point of a body where it is now; it pulls at both. The two do not collide with each
  /// other. It ends when the body does. A node has at most one body: the last one.
  int attach(int node, Body* p_body);
  /// -1 also if it was not attached.
  int detach(int node);

  // Dragging, as a mouse does: the node that is nearest to a point follows a target, with at most `strength`
  // as force.

  /// Take the node nearest to `where` (cells); `strength` is the greatest force. Return 0, else -1.
  int grab(Vector where, double strength);
  /// At first where it was grabbed. -1 if nothing is grabbed.
  int dragTo(Vector target);
  void release();          ///< Let go; nothing if nothing is grabbed.
  bool isGrabbed() const;  ///< Is a node?

  /// Is it in quarantine, because its motion has no finite solution? It stands and collides with nothing
  /// until its position or velocity is set; then it is back in the shape in which it was made.
  bool isFrozen() const;
  /// Has it come to rest? It costs next to nothing until something touches or changes it.
  bool isAsleep() const;

  /// As its lines (OUTLINE), with what they enclose (FILL), or not at all. `ch`: of what characters; 0: by
  /// the direction of the line, and # for a filling. Return 0, else -1.
  int setDrawing(BodyDrawing drawing, char32_t ch = 0, Color color = COLOR_DEFAULT);
  int draw() override;

 protected:
  /// For kinds of soft bodies: an Object without nodes; then make() once.
  SoftBody();
  void make(const naiad::physics::SoftBody& body);
  /// `value`, or, counted as refused, `usual` if it does not lie within the limits.
  double checked(const char* what, double value, double least, double most, double usual) const;
  Vector checked(const char* what, Vector position) const;

 private:
  bool hasNode(int node) const { return node >= 0 && node < getNodeCount(); }
  naiad::physics::SoftEntry& entry() const;
  const naiad::physics::SoftBody& body() const;
  template <class Change>
  int change(Change change);
  void absorb() const;
  int refuseAs(const char* what) const;

  std::shared_ptr<naiad::physics::SoftTable> m_table;
  std::shared_ptr<naiad::physics::SoftDrawn> m_drawn;
  int m_id = -1;  ///< in the table
  bool m_has_contact_ends = false;
};

/// From `from` to `to`, hanging free: pin() its ends.
class Rope : public SoftBody {
 public:
  /// `stiffness`, 1e-6 … 1e6: hung up, it is longer by about gravity / (2 · stiffness) of its length.
  /// `links` 0: as its length asks for; to 200.
  Rope(Vector from, Vector to, double mass = 1, double stiffness = 20, int links = 0);
};

/// Between `from` and `to`. It keeps its angle at a pinned node only with a second pin, or if it is clamped.
class Beam : public SoftBody {
 public:
  /// `stiffness`, 1e-6 … 1e6: clamped at `from`, its own weight bends it by gravity / stiffness of its
  /// length; its bending stiffness EI is stiffness · mass · length² / 8. `elements` 0: as its length asks
  /// for; else 2 … 100.
  Beam(Vector from, Vector to, double mass = 1, double stiffness = 1, bool is_clamped = false,
       int elements = 0);
};

/// A piece of cloth, seen from the front. Hang it up by its nodes.
class Cloth : public SoftBody {
 public:
  /// `width` and `height` in cells, 0.5 … 1000. `stiffness`, 1e-6 … 1e6: hung up, it is longer by about
  /// gravity / (2 · stiffness) of its height. `columns` and `rows` of threads, 2 … 128; 0: as its size asks
  /// for, at most 25. Above some 25 × 25 the body is moved by another method, whose cost grows with the
  /// number of nodes (docs/physics/soft.md). If they are given, threads are taut once they are 3 % longer
  /// than at rest (or 0.15 / stiffness, if that is more), so that the corners that a cloth hangs on bear it.
  Cloth(Vector corner, double width, double height, double mass = 1, double stiffness = 5, int columns = 0,
        int rows = 0);
  /// Threads across and down, one more than meshes.
  int getColumns() const { return m_columns; }
  int getRows() const { return m_rows; }
  /// The node where column and row meet, both from 0 on, from the upper left corner; -1 if there is none.
  int getNode(int column, int row) const;

 private:
  int m_columns = 0;
  int m_rows = 0;
  bool m_is_upright = false;
};

/// A skin full of gas.
class Blob : public SoftBody {
 public:
  /// `radius` in widths of a cell, 0.1 … 1000. `stiffness`, 1e-6 … 1e6: the more, the rounder it stays; at
  /// rest under gravity it is flatter by about 2 · gravity / stiffness of its height.
  Blob(Vector where, double radius, double mass = 1, double stiffness = 1);
};

}  // namespace df

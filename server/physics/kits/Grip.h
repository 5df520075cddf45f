// Lets a pointer grab, drag and release a body, rigid or soft.
//
//   m_grip.grab(event.getMousePosition());    // what lies there
//   m_grip.dragTo(event.getMousePosition());  // as the mouse moves
//   m_grip.release();                         // it flies on as fast as it was dragged
//
// A Body is held by a mouse joint, a SoftBody by its nearest node, until the grip or body is destroyed.
#pragma once

#include "BodyJoint.h"
#include "Ref.h"
#include "Vector.h"

namespace df {

class SoftBody;

class Grip {
 public:
  /// Maximum pull in cells per tick², independent of the body's mass.
  static constexpr double kUsualStrength = 3;

  Grip() = default;
  Grip(const Grip&) = delete;
  Grip& operator=(const Grip&) = delete;
  ~Grip() { release(); }

  /// Releases the held body and grabs the first Body or SoftBody at `where` (cells), as seen by the player
  /// whose input is being handled (WM.objectsSeenAt). `strength` > 0 is the maximum force over mass, in cells
  /// per tick². Skips soft bodies that another grip holds. Returns 0, or -1 if nothing is there or a number
  /// is out of range.
  int grab(Vector where, double strength = kUsualStrength);
  /// Pulls the body towards `where`. Returns 0, or -1 if nothing is held or the place is out of range.
  int dragTo(Vector where);
  void release();          ///< Does nothing if nothing is held.
  bool isHolding() const;  ///< True if it holds a body that still exists.

 private:
  Joint m_joint;
  Ref<SoftBody> m_soft;
};

}  // namespace df

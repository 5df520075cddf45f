// A pointer's hold on a body, rigid or soft: grab, drag, release.
//
//   m_grip.grab(event.getMousePosition());    // what lies there
//   m_grip.dragTo(event.getMousePosition());  // as the mouse moves
//   m_grip.release();                         // it flies on as fast as it was dragged
//
// A Body is held by a mouse joint, a SoftBody by its nearest node. The grip releases it when the grip is
// destroyed, and when the body is.
#pragma once

#include "BodyJoint.h"
#include "Ref.h"
#include "Vector.h"

namespace df {

class SoftBody;

class Grip {
 public:
  /// A pull of 3 cells per tick² on what it holds, whatever its mass.
  static constexpr double kUsualStrength = 3;

  Grip() = default;
  Grip(const Grip&) = delete;
  Grip& operator=(const Grip&) = delete;
  ~Grip() { release(); }

  /// Releases what it holds, and takes hold of the first Body or SoftBody at `where` (cells), in the state
  /// that the player saw whose input is handled (WM.objectsSeenAt). `strength` > 0: the greatest force over
  /// mass, in cells per tick². A soft body that another grip holds is skipped. Return 0, else -1: nothing is
  /// there, or a number is out of range.
  int grab(Vector where, double strength = kUsualStrength);
  /// Pulls it towards `where`. Return 0, else -1: nothing is held, or the place is out of range.
  int dragTo(Vector where);
  void release();          ///< Let go; nothing if it holds nothing.
  bool isHolding() const;  ///< Does it hold a body that is there?

 private:
  Joint m_joint;
  Ref<SoftBody> m_soft;
};

}  // namespace df

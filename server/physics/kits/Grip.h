// What a pointer holds, be it rigid or soft: grab, drag, let go.
//
//   m_grip.grab(event.getMousePosition());    // what lies there
//   m_grip.dragTo(event.getMousePosition());  // as the mouse moves
//   m_grip.release();                         // it flies on as fast as it was dragged
//
// A body hangs on a mouse joint, a soft body by its node that is nearest. It lets go when it is destroyed,
// and by itself when what it holds is gone.
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

  /// Lets go, and takes hold of the first Body or SoftBody at `where`, as the player saw it whose input is
  /// handled (WM.objectsSeenAt). `strength` > 0 per mass: cells per tick². A soft body that somebody else
  /// drags is left to him. Return 0, else -1: nothing is there, or a number is out of range.
  int grab(Vector where, double strength = kUsualStrength);
  /// Where it is to go. -1 if nothing is held, or the place is out of range.
  int dragTo(Vector where);
  void release();
  bool isHolding() const;

 private:
  Joint m_joint;
  Ref<SoftBody> m_soft;
};

}  // namespace df

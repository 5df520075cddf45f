// Sends the saucers: a few without pilots, more per pilot, and more the longer the pilots survive. There is
// an upper limit, so that the game never becomes hopeless.
#pragma once

#include "Object.h"
#include "ObjectList.h"

class Spawner : public df::Object {
 public:
  /// Fills the sky with the first saucers.
  Spawner();

  int eventHandler(const df::Event* p_e) override;

 private:
  void step(int tick);
  /// Removes a saucer that is not visible at the moment, after pilots have left.
  static void retireOne(const df::ObjectList& saucers);

  int m_level = 0;  // saucers in addition to the initial number per pilot
};

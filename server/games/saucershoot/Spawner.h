// Makes the saucers: a few without pilots, more for each pilot, and more the longer the pilots survive. There
// is an upper limit, so that the game never becomes hopeless.
#pragma once

#include "Object.h"
#include "ObjectList.h"

class Spawner : public df::Object {
 public:
  /// Makes the first saucers, all over the sky.
  Spawner();

  int eventHandler(const df::Event* p_e) override;

 private:
  void step(int tick);
  /// After pilots have left, removes a saucer that is not on the screen at the moment.
  static void retireOne(const df::ObjectList& saucers);

  int m_level = 0;  // number of saucers in addition to those for each pilot
};

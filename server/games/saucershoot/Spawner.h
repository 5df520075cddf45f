// Sends in the saucers: a few when nobody flies, more for every pilot, and more and more the
// longer the pilots survive. There is always an upper limit, so it never gets hopeless.
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
  /// Pilots have left: take back a saucer that nobody can see at the moment.
  static void retireOne(const df::ObjectList& saucers);

  int m_level = 0;  // saucers more than the pilots began with
};

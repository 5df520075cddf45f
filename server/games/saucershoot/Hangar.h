// Gives everybody who joins a ship.
#pragma once

#include "Object.h"

class Hangar : public df::Object {
 public:
  Hangar();
  int eventHandler(const df::Event* p_e) override;
};

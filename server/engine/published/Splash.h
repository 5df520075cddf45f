// The published engine's first picture, its name. Here no player has joined at that time (utility.h,
// splash()), so it shows nothing and is deleted in the first step.
#pragma once

#include "EventStep.h"
#include "Object.h"
#include "Sprite.h"

namespace df {

class Splash : public Object {
 public:
  Splash();
  int eventHandler(const Event* p_e) override;
};

}  // namespace df

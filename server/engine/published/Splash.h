// The published engine's first picture, which shows its name. In Naiad no player has joined at that time (see
// splash()), so this Object shows nothing and is deleted in the first step.
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

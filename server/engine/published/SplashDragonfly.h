// The dragonfly in the published engine's first picture (Splash.h).
#pragma once

#include "EventStep.h"
#include "Object.h"
#include "Splash.h"
#include "Vector.h"

namespace df {

class SplashDragonfly : public Splash {
 public:
  explicit SplashDragonfly(Vector /*end_position*/) {}
};

}  // namespace df

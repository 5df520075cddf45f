// GraphicsManager: the DisplayManager's name in older versions of the published engine.
#pragma once

#include "DisplayManager.h"

namespace df {

using GraphicsManager = DisplayManager;

}  // namespace df

// Makes a failing scene smaller.
#pragma once

#include "Judges.h"

namespace hunt {

/// Returns a smaller scene in which the judge still finds a violation: without elements and actions that it
/// does not need, shorter, and with simpler numbers. Tries at most `tries` scenes.
SceneData shrink(const SceneData& scene, const Judge& judge, int tries);

}  // namespace hunt

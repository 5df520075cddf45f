// Makes a failing scene smaller, and prints it as a program.
#pragma once

#include <string>

#include "Judges.h"

namespace hunt {

/// Returns a smaller scene in which the judge still finds a violation: without elements and actions that it
/// does not need, shorter, and with simpler numbers. Tries at most `tries` scenes.
SceneData shrink(const SceneData& scene, const Judge& judge, int tries);

/// Returns a program that builds the scene through the public API and prints the bodies' states in each tick.
std::string programOf(const SceneData& scene, const std::string& comment);

}  // namespace hunt

// Judges that run a scene again in another form and compare.
#pragma once

#include <optional>

#include "Judges.h"

namespace hunt {

bool appliesIsolation(const Trial& trial);
std::optional<Finding> findIsolation(const Trial& trial);
bool appliesLevels(const Trial& trial);
std::optional<Finding> findLevels(const Trial& trial);
bool appliesRebuild(const Trial& trial);
std::optional<Finding> findRebuild(const Trial& trial);
bool appliesTiles(const Trial& trial);
std::optional<Finding> findTiles(const Trial& trial);
std::optional<Finding> findOpening(const Trial& trial);

}  // namespace hunt

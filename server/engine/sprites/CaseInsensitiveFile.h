// Finds files by names as on systems that separate folders by backslashes and ignore case.
#pragma once

#include <string>

namespace df {

/// The file in `folder` (empty: the working directory) that `name`, a path relative to it, means there: a
/// backslash parts folders, letters of ASCII count without their case. Of several, the one that comes first
/// by name; empty if there is none.
std::string findLoosely(const std::string& folder, const std::string& name);

}  // namespace df

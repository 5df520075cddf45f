// The name that somebody meant who typed another one.
#pragma once

#include <string>
#include <vector>

namespace naiad {

/// The name that `typed` is the beginning of or takes the fewest changes to become: a character inserted,
/// left out, replaced, or two swapped. Empty if that would be more than a third of it.
std::string nearestName(const std::string& typed, const std::vector<std::string>& names);

}  // namespace naiad

// Variables of the environment that are misspelt: they would be ignored without notice.
#pragma once

#include <string>
#include <vector>

namespace naiad {

/// A sentence for each variable that begins with `prefix` and is none of `known`, with the nearest of these.
/// `p_environment`: entries NAME=VALUE, and a null at the end.
std::vector<std::string> complainOfUnknownVariables(const char* const* p_environment,
                                                    const std::string& prefix,
                                                    const std::vector<std::string>& known);

}  // namespace naiad

// Variables of the environment that are spelt wrongly: nothing would come of them, and nobody would notice.
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

#include "shared/options/UnknownVariables.h"

#include <algorithm>
#include <string_view>

#include "shared/options/NearestName.h"

namespace naiad {

std::vector<std::string> complainOfUnknownVariables(const char* const* p_environment,
                                                    const std::string& prefix,
                                                    const std::vector<std::string>& known) {
  std::vector<std::string> sentences;
  for (; *p_environment != nullptr; ++p_environment) {
    const std::string_view entry(*p_environment);
    const std::string name(entry.substr(0, entry.find('=')));
    if (!name.starts_with(prefix) || std::find(known.begin(), known.end(), name) != known.end()) continue;
    const std::string near = nearestName(name, known);
    sentences.push_back("there is no variable " + name +
                        (near.empty() ? "" : "; did you mean " + near + "?"));
  }
  return sentences;
}

}  // namespace naiad

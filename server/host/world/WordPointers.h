// Words as posix_spawn() takes them: arguments, an environment.
#pragma once

#include <string>
#include <vector>

namespace naiad {

/// One pointer into each word, and a null one at the end. Valid as long as `words` is and stays as it is.
inline std::vector<char*> pointersTo(std::vector<std::string>& words) {
  std::vector<char*> pointers;
  pointers.reserve(words.size() + 1);
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  return pointers;
}

}  // namespace naiad

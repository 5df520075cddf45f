// Arguments and environments in the form for posix_spawn().
#pragma once

#include <string>
#include <vector>

namespace naiad {

/// Returns a pointer to each word, then a null one. Valid as long as `words` is unchanged.
inline std::vector<char*> argvPointers(std::vector<std::string>& words) {
  std::vector<char*> pointers;
  pointers.reserve(words.size() + 1);
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  return pointers;
}

}  // namespace naiad

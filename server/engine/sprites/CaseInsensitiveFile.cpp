#include "engine/sprites/CaseInsensitiveFile.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

namespace df {

namespace {

namespace fs = std::filesystem;

bool sameButForCase(const std::string& a, const std::string& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

// What is called `name` in the folder, as it is or but for case.
std::vector<fs::path> matches(const fs::path& folder, const std::string& name) {
  std::error_code error;
  if (name == "." || name == "..") return {folder / name};
  std::vector<fs::path> found;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder.empty() ? "." : folder, error)) {
    const std::string called = entry.path().filename().string();
    if (sameButForCase(called, name)) found.push_back(folder / called);
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace

std::string findLoosely(const std::string& folder, const std::string& name) {
  std::string slashed = name;
  std::replace(slashed.begin(), slashed.end(), '\\', '/');
  std::vector<fs::path> candidates = {folder};
  for (const fs::path& part : fs::path(slashed)) {
    std::vector<fs::path> next;
    for (const fs::path& candidate : candidates) {
      const std::vector<fs::path> found = matches(candidate, part.string());
      next.insert(next.end(), found.begin(), found.end());
    }
    candidates = std::move(next);
  }
  const auto file = std::find_if(candidates.begin(), candidates.end(), [](const fs::path& path) {
    std::error_code error;
    return fs::is_regular_file(path, error);
  });
  return file == candidates.end() ? std::string() : file->string();
}

}  // namespace df

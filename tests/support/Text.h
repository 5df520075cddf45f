// What a test looks for in texts and files.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

namespace naiad::test {

/// Is this part in the text? Where a test expects the contrary, both are printed.
inline testing::AssertionResult has(std::string_view text, std::string_view part) {
  const bool found = text.find(part) != text.npos;
  return testing::AssertionResult(found) << '"' << part << (found ? "\" is in: " : "\" is not in: ") << text;
}

/// How often this part is in the text.
inline int countIn(std::string_view text, std::string_view part) {
  int count = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != text.npos; at += part.size()) ++count;
  return count;
}

/// All bytes of a file; empty if there is none.
inline std::string contentOf(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace naiad::test

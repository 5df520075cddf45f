// Compares build ids with the results of the linker's own tools for the same files.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <string>

#include "host/world/BuildId.h"
#include "tests/support/RunProgram.h"

namespace naiad {
namespace {

TEST(BuildId, MatchesTheLibraryFile) {
  const std::string& id = ownBuildId();
  ASSERT_GE(id.size(), 2 * kShownBuildId);
  ASSERT_LE(id.size(), kMaxBuildId);
  EXPECT_TRUE(std::ranges::all_of(id, [](unsigned char c) { return std::isxdigit(c) != 0; })) << id;
  const auto [code, notes] =
      test::runProgram("readelf -n '" NAIAD_BINARY_DIR "/../lib/libdragonfly.so' 2>/dev/null");
  if (code != 0) GTEST_SKIP() << "there is no readelf";
  EXPECT_NE(notes.find("Build ID: " + id), std::string::npos) << notes;
}

TEST(BuildId, IsFoundByTheFilesName) {
  EXPECT_EQ(buildIdOf("libdragonfly.so"), ownBuildId());
  EXPECT_NE(buildIdOf("libc.so"), ownBuildId());
  EXPECT_EQ(buildIdOf("libnothing.so"), "");
}

}  // namespace
}  // namespace naiad

#include <gtest/gtest.h>

#include "shared/program/BuildId.h"
#include "tests/support/RunProgram.h"

namespace naiad {
namespace {

TEST(BuildId, OfALoadedLibraryIsThatOfItsBuild) {
  const std::string id = buildIdOf("libc.so");
  EXPECT_EQ(id.size(), 40u);  // SHA-1
  EXPECT_EQ(id.find_first_not_of("0123456789abcdef"), std::string::npos) << id;
  EXPECT_NE(id, buildIdOf("libstdc++.so"));
}

TEST(BuildId, OfTheLibraryIsWhatItsFileSays) {
  ASSERT_GE(ownBuildId().size(), 2 * kShownBuildId);
  const auto [code, notes] =
      test::runProgram("readelf -n '" NAIAD_BINARY_DIR "/../lib/libdragonfly.so' 2>/dev/null");
  if (code != 0) GTEST_SKIP() << "there is no readelf";
  EXPECT_NE(notes.find("Build ID: " + ownBuildId()), std::string::npos) << notes;
}

TEST(BuildId, OfAFileThatIsNotLoadedIsEmpty) {
  EXPECT_EQ(buildIdOf("libnosuch.so"), "");
}

}  // namespace
}  // namespace naiad

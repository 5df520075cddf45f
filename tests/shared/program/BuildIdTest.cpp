#include <gtest/gtest.h>

#include "shared/program/BuildId.h"

namespace naiad {
namespace {

TEST(BuildId, OfALoadedLibraryIsThatOfItsBuild) {
  const std::string id = buildIdOf("libc.so");
  EXPECT_EQ(id.size(), 40u);  // SHA-1
  EXPECT_EQ(id.find_first_not_of("0123456789abcdef"), std::string::npos) << id;
  EXPECT_NE(id, buildIdOf("libstdc++.so"));
}

TEST(BuildId, OfAFileThatIsNotLoadedIsEmpty) {
  EXPECT_EQ(buildIdOf("libnosuch.so"), "");
}

}  // namespace
}  // namespace naiad

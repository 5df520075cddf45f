#include <gtest/gtest.h>

#include <filesystem>
#include <stdexcept>

#include "shared/program/PublishedFile.h"
#include "tests/support/TempFolder.h"
#include "tests/support/Text.h"
#include "tests/support/WaitUntil.h"

namespace naiad {
namespace {

namespace fs = std::filesystem;

TEST(PublishedFile, IsWrittenAndRemovedOnDestruction) {
  const test::TempFolder home;
  const std::string path = home / "status.json";
  {
    PublishedFile file("status file", path, "one");
    EXPECT_EQ(test::contentOf(path), "one");
    file.setText("two");
    EXPECT_TRUE(test::waitUntil([&] { return test::contentOf(path) == "two"; }));
    EXPECT_EQ(file.popLogMessage(), "");
  }
  EXPECT_FALSE(fs::exists(path));
  EXPECT_THROW(PublishedFile("list", home / "none" / "list", ""), std::runtime_error);
}

TEST(PublishedFile, FailureAndRecoveryAreReportedOnce) {
  const test::TempFolder home;
  const std::string folder = home / "folder";
  const std::string path = folder + "/list";
  fs::create_directory(folder);
  PublishedFile file("list", path, "one");
  std::string said;
  const auto says = [&](const std::string& text) {
    file.setText("two");
    said += file.popLogMessage();
    return said.find(text) != std::string::npos;
  };
  fs::rename(folder, folder + "2");
  EXPECT_TRUE(test::waitUntil([&] { return says("warning: the list " + path + " cannot be written: "); }));
  fs::rename(folder + "2", folder);
  EXPECT_TRUE(test::waitUntil([&] { return says("the list " + path + " can be written again"); }));
  EXPECT_EQ(test::contentOf(path), "two");
  EXPECT_EQ(said.find("warning"), said.rfind("warning"));
}

}  // namespace
}  // namespace naiad

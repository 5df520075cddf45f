// Headers and functions that games made on Windows use.

#include <conio.h>
#include <direct.h>
#include <windows.h>

#include <filesystem>

#include "engine/prelude/Microsoft.h"
#include "engine/published/Windows.h"
#include "tests/server/engine/Probe.h"

namespace df::test {
namespace {

TEST(Microsoft, StringFunctionsTruncateInsteadOfOverrunning) {
  char text[8];
  EXPECT_EQ(sprintf_s(text, "%d lives", 3), 7);
  EXPECT_STREQ(text, "3 lives");
  sprintf_s(text, _countof(text), "%d points", 1000);
  EXPECT_STREQ(text, "1000 po");
  EXPECT_EQ(strcpy_s(text, "ann"), 0);
  EXPECT_STREQ(text, "ann");
  strcpy_s(text, sizeof(text), "a long name");
  EXPECT_STREQ(text, "a long ");
  strcpy_s(text, "ann");
  strcat_s(text, " and");
  EXPECT_STREQ(text, "ann and");
  strcat_s(text, " bob");
  EXPECT_STREQ(text, "ann and");
  strcat_s(text, sizeof(text), "");
  EXPECT_STREQ(text, "ann and");
}

using Windows = WorldTest;

TEST_F(Windows, TickCountFollowsGameTime) {
  const DWORD before = GetTickCount();
  Sleep(1000);
  EXPECT_EQ(GetTickCount(), before);
  GM.tick();
  EXPECT_EQ(GetTickCount(), before + 33);
}

TEST_F(Windows, KeyFunctionsReportNoKey) {
  EXPECT_EQ(GetAsyncKeyState('A'), 0);
  EXPECT_FALSE(_kbhit());
  EXPECT_EQ(max(1, 2), 2);
}

TEST(Microsoft, FileOpenFailureReturnsTheErrorCode) {
  std::FILE* p_file = stdin;
  EXPECT_EQ(fopen_s(&p_file, "/nowhere/scores.txt", "r"), ENOENT);
  EXPECT_EQ(p_file, nullptr);
  ASSERT_EQ(fopen_s(&p_file, "/dev/null", "r"), 0);
  std::fclose(p_file);
}

TEST(Microsoft, ReturnsTheLocalTime) {
  const std::time_t noon = 1000000000;
  std::tm local{};
  EXPECT_EQ(localtime_s(&local, &noon), 0);
  EXPECT_EQ(std::mktime(&local), noon);
}

TEST(Microsoft, ReturnsTheWorkingDirectory) {
  char path[4096];
  ASSERT_NE(_getcwd(path, sizeof(path)), nullptr);
  EXPECT_EQ(std::string(path), std::filesystem::current_path().string());
}

}  // namespace
}  // namespace df::test

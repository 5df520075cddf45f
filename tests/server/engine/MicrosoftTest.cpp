// What games made on Windows include and call, as they do.

#include <conio.h>
#include <direct.h>
#include <gtest/gtest.h>
#include <windows.h>

#include <filesystem>
#include <string>

#include "Microsoft.h"
#include "Probe.h"
#include "Windows.h"

namespace df::test {
namespace {

TEST(Microsoft, TextNeverOverruns) {
  char text[8];
  EXPECT_EQ(sprintf_s(text, "%d lives", 3), 7);
  EXPECT_STREQ(text, "3 lives");
  sprintf_s(text, _countof(text), "%d points", 1000);
  EXPECT_STREQ(text, "1000 po");
  EXPECT_EQ(strcpy_s(text, "ann"), 0);
  EXPECT_STREQ(text, "ann");
  strcpy_s(text, sizeof(text), "a long name");
  EXPECT_STREQ(text, "a long ");
}

using Windows = WorldTest;

TEST_F(Windows, TimeIsTheGames) {
  const DWORD before = GetTickCount();
  Sleep(1000);
  EXPECT_EQ(GetTickCount(), before);
  GM.tick();
  EXPECT_EQ(GetTickCount(), before + 33);
}

TEST_F(Windows, NoKeyIsDown) {
  EXPECT_EQ(GetAsyncKeyState('A'), 0);
  EXPECT_FALSE(_kbhit());
  EXPECT_EQ(max(1, 2), 2);
}

TEST(Microsoft, KnowsTheWorkingDirectory) {
  char path[4096];
  ASSERT_NE(_getcwd(path, sizeof(path)), nullptr);
  EXPECT_EQ(std::string(path), std::filesystem::current_path().string());
}

}  // namespace
}  // namespace df::test

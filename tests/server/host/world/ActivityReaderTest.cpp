#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "host/world/ActivityReader.h"

namespace naiad {
namespace {

std::string classOfName(const char* p_mangled) {
  return std::string(classInMangled(p_mangled));
}

TEST(ActivityReader, ExtractsTheClassFromAMangledName) {
  EXPECT_EQ(classOfName("9EventStep"), "EventStep");
  EXPECT_EQ(classOfName("N2df9EventStepE"), "EventStep");
  EXPECT_EQ(classOfName("N12_GLOBAL__N_14ShipE"), "Ship");
  EXPECT_EQ(classOfName("*N12_GLOBAL__N_14ShipE"), "Ship");
  EXPECT_EQ(classOfName("12PlayerObjectIN2df6ObjectEE"), "PlayerObject");
  EXPECT_EQ(classOfName("Z4mainE4Ship"), "Ship");
  for (const char* p_strange : {"", "N", "Z", "99x", "4Sh", "St9exception", "99999999999999999999999x"})
    EXPECT_EQ(classOfName(p_strange), p_strange);
}

TEST(ActivityReader, DescribesTheRunningHandler) {
  const auto page = std::make_unique<df::ActivityPage>();
  EXPECT_TRUE(describeActivity(*page, "handled").empty());
  page->addName(16, "4Ship");
  page->addName(24, "N2df9EventStepE");
  page->now.object_class = 16;
  page->now.event_class = 24;
  EXPECT_EQ(describeActivity(*page, "handles").view(), ", while Ship handles EventStep");
  page->now.event_class = df::Activity::kDraw;
  EXPECT_EQ(describeActivity(*page, "handled").view(), ", while Ship ran draw()");
  page->now.object_class = 4711;
  page->now.event_class = 4712;
  EXPECT_EQ(describeActivity(*page, "handled").view(), ", while an Object of unknown class handled an event");
}

TEST(ActivityReader, FullNameTableKeepsItsClasses) {
  const auto page = std::make_unique<df::ActivityPage>();
  for (std::uintptr_t id = 1; id <= df::ActivityPage::kNames + 10; ++id)
    page->addName(8 * id, ("5C" + std::to_string(1000 + id)).c_str());
  page->now.event_class = df::Activity::kDraw;
  for (std::uintptr_t id = 1; id <= df::ActivityPage::kNames; ++id) {
    page->now.object_class = 8 * id;
    EXPECT_EQ(describeActivity(*page, "").view(), ", while C" + std::to_string(1000 + id) + " ran draw()");
  }
}

TEST(ActivityReader, KeepsTheLastLinesEscapedAndCapped) {
  const auto page = std::make_unique<df::ActivityPage>();
  EXPECT_TRUE(logLine(*page, 0).empty());
  for (int i = 0; i < 20; ++i) page->addLine("line " + std::to_string(i));
  EXPECT_EQ(logLine(*page, 0).view(), "line 19");
  EXPECT_EQ(logLine(*page, df::ActivityPage::kLines - 1).view(), "line 12");
  EXPECT_TRUE(logLine(*page, df::ActivityPage::kLines).empty());
  page->addLine("\033[2J\n\xc3\xa9");
  EXPECT_EQ(logLine(*page, 0).view(), "\\x1b[2J\\x0a\\xc3\\xa9");
  page->addLine(std::string(1000, 'x'));
  EXPECT_EQ(logLine(*page, 0).view(), std::string(160, 'x'));
  page->addLine(std::string(1000, '\x01'));
  EXPECT_EQ(logLine(*page, 0).view().size(), 512u);
}

}  // namespace
}  // namespace naiad

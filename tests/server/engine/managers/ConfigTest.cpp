#include "engine/managers/Config.h"
#include "engine/managers/DisplayManager.h"
#include "tests/server/engine/Probe.h"

namespace df::test {
namespace {

using ConfigTest = WorldTest;

Config& config() {
  return Config::getInstance();
}

TEST_F(ConfigTest, DefaultsMatchPublishedDragonfly) {
  EXPECT_EQ(config().getWindowHorizontalChars(), 80);
  EXPECT_EQ(config().getWindowVerticalChars(), 24);
  EXPECT_EQ(config().getFrameTime(), 33);
  EXPECT_EQ(GM.getFrameTime(), 33);
  EXPECT_EQ(config().getWindowBackgroundColor(), BLACK);
  EXPECT_FALSE(config().getHeadless());
  EXPECT_EQ(DM.getHorizontalPixels(), 1024);
  EXPECT_FLOAT_EQ(charHeight(), 32);
  EXPECT_EQ(pixelsToSpaces(spacesToPixels(Vector(3, 4))), Vector(3, 4));
}

TEST_F(ConfigTest, ReadsPairsAcrossLinesAndBlanks) {
  config().loadConfig(
      "window_horizontal_chars:100,\nwindow_vertical_chars : 40 ,\r\nwindow_background_color:blue,\n"
      "frame_time:50,headless:true,random_seed:7,logfile:my.log,own_key:x");
  EXPECT_EQ(DM.getHorizontal(), 100);
  EXPECT_EQ(DM.getVertical(), 40);
  EXPECT_EQ(WM.getBoundary(), Box(Vector(), 100, 40));
  EXPECT_EQ(config().getWindowBackgroundColor(), BLUE);
  EXPECT_EQ(GM.getFrameTime(), 50);
  EXPECT_TRUE(config().getHeadless());
  EXPECT_EQ(config().getRandomSeed(), 7);
  EXPECT_EQ(config().getLogFile(), "my.log");
  EXPECT_EQ(config().match("own_key"), "x");
  EXPECT_FALSE(world.compat());
  config().loadConfig("compat:true,");
  EXPECT_TRUE(world.compat());
}

TEST_F(ConfigTest, InvalidValuesAreLoggedAndIgnored) {
  config().loadConfig(
      "window_horizontal_chars:wide,frame_time:-3,headless:maybe,window_background_color:pink,"
      "window_vertical_chars:5000,");
  EXPECT_EQ(DM.getHorizontal(), 80);
  EXPECT_EQ(DM.getVertical(), 24);
  EXPECT_EQ(GM.getFrameTime(), 33);
  EXPECT_EQ(logged("is invalid and ignored"), 4);
  EXPECT_EQ(logged("invalid window of 80 by 5000"), 1);
}

TEST_F(ConfigTest, OnlyMisspeltKeysAreReported) {
  const std::pair<const char*, const char*> cases[] = {
      {"windowhorizontal_chars:80,", "\"windowhorizontal_chars\"; did you mean window_horizontal_chars?"},
      {"headless:true,\n Frame_Time : 20,", "\"Frame_Time\"; did you mean frame_time?"},
      {"random_seed 7,", "\"random_seed7\"; did you mean random_seed?"},
      {"frame_time:20, # in ms\nheadless:true,", "a comma is missing before headless"},
      {"levles:3,", "\"levles\"; did you mean levels?"},
      {"levels:3,frame_time:20,window_style:1,", ""},
      {"port:9900,password:sesame,", ""}};  // keys of the host, which only programs read
  for (const auto& [text, expected] : cases) {
    lines.clear();
    world.log().clear();
    config().loadConfig(text);
    config().match("levels");  // a key of the game itself
    Config::reportUnknownKeys();
    EXPECT_EQ(lines.size(), *expected == '\0' ? 0u : 1u) << text << (lines.empty() ? "" : lines[0]);
    EXPECT_EQ(logged(expected), static_cast<int>(lines.size())) << text << (lines.empty() ? "" : lines[0]);
  }
}

TEST_F(ConfigTest, ConfiguredSeedReproducesRandomNumbers) {
  World other;
  other.setSeed(42);
  config().loadConfig("random_seed:42,");
  for (int i = 0; i < 5; ++i) EXPECT_EQ(world.randomInt(1000), other.randomInt(1000));
}

TEST_F(ConfigTest, BackgroundAndShakeAreInTheView) {
  world.store().setWatched(true);
  EXPECT_TRUE(DM.setBackgroundColor(GREEN));
  EXPECT_FALSE(DM.setBackgroundColor(CUSTOM));
  DM.shake(20, 20, 10);
  int shaken = 0;
  for (int i = 0; i < 10; ++i) {
    world.tick();
    const WorldView& view = world.picture().view();
    EXPECT_EQ(view.background, GREEN);
    EXPECT_LE(std::abs(view.shake_x), 2);
    EXPECT_LE(std::abs(view.shake_y), 1);
    shaken += view.shake_x != 0 || view.shake_y != 0 ? 1 : 0;
  }
  EXPECT_GT(shaken, 3);
  world.tick();
  EXPECT_EQ(world.picture().view().shake_x, 0);
  EXPECT_EQ(world.picture().view().shake_y, 0);
}

}  // namespace
}  // namespace df::test

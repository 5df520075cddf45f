// Sprite files that the published engine loads although the book's rules reject them. In compat mode they are
// loaded, with a log line.

#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "engine/managers/ResourceManager.h"
#include "engine/sprites/SpriteFile.h"
#include "tests/server/engine/Probe.h"

namespace df::test {
namespace {

std::string withHeader(const std::string& fields) {
  return "<HEADER>\nframes 2\nwidth 1\nheight 1\n" + fields +
         "</HEADER>\n<BODY>\na\nend\nb\nend\n</BODY>\n<FOOTER>\nversion 1\n</FOOTER>\n";
}

class PublishedSprite : public WorldTest {
 protected:
  PublishedSprite()
      : m_file(std::filesystem::path(::testing::TempDir()) /
               ("published-sprite-" + std::to_string(getpid()))) {}
  ~PublishedSprite() override { std::filesystem::remove(m_file); }

  /// Loads a file with this text; returns the result of RM.loadSprite().
  int load(const std::string& text, const std::string& label = "s") {
    std::ofstream(m_file) << text;
    return RM.loadSprite(m_file.string(), label);
  }
  /// Returns row 10 after each of `ticks` ticks, without blanks, with an Object of this sprite in it.
  std::string shownOf(const std::string& label, int ticks) {
    PlacedObject o(Vector(10, 10));
    o.setSprite(label);
    return shown(10, ticks);
  }

 private:
  std::filesystem::path m_file;
};

TEST_F(PublishedSprite, WithoutCompatInvalidHeadersAreRefused) {
  EXPECT_EQ(load(withHeader("slowdown -1\n")), -1);
  EXPECT_EQ(load(withHeader("slowdown\n")), -1);
  EXPECT_EQ(load(withHeader("transparency \" \"\n")), -1);
  EXPECT_EQ(RM.getSprite("s")->getLabel(), "missing");
}

TEST_F(PublishedSprite, TextAfterTheEndIsIgnoredWithAWarning) {
  const std::string old = "frames 1\nwidth 1\nheight 1\ncolor red\na\nend\neof\n";
  for (const std::string rest : {"\n\nmade by Ann\n", "<HEADER>\n", "x"}) {
    EXPECT_EQ(load(withHeader("") + rest), -1) << "by the book";
    EXPECT_EQ(load(old + rest), -1) << "by the book";
  }
  world.setCompat();
  for (const std::string rest : {"\n\nmade by Ann\n", "<HEADER>\n", "x"}) {
    for (const std::string& text : {withHeader(""), old}) {
      EXPECT_EQ(load(text + rest), 0) << text << rest;
      EXPECT_EQ(RM.getSprite("s")->getFrameCount(), text == old ? 1 : 2);
      RM.unloadSprite("s");
    }
  }
  EXPECT_EQ(logged(":17: unexpected \"made by Ann\" after the end of the sprite, ignored"), 1);
}

TEST_F(PublishedSprite, SlowdownMinusOneIsLoadedWithAWarning) {
  world.setCompat();
  ASSERT_EQ(load(withHeader("slowdown -1\n")), 0);
  EXPECT_EQ(RM.getSprite("s")->getSlowdown(), -1);
  EXPECT_EQ(logged(":5: slowdown should be 0 to 1000000, not -1"), 1);
  EXPECT_EQ(load(withHeader("slowdown -2\n"), "t"), -1);
}

TEST_F(PublishedSprite, SlowdownWithoutAValueIsZero) {
  world.setCompat();
  ASSERT_EQ(load(withHeader("slowdown\n")), 0);
  EXPECT_EQ(RM.getSprite("s")->getSlowdown(), 0);
  ASSERT_EQ(load(withHeader("slowdown \r\n"), "t"), 0);
  EXPECT_EQ(RM.getSprite("t")->getSlowdown(), 0);
  EXPECT_EQ(logged("slowdown has no number"), 2);
  // The file above in the old format.
  ASSERT_EQ(load("frames 1\nwidth 1\nheight 1\ncolor red\nslowdown\na\nend\neof\n", "old"), 0);
  EXPECT_EQ(RM.getSprite("old")->getFrame(0).getString(), "a");
}

TEST_F(PublishedSprite, AQuotedBlankMakesTheQuotationMarkTransparent) {
  world.setCompat();
  ASSERT_EQ(load(withHeader("transparency \" \"\n")), 0);
  EXPECT_EQ(RM.getSprite("s")->getTransparency(), '"');
  EXPECT_EQ(logged("transparency should be one character"), 1);
}

TEST_F(PublishedSprite, ValidFileGivesNoWarning) {
  world.setCompat();
  ASSERT_EQ(load(withHeader("slowdown 2\ntransparency #\n")), 0);
  EXPECT_EQ(RM.getSprite("s")->getSlowdown(), 2);
  EXPECT_TRUE(lines.empty());
  EXPECT_EQ(shownOf("s", 4), "aabb");
}

TEST_F(PublishedSprite, SlowdownZeroMinusOneAndMissingAdvanceEveryStep) {
  world.setCompat();
  ASSERT_EQ(load(withHeader("slowdown 0\n"), "zero"), 0);
  ASSERT_EQ(load(withHeader("slowdown -1\n"), "minus"), 0);
  ASSERT_EQ(load(withHeader(""), "missing"), 0);
  EXPECT_EQ(RM.getSprite("missing")->getSlowdown(), 0);
  EXPECT_EQ(shownOf("zero", 4), "abab");
  EXPECT_EQ(shownOf("minus", 4), "abab");
  EXPECT_EQ(shownOf("missing", 4), "abab");
}

TEST_F(PublishedSprite, GameMadeSpriteAdvancesAndMinusOneStopsIt) {
  world.setCompat();
  Sprite sprite(2);
  sprite.setWidth(1);
  sprite.setHeight(1);
  sprite.addFrame(Frame(1, 1, "a"));
  sprite.addFrame(Frame(1, 1, "b"));
  sprite.setSlowdown(0);
  Object o;
  o.setSprite(&sprite);
  world.tick();
  EXPECT_EQ(o.getSpriteIndex(), 1);
  o.setSpriteSlowdownCount(-1);
  world.tick();
  EXPECT_EQ(o.getSpriteIndex(), 1);
}

TEST_F(PublishedSprite, WithoutCompatSlowdownZeroStopsAndMissingIsOne) {
  ASSERT_EQ(load(withHeader("slowdown 0\n"), "zero"), 0);
  ASSERT_EQ(load(withHeader(""), "missing"), 0);
  EXPECT_EQ(RM.getSprite("missing")->getSlowdown(), 1);
  EXPECT_EQ(shownOf("zero", 4), "aaaa");
  EXPECT_EQ(shownOf("missing", 4), "abab");
}

}  // namespace
}  // namespace df::test

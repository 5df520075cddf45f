#include <regex>
#include <stdexcept>
#include <utility>

#include "engine/managers/ResourceManager.h"
#include "engine/sprites/SpriteFile.h"
#include "engine/world/WorldExtras.h"
#include "tests/server/engine/Probe.h"
#include "tests/support/Text.h"

namespace df::test {
namespace {

const std::string kFolder = std::string(NAIAD_SOURCE_DIR) + "/tests/server/engine/sprites/";

std::string troubleOf(const std::string& text) {
  std::string error;
  EXPECT_EQ(parseSprite(text, "s", error), nullptr);
  return error;
}

class SpriteFile : public WorldTest {
 protected:
  /// Parses a valid sprite. Throws if it is invalid.
  const Sprite& parsed(const std::string& text) {
    std::string error;
    sprites.push_back(parseSprite(text, "s", error));
    if (sprites.back() == nullptr) throw std::runtime_error(text + ": " + error);
    return *sprites.back();
  }

  std::vector<decltype(parseSprite("", "", std::declval<std::string&>()))> sprites;
};

TEST_F(SpriteFile, AllFormatsAreReadWithOrWithoutCarriageReturns) {
  struct Row {
    const char* name;
    int frames, width, height, slowdown;
    Color color;
    char transparency;
    const char* first_frame;
    const char* last_frame;
  };
  const Row kRows[] = {
      {"header.txt", 2, 3, 2, 4, CYAN, '#', "/-\\#o#", "\\-/ o "},
      {"header-crlf.txt", 2, 3, 2, 4, CYAN, '#', "/-\\#o#", "\\-/ o "},
      {"header-no-newline.txt", 1, 2, 1, 1, WHITE, '\0', "<>", "<>"},
      {"simple.txt", 3, 2, 1, 5, RED, '\0', "ab", "ef"},
      {"simple-crlf-no-newline.txt", 3, 2, 1, 5, RED, '\0', "ab", "ef"},
      {"old.txt", 2, 3, 1, 1, GREEN, '\0', "===", "=-="},
      {"old-crlf-no-newline.txt", 2, 3, 1, 1, GREEN, '\0', "===", "=-="},
  };
  for (const Row& row : kRows) {
    SCOPED_TRACE(row.name);
    ASSERT_EQ(RM.loadSprite(kFolder + row.name, row.name), 0);
    const Sprite* p_sprite = RM.getSprite(row.name);
    ASSERT_NE(p_sprite, nullptr);
    EXPECT_EQ(p_sprite->getFrameCount(), row.frames);
    EXPECT_EQ(p_sprite->getWidth(), row.width);
    EXPECT_EQ(p_sprite->getHeight(), row.height);
    EXPECT_EQ(p_sprite->getSlowdown(), row.slowdown);
    EXPECT_EQ(p_sprite->getColor(), row.color);
    EXPECT_EQ(p_sprite->getTransparency(), row.transparency);
    EXPECT_EQ(p_sprite->getLabel(), row.name);
    EXPECT_EQ(p_sprite->getFrame(0).getString(), row.first_frame);
    EXPECT_EQ(p_sprite->getFrame(row.frames - 1).getString(), row.last_frame);
  }
}

TEST_F(SpriteFile, ErrorsNameTheirLine) {
  const std::string sizes = "frames 1\nwidth 3\nheight 1\n", body = "</HEADER>\n<BODY>\n";
  const std::pair<std::string, const char*> kBad[] = {
      {"<HEADER>\nframes 1\nwidth 3\nheight 2\n" + body + "abc\nab\nend\n</BODY>\n",
       "8: the row has 2 characters instead of 3"},
      {"<HEADER>\nframes 1\nwidth 3\n" + body + "abc\nend\n</BODY>\n", "4: height is missing"},
      {"<HEADER>\n" + sizes + "color pink\n" + body + "abc\nend\n</BODY>\n", "5: unknown color \"pink\""},
      {"<HEADER>\nframes two\nwidth 3\nheight 1\n</HEADER>\n", "2: frames should be a number, not \"two\""},
      {"<HEADER>\nframes 2\nwidth 3\nheight 1\n" + body + "abc\nend\nabc\n",
       "9: the file ends where \"end\" should be"},
      {"<HEADER>\n" + sizes + body + "abc\nabc\nend\n</BODY>\n", "8: expected \"end\", not \"abc\""},
      {"2\n3\n1\n0\nblue\nabc\nabcd\n", "7: the row has 4 characters instead of 3"},
      {sizes + "color red\nabc\neof\n", "6: expected \"end\", not \"eof\""},
      {"Saucer\n", "1: a sprite begins with \"<HEADER>\", \"frames\" or a number"},
      {"<HEADER>\nframes 100000000\nwidth 3\nheight 1\n</HEADER>\n",
       "2: frames should be 1 to 10000, not 100000000"},
      {"", "0: the file ends where \"<HEADER>\", \"frames\" or a number should be"},
      {"1\n1\n1\n-1\nred\nx", "4: slowdown should be 0 to 1000000, not -1"},
      {"1\n1\n1\n1\nred\nx\ny", "7: unexpected \"y\" after the end of the sprite"},
  };
  for (const auto& [text, trouble] : kBad) EXPECT_EQ(troubleOf(text), trouble) << text;
}

TEST_F(SpriteFile, RowsMayEqualTheEndMarkerAndKeepBlanks) {
  EXPECT_EQ(parsed("frames 1\nwidth 3\nheight 2\nend\nend\nend\neof\n").getFrame(0).getString(), "endend");
  EXPECT_EQ(parsed("1\n4\n1\n1\nwhite\na   ").getFrame(0).getString(), "a   ");
  EXPECT_EQ(
      parsed("<HEADER>\nframes 1\nwidth 1\nheight 1\ntransparency  \n</HEADER>\n<BODY>\nx\nend\n</BODY>\n")
          .getTransparency(),
      ' ');
}

// Blank rows at the beginning, at the end and everywhere, in each format, also with CR LF.
TEST_F(SpriteFile, RowsMayBeBlank) {
  for (const std::string rows : {"   \na b\n", "a b\n   \n", "   \n   \n"}) {
    const std::string sizes = "frames 2\nwidth 3\nheight 2\n";
    const std::string frames = rows + "end\n" + rows + "end\n";
    std::string expected = rows;
    std::erase(expected, '\n');
    for (std::string text :
         {"<HEADER>\n" + sizes + "</HEADER>\n<BODY>\n" + frames + "</BODY>\n",
          sizes + "color blue\n" + frames + "eof\n", sizes + frames + "eof\n",
          sizes + "\ncolor blue\nslowdown 2\n\n" + frames + "eof\n", "2\n3\n2\n1\nblue\n" + rows + rows}) {
      for (const bool has_cr : {false, true}) {
        if (has_cr) text = std::regex_replace(text, std::regex("\n"), "\r\n");
        for (int frame = 0; frame < 2; ++frame)
          EXPECT_EQ(parsed(text).getFrame(frame).getString(), expected) << text;
      }
    }
  }
}

// Parsing any contents results in either a sprite or an error message.
TEST_F(SpriteFile, TruncatedOrCorruptFilesLoadOrReportAnError) {
  int refused = 0;
  for (const char* name : {"header.txt", "simple.txt", "old.txt", "header-crlf.txt"}) {
    const std::string text = naiad::test::contentOf(kFolder + name);
    ASSERT_NE(text, "") << name;
    for (std::size_t i = 0; i < text.size(); ++i) {
      for (const char other : {'\n', '9', ' ', '\xff', '\0'}) {
        std::string garbled = text;
        garbled[i] = other;
        std::string error;
        const auto sprite = parseSprite(garbled, "s", error);
        EXPECT_EQ(sprite == nullptr, !error.empty());
        refused += sprite == nullptr ? 1 : 0;
      }
      std::string error;
      const auto cut = parseSprite(text.substr(0, i), "s", error);
      EXPECT_EQ(cut == nullptr, !error.empty());
    }
  }
  EXPECT_GT(refused, 100);
}

TEST_F(SpriteFile, FirstSpriteWithALabelIsKept) {
  ASSERT_EQ(RM.loadSprite(kFolder + "simple.txt", "s"), 0);
  Sprite* p_first = RM.getSprite("s");
  EXPECT_EQ(RM.loadSprite(kFolder + "old.txt", "s"), 0);
  EXPECT_EQ(RM.getSprite("s"), p_first);
  EXPECT_EQ(RM.unloadSprite("s"), 0);
  EXPECT_EQ(RM.getSprite("s"), nullptr);
  EXPECT_EQ(RM.unloadSprite("s"), -1);
  EXPECT_EQ(p_first->getFrameCount(), 3);  // still valid, because Objects may show it
}

TEST_F(SpriteFile, RelativeNamesAreSearchedInTheWorldsFolders) {
  EXPECT_EQ(RM.loadSprite("sprites/simple.txt", "s"), -1);
  world.extras().resources.addFolder(std::string(NAIAD_SOURCE_DIR) + "/tests/server/engine");
  EXPECT_EQ(RM.loadSprite("sprites/simple.txt", "s"), 0);
}

TEST_F(SpriteFile, WorldsHaveSeparateSprites) {
  ASSERT_EQ(RM.loadSprite(kFolder + "simple.txt", "s"), 0);
  World other;
  const World::Scope inside(other);
  EXPECT_EQ(RM.getSprite("s"), nullptr);
}

}  // namespace
}  // namespace df::test

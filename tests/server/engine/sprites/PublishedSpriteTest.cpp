// Sprite files that the published engine loads although the book's rules reject them. In compat mode they are
// loaded, with a log line.

#include <fstream>

#include "engine/managers/ResourceManager.h"
#include "engine/sprites/SpriteFile.h"
#include "tests/server/engine/Probe.h"
#include "tests/support/TempFolder.h"

namespace df::test {
namespace {

std::string withHeader(const std::string& fields) {
  return "<HEADER>\nframes 2\nwidth 1\nheight 1\n" + fields +
         "</HEADER>\n<BODY>\na\nend\nb\nend\n</BODY>\n<FOOTER>\nversion 1\n</FOOTER>\n";
}

/// A sprite that a test varies; an empty part is left out.
struct Parts {
  std::string begin = "<HEADER>\n", frames, width, height, color = "color red\n", more,
              body = "</HEADER>\n<BODY>\n";
  std::vector<std::string> rows;  // of all frames
  std::string after_frame = "end\n", end = "</BODY>\n<FOOTER>\nversion 1\n</FOOTER>\n", rest;
  int row_count = 0;   // of each frame
  bool swaps = false;  // height and colour stand first

  Parts(int w, int h, int n)
      : frames("frames " + std::to_string(n) + "\n"),
        width("width " + std::to_string(w) + "\n"),
        height("height " + std::to_string(h) + "\n"),
        rows(static_cast<std::size_t>(h * n), std::string(static_cast<std::size_t>(w), 'x')),
        row_count(h) {}
  void makeOld() {
    begin = body = "";
    end = "eof\n";
  }
  void blank(std::size_t row, char with = ' ') { rows[row].assign(rows[row].size(), with); }
  std::string text() const {
    std::string all =
        begin + (swaps ? height + color + frames + width : frames + width + height + color) + more + body;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      all += rows[i] + "\n";
      if ((i + 1) % static_cast<std::size_t>(row_count) == 0) all += after_frame;
    }
    return all + end + rest;
  }
};

std::string withCarriageReturns(const std::string& text) {
  std::string all;
  for (const char c : text) all += c == '\n' ? std::string("\r\n") : std::string(1, c);
  return all;
}

/// A way to write a sprite, in the form with a header and in the old form.
struct Form {
  const char* name;
  bool is_accepted;  // with a header
  bool is_old_accepted;
  void (*change)(Parts& parts);
};

constexpr Form kForms[] = {
    {"plain", true, true, [](Parts&) {}},
    {"no frames", false, false, [](Parts& p) { p.frames = ""; }},
    {"no width", false, false, [](Parts& p) { p.width = ""; }},
    {"no height", false, false, [](Parts& p) { p.height = ""; }},
    {"no color", true, true, [](Parts& p) { p.color = ""; }},
    {"another order", true, true, [](Parts& p) { p.swaps = true; }},
    {"first row blank", true, true, [](Parts& p) { p.blank(0); }},
    {"last row blank", true, true, [](Parts& p) { p.blank(p.rows.size() - 1); }},
    {"all rows blank", true, true,
     [](Parts& p) {
       for (std::size_t i = 0; i < p.rows.size(); ++i) p.blank(i);
     }},
    {"first row of tabs", true, true, [](Parts& p) { p.blank(0, '\t'); }},
    {"tabs between names and values", true, true, [](Parts& p) { p.color = "color \t red\t\n"; }},
    {"row too short", false, false, [](Parts& p) { p.rows.back().pop_back(); }},
    {"row too long", false, false, [](Parts& p) { p.rows[0] += 'x'; }},
    {"row missing", false, false, [](Parts& p) { p.rows.pop_back(); }},
    {"no end of a frame", false, false, [](Parts& p) { p.after_frame = ""; }},
    {"text after the end", true, true, [](Parts& p) { p.rest = "\n\nnotes of mine\n***"; }},
    {"another sprite after the end", true, true, [](Parts& p) { p.rest = p.text(); }},
    {"no final newline", true, true, [](Parts& p) { p.end.pop_back(); }},
    {"no last part", true, true, [](Parts& p) { p.end = p.begin.empty() ? "" : "</BODY>"; }},
    {"the other form's last part", false, false,
     [](Parts& p) { p.end = p.begin.empty() ? "</BODY>\n" : "</BODY>\neof\n"; }},
    {"no last tag", false, true,
     [](Parts& p) {
       if (!p.begin.empty()) p.end = "</BODY>\n<FOOTER>\nversion 1\n";
     }},
    {"only the header's tags", false, true, [](Parts& p) { p.body = p.body.substr(0, p.body.find('<', 1)); }},
    {"a header's tag", false, false, [](Parts& p) { p.body = "<BODY>\n"; }},
    {"unknown field", true, false, [](Parts& p) { p.more = "author ann\n"; }},
    {"comment", true, false, [](Parts& p) { p.more = "# a comment\n"; }},
    {"slowdown with a fraction", true, true, [](Parts& p) { p.more = "slowdown 3.5\n"; }},
    {"text after a number", true, true,
     [](Parts& p) {
       p.frames.back() = 'f';
       p.frames += "\n";
     }},
    {"color without a value", true, false, [](Parts& p) { p.color = "color \n"; }},
    {"unknown color", false, false, [](Parts& p) { p.color = "color purple\n"; }},
    {"width twice", false, false, [](Parts& p) { p.more = "width 9\n"; }},
    {"huge frames", false, false, [](Parts& p) { p.frames = "frames 99999999999999999999\n"; }},
    {"negative height", false, false, [](Parts& p) { p.height = "height -1\n"; }},
};

class PublishedSprite : public WorldTest {
 protected:
  /// Loads a file with this text; returns the result of RM.loadSprite().
  int load(const std::string& text, const std::string& label = "s") {
    std::ofstream(file()) << text;
    return RM.loadSprite(file(), label);
  }
  std::string file() const { return (m_folder / "sprite.txt").string(); }
  /// Returns row 10 after each of `ticks` ticks, without blanks, with an Object of this sprite in it.
  std::string shownOf(const std::string& label, int ticks) {
    PlacedObject o(Vector(10, 10));
    o.setSprite(label);
    return shown(10, ticks);
  }

 private:
  naiad::test::TempFolder m_folder;
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

// A refused file has its number of a line in the log. (The sizes are width, height and number of frames.)
TEST_F(PublishedSprite, EachFormIsAcceptedOrRefusedAtAllSizes) {
  world.setCompat();
  const int sizes[][3] = {{1, 1, 1}, {2, 1, 3}, {1, 3, 2}, {7, 4, 4}};
  for (const Form& form : kForms) {
    for (const auto& [w, h, n] : sizes) {
      for (const bool is_old : {false, true}) {
        for (const bool has_returns : {false, true}) {
          Parts parts(w, h, n);
          if (is_old) parts.makeOld();
          form.change(parts);
          const std::string text = has_returns ? withCarriageReturns(parts.text()) : parts.text();
          const bool accepted = is_old ? form.is_old_accepted : form.is_accepted;
          lines.clear();
          EXPECT_EQ(load(text), accepted ? 0 : -1) << form.name << (is_old ? ", old\n" : "\n") << text;
          if (const Sprite* p_sprite = RM.getSprite("s"); p_sprite != nullptr && accepted) {
            EXPECT_EQ(p_sprite->getFrameCount(), n) << form.name << "\n" << text;
          }
          EXPECT_EQ(logged("Sprite s: " + file() + ":"), static_cast<int>(lines.size()));
          EXPECT_TRUE(accepted || !lines.empty()) << form.name;
          RM.unloadSprite("s");
        }
      }
    }
  }
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
  Sprite sprite = spriteOf({"a", "b"}, 0);
  Object o;
  o.setSprite(&sprite);
  world.tick();
  EXPECT_EQ(o.getSpriteIndex(), 1);
  o.setSpriteSlowdownCount(-1);
  world.tick();
  EXPECT_EQ(o.getSpriteIndex(), 1);
}

}  // namespace
}  // namespace df::test

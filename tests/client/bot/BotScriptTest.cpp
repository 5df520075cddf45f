#include <gtest/gtest.h>

#include "client/bot/BotScript.h"

namespace naiad {
namespace {

using namespace df::Keyboard;

BotScript parse(const std::string& text) {
  auto result = BotScript::parse(text);
  if (const auto* error = std::get_if<ScriptError>(&result)) {
    ADD_FAILURE() << text << ": " << error->line << ":" << error->column << ": " << error->message;
    return {};
  }
  return std::get<BotScript>(result);
}

/// Runs a script. Returns a letter and details for each action: "P0" SPACE pressed, D down, R released, C
/// click, M move, T text. Blanks separate ticks.
std::string play(const std::string& text, int ticks) {
  ScriptPlayer player(parse(text));
  std::string out;
  for (int i = 0; i < ticks; ++i) {
    if (i > 0) out += ' ';
    for (const BotAction& action : player.tick()) {
      if (const auto* key = std::get_if<KeyAction>(&action)) {
        out += key->action == df::KEY_PRESSED ? 'P' : key->action == df::KEY_DOWN ? 'D' : 'R';
        out += std::to_string(key->key);
      } else if (const auto* click = std::get_if<BotClick>(&action)) {
        out += click->action == df::CLICKED ? 'C' : 'M';
        out +=
            std::to_string(click->x) + "," + std::to_string(click->y) + "," + std::to_string(click->button);
      } else {
        out += "T" + std::get<BotChat>(action).text;
      }
    }
  }
  return out;
}

TEST(BotScript, RunsEveryStatement) {
  EXPECT_EQ(play("press SPACE; wait 2\nclick 40 12 right", 5), "P0 R0  C40,12,1 ");
  EXPECT_EQ(play("hold leftarrow 3; press a", 6), "P4 D4 D4 R4P31 R31 ");
  EXPECT_EQ(play("move 3 4; chat hello all # not a comment; press 1", 4),
            "M3,4,-1 Thello all # not a comment P57 R57");
}

TEST(BotScript, Repeats) {
  EXPECT_EQ(play("repeat 2 { press SPACE; wait 1 } chat x", 7), "P0 R0 P0 R0 Tx  ");
  EXPECT_EQ(play("wait 1; press SPACE; repeat", 6), " P0 R0 P0 R0 P0");
  EXPECT_EQ(play("repeat 2 { repeat 2 { chat a } chat b }", 7), "Ta Ta Tb Ta Ta Tb ");
}

TEST(BotScript, IgnoresCommentsAndBlanks) {
  EXPECT_EQ(parse("# first\n\n ; press SPACE # then\n;;wait 1\r\n").steps().size(), 2u);
}

TEST(BotScript, FindsKeysByNameInAnyCase) {
  EXPECT_EQ(keyByName("space"), SPACE);
  EXPECT_EQ(keyByName("F12"), F12);
  EXPECT_EQ(keyByName("Z"), Z);
  EXPECT_EQ(keyByName("0"), NUM0);
  EXPECT_EQ(keyByName("backspace"), BACKSPACE);
  EXPECT_EQ(keyByName("PAGEDOWN"), PAGEDOWN);
  EXPECT_EQ(keyByName("ENTER"), std::nullopt);
}

struct BadScript {
  const char* text;
  int line;
  int column;
  const char* message;  ///< part of the message
};

TEST(BotScript, ErrorsNameLineAndColumn) {
  const BadScript scripts[] = {
      {"jump", 1, 1, "\"jump\" is not a statement"},
      {"press SPACE\n  press", 2, 8, "key is missing"},
      {"press SPACE; press BANANA", 1, 20, "no key \"BANANA\""},
      {"hold A", 1, 7, "number of ticks"},
      {"hold A 0", 1, 8, "from 1 to"},
      {"wait 99999999999", 1, 6, "number"},
      {"wait 5 6", 1, 8, "unexpected"},
      {"click 4", 1, 8, "row"},
      {"click 4 1000", 1, 9, "row"},
      {"click 4 5 wheel", 1, 11, "button"},
      {"chat", 1, 5, "text"},
      {"wait 1\nrepeat 3 wait 1", 2, 10, "'{'"},
      {"repeat 3 { }", 1, 12, "needs a statement"},
      {"repeat 3 { wait 1", 1, 18, "'}' is missing"},
      {"wait 1 }", 1, 8, "without a repeat"},
      {"repeat", 1, 7, "must follow a statement"},
      {"wait 1; repeat; wait 2", 1, 17, "nothing can follow"},
      {"", 1, 1, "no statements"},
      {"# only a comment", 1, 17, "no statements"},
  };
  for (const BadScript& bad : scripts) {
    const auto result = BotScript::parse(bad.text);
    const auto* error = std::get_if<ScriptError>(&result);
    ASSERT_NE(error, nullptr) << bad.text;
    EXPECT_EQ(error->line, bad.line) << bad.text << ": " << error->message;
    EXPECT_EQ(error->column, bad.column) << bad.text << ": " << error->message;
    EXPECT_NE(error->message.find(bad.message), std::string::npos) << bad.text << ": " << error->message;
  }
}

TEST(RandomPlayer, SameSeedGivesEqualActionCountsWithinTheView) {
  RandomPlayer a(42, 80, 24);
  RandomPlayer b(42, 80, 24);
  int actions = 0;
  for (int tick = 0; tick < 3000; ++tick) {
    const auto x = a.tick();
    const auto y = b.tick();
    ASSERT_EQ(x.size(), y.size());
    for (const BotAction& action : x) {
      ++actions;
      if (const auto* click = std::get_if<BotClick>(&action)) {
        EXPECT_GE(click->x, 0);
        EXPECT_LT(click->x, 80);
        EXPECT_LT(click->y, 24);
      }
    }
  }
  EXPECT_GT(actions, 500);
}

}  // namespace
}  // namespace naiad

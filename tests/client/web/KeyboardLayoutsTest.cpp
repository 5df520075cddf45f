// Keyboards of five layouts, on terminals of three kinds and in a browser: games get W, A, S, D and Space,
// and the menu key opens the menu. Latin layouts go by character, other scripts by position.
#include <gtest/gtest.h>

#include <array>
#include <string>

#include "client/terminal/InputDecoder.h"
#include "client/ui/ClientControls.h"
#include "client/web/BrowserKeys.h"
#include "shared/values/Canvas.h"

namespace naiad {
namespace {

using namespace df::Keyboard;
using Time = InputDecoder::Time;

/// A key of a layout: the character that it types, and its position as the character of a US keyboard.
struct Typed {
  char32_t ch;
  char position;
};

struct Layout {
  const char* name;
  std::array<Typed, 4> wasd;
  Typed g;
};

const std::array<Layout, 5> kLayouts = {{
    {"US", {{{U'w', 'w'}, {U'a', 'a'}, {U's', 's'}, {U'd', 'd'}}}, {U'g', 'g'}},
    {"German", {{{U'w', 'w'}, {U'a', 'a'}, {U's', 's'}, {U'd', 'd'}}}, {U'g', 'g'}},
    {"French", {{{U'w', 'z'}, {U'a', 'q'}, {U's', 's'}, {U'd', 'd'}}}, {U'g', 'g'}},
    {"Russian", {{{U'ц', 'w'}, {U'ф', 'a'}, {U'ы', 's'}, {U'в', 'd'}}}, {U'п', 'g'}},
    {"Greek", {{{U'ς', 'w'}, {U'α', 'a'}, {U'σ', 's'}, {U'δ', 'd'}}}, {U'γ', 'g'}},
}};

char upperCase(char letter) {
  return static_cast<char>(letter - 'a' + 'A');
}

std::string utf8(char32_t ch) {
  std::string text;
  df::appendUtf8(text, ch);
  return text;
}

/// Returns the event of the first key in these bytes.
KeyEvent decoded(const std::string& bytes) {
  const auto events = InputDecoder().feed(bytes, Time{});
  const auto* p_key = events.empty() ? nullptr : std::get_if<KeyEvent>(&events.front());
  return p_key != nullptr ? *p_key : KeyEvent();
}

/// A way in which keys reach the client. `modifiers`: 0 or kControl.
struct Way {
  const char* name;
  KeyEvent (*press)(const Typed& typed, std::uint8_t modifiers);
};

KeyEvent plain(const Typed& typed, std::uint8_t modifiers) {
  // With Control, terminals send the control byte of the Latin letter at the key's position.
  return decoded(modifiers != 0 ? std::string(1, static_cast<char>(typed.position & 0x1F)) : utf8(typed.ch));
}
KeyEvent kitty(const Typed& typed, std::uint8_t modifiers) {
  std::string code = std::to_string(static_cast<unsigned>(typed.ch));
  if (typed.ch != static_cast<unsigned char>(typed.position)) code += "::" + std::to_string(typed.position);
  return decoded("\033[" + code + ";" + std::to_string(modifiers + 1) + "u");
}
/// xterm's modifyOtherKeys.
KeyEvent otherKeys(const Typed& typed, std::uint8_t modifiers) {
  if (modifiers == 0) return plain(typed, modifiers);
  return decoded("\033[27;5;" + std::to_string(static_cast<unsigned>(typed.ch)) + "~");
}
KeyEvent windows(const Typed& typed, std::uint8_t modifiers) {
  // The virtual key of a letter is the Latin letter that the layout has there.
  const char letter = typed.ch < 0x80 ? static_cast<char>(typed.ch) : typed.position;
  const int unit = modifiers != 0 ? letter & 0x1F : static_cast<int>(typed.ch);
  const int key = letter == ' ' ? 0x20 : upperCase(letter);
  return decoded("\033[" + std::to_string(key) + ";0;" + std::to_string(unit) + ";1;" +
                 (modifiers != 0 ? "8" : "0") + ";1_");
}
KeyEvent browser(const Typed& typed, std::uint8_t modifiers) {
  const std::string code =
      typed.position == ' ' ? "Space" : std::string("Key").append(1, upperCase(typed.position));
  return BrowserKeys().translate(utf8(typed.ch), code, KeyEvent::Action::kPress, modifiers);
}

const std::array<Way, 5> kWays = {{{"plain", plain},
                                   {"kitty", kitty},
                                   {"modifyOtherKeys", otherKeys},
                                   {"win32-input-mode", windows},
                                   {"browser", browser}}};

bool opensMenu(const KeyEvent& event) {
  ClientControls controls;
  controls.handleKey(event);
  return controls.prefixed();
}

TEST(KeyboardLayouts, LettersMoveInEveryLayout) {
  constexpr std::array kExpected = {W, A, S, D};
  for (const Layout& layout : kLayouts) {
    for (const Way& way : kWays) {
      for (std::size_t i = 0; i < kExpected.size(); ++i) {
        const KeyEvent event = way.press(layout.wasd[i], 0);
        EXPECT_EQ(event.key, kExpected[i]) << layout.name << ", " << way.name;
        EXPECT_EQ(event.ch, layout.wasd[i].ch) << "the chat line gets the character: " << way.name;
      }
      EXPECT_EQ(way.press({U' ', ' '}, 0).key, SPACE) << layout.name << ", " << way.name;
    }
  }
}

TEST(KeyboardLayouts, ControlGOpensTheMenuInEveryLayout) {
  for (const Layout& layout : kLayouts)
    for (const Way& way : kWays)
      EXPECT_TRUE(opensMenu(way.press(layout.g, kControl))) << layout.name << ", " << way.name;
}

TEST(KeyboardLayouts, ControlBracketOpensTheMenuInEveryEncoding) {
  for (const char* bytes : {"\x1d",
                            "\033[93;5u",               // US
                            "\033[93::57;5u",           // German, AltGr and 9: kitty
                            "\033[57:93;5u",            // Alacritty
                            "\033[57:93:57;5u",         // with the position
                            "\033[93::45;5u",           // French, AltGr and ')'
                            "\033[41:93;5u",            // Alacritty
                            "\033[41:93:45;5u",         // with the position
                            "\033[43::93;5u",           // German, the key at that position
                            "\033[43:42:93;5u",         // with the shifted character
                            "\033[36::93;5u",           // French
                            "\033[1098::93;5u",         // Russian
                            "\033[1098;5u",             // without the position
                            "\033[93;133u",             // with Num Lock
                            "\033[27;5;93~",            // modifyOtherKeys
                            "\033[27;5;1098~",          // Russian
                            "\033[221;27;29;1;8;1_",    // US
                            "\033[187;27;29;1;8;1_",    // German, the key at that position
                            "\033[57;10;29;1;9;1_",     // German, AltGr and 9
                            "\033[57;10;29;1;4;1_",     // with a control character only
                            "\033[57;10;93;1;13;1_",    // with both Controls
                            "\033[48;11;29;1;9;1_",     // French, AltGr and ')'
                            "\033[221;27;0;1;8;1_",     // Russian
                            "\033[231;0;29;1;8;1_"}) {  // from a program
    EXPECT_TRUE(opensMenu(decoded(bytes))) << testing::PrintToString(std::string(bytes));
  }
}

TEST(KeyboardLayouts, OtherKeysDoNotOpenTheMenu) {
  for (const char* bytes :
       {"]", "g", "\033]x\033\\", "\033[57;5u", "\033[57::57;5u", "\033[57:40;5u", "\033[57:93;1;93u",
        "\033[93u", "\033[93::57;1;93u", "\033[103u", "\033[103;3u", "\033[27;5;57~", "\033[57;10;0;1;8;1_",
        "\033[57;10;57;1;8;1_", "\033[57;10;93;1;9;1_", "\033[71;34;103;1;0;1_", "\033[71;34;103;1;2;1_"}) {
    EXPECT_FALSE(opensMenu(decoded(bytes))) << testing::PrintToString(std::string(bytes));
  }
  EXPECT_EQ(decoded("\033[57;10;93;1;9;1_").ch, U']') << "AltGr types it";
}

TEST(KeyboardLayouts, UpperCaseLettersHaveShift) {
  for (const char* text : {"Ц", "Ф", "Ы", "В", "Σ", "Α", "Δ", "Ё", "І", "Я"}) {
    const KeyEvent event = decoded(text);
    EXPECT_NE(event.key, UNDEFINED_KEY) << text;
    EXPECT_EQ(event.modifiers, kShift) << text;
  }
  EXPECT_EQ(decoded("Ї").key, RIGHTBRACKET);
  EXPECT_EQ(decoded("ж").key, SEMICOLON);
  EXPECT_EQ(decoded("é").key, UNDEFINED_KEY) << "Latin letters go by character";
}

TEST(KeyboardLayouts, CommandsWorkInOtherScripts) {
  for (const char* key : {"р", "η"}) {  // at the position of H
    ClientControls controls;
    controls.handleKey(decoded("\x07"));
    controls.handleKey(decoded(key));
    EXPECT_EQ(controls.panel(), Panel::kHelp) << key;
  }
}

TEST(KeyboardLayouts, ChatLineGetsLettersOfOtherScripts) {
  ClientControls controls;
  controls.handleKey(decoded("\x07"));
  controls.handleKey(decoded("t"));
  for (const char* key : {"п", "р", "и", "в", "γ"}) controls.handleKey(decoded(key));
  EXPECT_EQ(controls.chatText(), "привγ");
}

// Letters of scripts without a table go by position, too.
TEST(KeyboardLayouts, BrowserReportsPositionsOfAllScripts) {
  for (const char* key : {"ש", "ش", "შ", "ա", "น", "њ", "あ", "ㅈ"}) {
    const KeyEvent event = BrowserKeys().translate(key, "KeyA", KeyEvent::Action::kPress, 0);
    EXPECT_EQ(event.key, A) << key;
    EXPECT_EQ(event.ch, df::decodeUtf8(key).front()) << key;
  }
}

}  // namespace
}  // namespace naiad

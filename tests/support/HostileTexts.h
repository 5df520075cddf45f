// Texts that harm a terminal or mislead its reader, one for each kind of attack, to test everything that
// displays text from other people.
#pragma once

#include <string>
#include <vector>

#include "shared/values/SplitMix64.h"

namespace naiad::test {

struct HostileText {
  const char* what;
  std::string bytes;
};

inline const std::vector<HostileText>& hostileTexts() {
  using namespace std::string_literals;
  static const std::vector<HostileText> texts = {
      {"clears the screen", "\033[2J"},
      {"asks for the cursor, which types", "\033[6n"},
      {"asks for the terminal's name", "\033[>c"},
      {"sets the title", "\033]0;OWNED\007"},
      {"sets the title, ended otherwise", "\033]2;OWNED\033\\"},
      {"writes the clipboard", "\033]52;c;T1dORUQ=\007"},
      {"a link", "\033]8;;http://owned.example\033\\"},
      {"a device control string", "\033P$q\"p\033\\"},
      {"an application command", "\033_OWNED\033\\"},
      {"resets the terminal", "\033c"},
      {"the other character set", "\033(0"},
      {"leaves the alternate screen", "\033[?1049l"},
      {"bracketed paste", "\033[200~rm\033[201~"},
      {"bell", "\007"},
      {"backspaces", "safe\b\b\b\bevil"},
      {"carriage return", "safe\revil"},
      {"lines", "a\nb\vc\fd"},
      {"tab", "a\tb"},
      {"shift out and in", "\016q\017"},
      {"XON, XOFF", "\021\023"},
      {"delete", "a\177b"},
      {"null", "a\0b"s},
      {"escape, cut off", "\033"},
      {"C1: CSI as UTF-8", "\u009b2J"},
      {"C1: OSC as UTF-8", "\u009d0;OWNED\u009c"},
      {"C1: CSI as a byte", "\2332J"},
      {"C1: NEL", "a\u0085b"},
      {"bidi override", "\u202elive\u202c"},
      {"bidi isolate", "\xE2\x81\xA7x\xE2\x81\xA9"},
      {"right-to-left mark", "\xE2\x80\x8F"},
      {"Arabic letter mark", "\xD8\x9C"},
      {"right-to-left letters", "\xD7\xA9\xD7\x9C"},
      {"zero-width space", "a\u200bb"},
      {"zero-width joiner", "a\u200db"},
      {"word joiner", "a\u2060b"},
      {"byte order mark", "\ufeffa"},
      {"soft hyphen", "a\u00adb"},
      {"combining accents", "Z\xCC\xB5\xCC\xB7\xCC\xA1"},
      {"variation selector", "a\xEF\xB8\x8F"},
      {"Hangul filler", "\xE3\x85\xA4"},
      {"line separator", "a\u2028b"},
      {"paragraph separator", "a\u2029b"},
      {"wide letters", "\xE4\xB8\x80\xE4\xB8\x81"},
      {"full-width letters", "\xEF\xBC\xA1"},
      {"emoji", "\xF0\x9F\x98\x80"},
      {"flags", "\xF0\x9F\x87\xA9\xF0\x9F\x87\xAA"},
      {"tag characters", "\xF3\xA0\x81\x81"},
      {"private use", "\xEE\x80\x80"},
      {"no character", "\xEF\xBF\xBF"},
      {"overlong escape", "\xC0\x9B[2J"},
      {"overlong escape of three bytes", "\xE0\x80\x9B[2J"},
      {"a surrogate", "\xED\xA0\x80"},
      {"beyond Unicode", "\xF4\x90\x80\x80"},
      {"cut off", "\xE2\x82"},
      {"continuation alone", "\x80\x80"},
      {"bytes that are never UTF-8", "\xFE\xFF"},
      {"very long", std::string(3'000, 'x')},
  };
  return texts;
}

/// Returns one to three pieces, each a hostile text or random bytes.
inline std::string hostileText(SplitMix64& random) {
  std::string text;
  for (std::uint64_t pieces = 1 + random.below(3); pieces > 0; --pieces) {
    if (random.below(4) == 0) {
      for (std::uint64_t i = random.below(20); i > 0; --i) text.push_back(static_cast<char>(random.next()));
    } else {
      text += hostileTexts()[random.below(hostileTexts().size() - 1)].bytes;
    }
  }
  return text;
}

}  // namespace naiad::test

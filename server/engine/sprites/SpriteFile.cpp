#include "engine/sprites/SpriteFile.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <optional>
#include <utility>
#include <vector>

namespace df {

namespace {

// An error in the file; caught in parseSprite().
struct ParseError {
  std::size_t line;
  std::string what;
};

std::string trimmed(const std::string& text) {
  const auto blank = [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; };
  const auto begin = std::find_if_not(text.begin(), text.end(), blank);
  const auto end = std::find_if_not(text.rbegin(), std::make_reverse_iterator(begin), blank).base();
  return {begin, end};
}

class Lines {
 public:
  explicit Lines(const std::string& text) {
    for (std::size_t begin = 0; begin < text.size();) {
      const std::size_t end = std::min(text.find('\n', begin), text.size());
      std::size_t length = end - begin;
      if (length > 0 && text[end - 1] == '\r') --length;
      m_lines.push_back(text.substr(begin, length));
      begin = end + 1;
    }
  }

  bool isDone() const { return m_next == m_lines.size(); }
  /// Skips blank lines, but not a line of exactly `row` blanks, which is a row of a frame.
  void skipBlank(std::size_t row = std::string::npos) {
    while (isBlank() && m_lines[m_next].size() != row) ++m_next;
  }
  bool isBlank() const { return !isDone() && trimmed(m_lines[m_next]).empty(); }
  /// Returns the next line unchanged. `expected` describes it, for the error at the end of the file.
  const std::string& nextLine(const std::string& expected) {
    if (isDone()) throw ParseError{m_lines.size(), "the file ends where " + expected + " should be"};
    return m_lines[m_next++];
  }
  /// Returns the next line that is not blank, without blanks at its ends.
  std::string nextWord(const std::string& expected) {
    skipBlank();
    return trimmed(nextLine(expected));
  }
  std::string peekWord() {
    skipBlank();
    return isDone() ? std::string() : trimmed(m_lines[m_next]);
  }
  void expect(const std::string& word) {
    const std::string found = nextWord("\"" + word + "\"");
    if (found != word) fail("expected \"" + word + "\", not \"" + found + "\"");
  }
  /// Throws an error in the line that was returned last.
  [[noreturn]] void fail(const std::string& what) const { throw ParseError{m_next, what}; }
  /// Returns a text with the number of the line that was returned last and `what`.
  std::string describe(const std::string& what) const { return std::to_string(m_next) + ": " + what; }

 private:
  std::vector<std::string> m_lines;
  std::size_t m_next = 0;
};

struct Header {
  explicit Header(std::vector<std::string>* warnings)
      : p_warnings(warnings), slowdown(warnings != nullptr ? 0 : 1) {}

  std::vector<std::string>* p_warnings;  // if not null, more is accepted and listed here (SpriteFile.h)
  std::optional<int> frames;
  std::optional<int> width;
  std::optional<int> height;
  int slowdown;
  Color color = COLOR_DEFAULT;
  char transparency = 0;
};

/// Lists this trouble in the last line, with what is done about it; throws if nothing is tolerated.
void tolerate(const Lines& lines, const Header& header, const std::string& trouble, const std::string& done) {
  if (header.p_warnings == nullptr) lines.fail(trouble);
  header.p_warnings->push_back(lines.describe(trouble + ", " + done));
}

int toNumber(const Lines& lines, const Header& header, const std::string& key, const std::string& text,
             int least, int most) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const std::string trouble = key + " should be a number, not \"" + text + "\"";
  if (error != std::errc()) lines.fail(trouble);
  if (end != text.data() + text.size())
    tolerate(lines, header, trouble, "the number at its beginning is used");
  if (value < least || value > most) {
    lines.fail(key + " should be " + std::to_string(least) + " to " + std::to_string(most) + ", not " + text);
  }
  return value;
}

Color toColor(const Lines& lines, const std::string& text) {
  const Color color = colorOfName(text);
  if (color == UNDEFINED_COLOR) lines.fail("unknown color \"" + text + "\"");
  return color;
}

void parseSlowdown(const Lines& lines, Header& header, const std::string& text) {
  constexpr int kMaxSlowdown = 1'000'000;
  const bool is_compat = header.p_warnings != nullptr;
  if (is_compat && text.empty()) return tolerate(lines, header, "slowdown has no number", "0 is used");
  header.slowdown = toNumber(lines, header, "slowdown", text, is_compat ? -1 : 0, kMaxSlowdown);
  if (header.slowdown < 0)
    tolerate(lines, header, "slowdown should be 0 to 1000000, not " + text, "used as it is");
}

void parseTransparency(const Lines& lines, Header& header, const std::string& text) {
  if (text.size() > 1) {
    tolerate(lines, header, "transparency should be one character, not \"" + text + "\"",
             "its first one is used");
  }
  header.transparency = text.empty() ? ' ' : text[0];
}

void parseField(const Lines& lines, Header& header, const std::string& line) {
  const std::size_t gap = std::min(line.find_first_of(" \t"), line.size());
  const std::string key = line.substr(0, gap);
  const std::string value = trimmed(line.substr(gap));
  if (key == "frames") {
    header.frames = toNumber(lines, header, key, value, 1, kMaxSpriteFrames);
  } else if (key == "width") {
    header.width = toNumber(lines, header, key, value, 1, kMaxSpriteSide);
  } else if (key == "height") {
    header.height = toNumber(lines, header, key, value, 1, kMaxSpriteSide);
  } else if (key == "color") {
    value.empty() ? tolerate(lines, header, "color has no value", "white is used")
                  : void(header.color = toColor(lines, value));
  } else if (key == "slowdown") {
    parseSlowdown(lines, header, value);
  } else if (key == "transparency") {
    parseTransparency(lines, header, value);
  } else {
    const std::string trouble = "unknown field \"" + key + "\"";
    if (key[0] == '<') lines.fail(trouble);  // a tag is missing
    tolerate(lines, header, trouble, "ignored");
  }
}

void expectSizes(const Lines& lines, const Header& header) {
  if (!header.frames) lines.fail("frames is missing");
  if (!header.width) lines.fail("width is missing");
  if (!header.height) lines.fail("height is missing");
}

void readFrame(Lines& lines, Sprite& sprite) {
  const auto width = static_cast<std::size_t>(sprite.getWidth());
  std::string characters;
  for (int y = 0; y < sprite.getHeight(); ++y) {
    const std::string& row = lines.nextLine("a row of characters");
    if (row.size() != width) {
      lines.fail("the row has " + std::to_string(row.size()) + " characters instead of " +
                 std::to_string(width));
    }
    characters += row;
  }
  sprite.addFrame(Frame(sprite.getWidth(), sprite.getHeight(), std::move(characters)));
}

/// Makes the sprite and reads its frames. `has_ends`: a line "end" follows each of them.
std::unique_ptr<Sprite> readFrames(Lines& lines, const Header& header, bool has_ends = true) {
  auto sprite = std::make_unique<Sprite>(*header.frames);
  sprite->setWidth(*header.width);
  sprite->setHeight(*header.height);
  sprite->setColor(header.color);
  sprite->setSlowdown(header.slowdown);
  sprite->setNeverStill(header.p_warnings != nullptr);
  sprite->setTransparency(header.transparency);
  for (int i = 0; i < *header.frames; ++i) {
    readFrame(lines, *sprite);
    if (has_ends) lines.expect("end");
  }
  return sprite;
}

std::unique_ptr<Sprite> readWithHeader(Lines& lines, Header header) {
  lines.expect("<HEADER>");
  while (lines.peekWord() != "</HEADER>") parseField(lines, header, lines.nextWord("\"</HEADER>\""));
  lines.expect("</HEADER>");
  expectSizes(lines, header);
  lines.expect("<BODY>");
  auto sprite = readFrames(lines, header);
  lines.expect("</BODY>");
  if (lines.peekWord().empty()) return sprite;  // a footer is optional, and nothing in it is used
  lines.expect("<FOOTER>");
  while (lines.nextWord("\"</FOOTER>\"") != "</FOOTER>") {
  }
  return sprite;
}

std::unique_ptr<Sprite> readOld(Lines& lines, Header header) {
  // Rows may contain any text, so fields are recognised only by their names. The header ends with the last
  // line that begins with the name of a field.
  constexpr std::array<const char*, 5> kFields{"frames", "width", "height", "color", "slowdown"};
  const auto isField = [&](const std::string& line) {
    if (header.p_warnings != nullptr && line == "slowdown") return true;
    return std::any_of(kFields.begin(), kFields.end(),
                       [&](const char* field) { return line.rfind(std::string(field) + " ", 0) == 0; });
  };
  const auto isBlankRow = [&] {
    if (!header.frames || !header.width || !header.height) return false;
    lines.skipBlank(static_cast<std::size_t>(*header.width));
    return lines.isBlank();
  };
  while (!isBlankRow() && isField(lines.peekWord())) parseField(lines, header, lines.nextWord("a field"));
  expectSizes(lines, header);
  auto sprite = readFrames(lines, header);
  if (!lines.peekWord().empty()) lines.expect("eof");
  return sprite;
}

std::unique_ptr<Sprite> readSimple(Lines& lines, Header header) {
  const auto number = [&](const char* key, int most) {
    const std::string word = lines.nextWord(key);
    return toNumber(lines, Header(nullptr), key, word, 1, most);
  };
  header.frames = number("frames", kMaxSpriteFrames);
  header.width = number("width", kMaxSpriteSide);
  header.height = number("height", kMaxSpriteSide);
  parseSlowdown(lines, header, lines.nextWord("slowdown"));
  header.color = toColor(lines, lines.nextWord("a color"));
  return readFrames(lines, header, false);
}

std::unique_ptr<Sprite> readAny(Lines& lines, const Header& header) {
  const std::string first = lines.peekWord();
  bool has_end_mark = true;
  std::unique_ptr<Sprite> sprite;
  if (first == "<HEADER>") {
    sprite = readWithHeader(lines, header);
  } else if (!first.empty() && std::isdigit(static_cast<unsigned char>(first[0])) != 0) {
    sprite = readSimple(lines, header);
    has_end_mark = false;
  } else if (first.rfind("frames", 0) == 0 || first.rfind("width", 0) == 0 || first.rfind("height", 0) == 0 ||
             first.rfind("color", 0) == 0) {
    sprite = readOld(lines, header);
  } else {
    lines.nextWord("\"<HEADER>\", \"frames\" or a number");
    lines.fail("a sprite begins with \"<HEADER>\", \"frames\" or a number");
  }
  if (const std::string rest = lines.peekWord(); !rest.empty()) {
    lines.nextWord("");
    const std::string trouble = "unexpected \"" + rest + "\" after the end of the sprite";
    if (!has_end_mark) lines.fail(trouble);
    tolerate(lines, header, trouble, "ignored together with the rest");
  }
  return sprite;
}

}  // namespace

Color colorOfName(const std::string& name) {
  constexpr std::array<const char*, 8> kNames{"black", "red",     "green", "yellow",
                                              "blue",  "magenta", "cyan",  "white"};
  std::string lower = name;
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const auto found = std::find(kNames.begin(), kNames.end(), lower);
  return found == kNames.end() ? UNDEFINED_COLOR : static_cast<Color>(found - kNames.begin());
}

std::unique_ptr<Sprite> parseSprite(const std::string& text, const std::string& label, std::string& error,
                                    std::vector<std::string>* p_warnings) {
  Lines lines(text);
  try {
    auto sprite = readAny(lines, Header(p_warnings));
    sprite->setLabel(label);
    return sprite;
  } catch (const ParseError& trouble) {
    error = std::to_string(trouble.line) + ": " + trouble.what;
    return nullptr;
  }
}

}  // namespace df

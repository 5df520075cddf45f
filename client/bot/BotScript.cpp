#include "client/bot/BotScript.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <sstream>
#include <string_view>
#include <utility>

#include "shared/net/base/SafeText.h"
#include "shared/replica/Limits.h"

namespace naiad {
namespace {

constexpr int kMaxCount = 1000000;
constexpr std::size_t kMaxSteps = 10000;
constexpr std::size_t kMaxDepth = 16;

/// Names of the keys in the order of df::Keyboard::Key, separated by blanks.
constexpr std::string_view kKeyNames =
    "SPACE RETURN ESCAPE TAB LEFTARROW RIGHTARROW UPARROW DOWNARROW PAUSE MINUS PLUS TILDE PERIOD "
    "COMMA SLASH LEFTCONTROL RIGHTCONTROL LEFTSHIFT RIGHTSHIFT F1 F2 F3 F4 F5 F6 F7 F8 F9 F10 F11 F12 "
    "A B C D E F G H I J K L M N O P Q R S T U V W X Y Z NUM1 NUM2 NUM3 NUM4 NUM5 NUM6 NUM7 NUM8 NUM9 "
    "NUM0 BACKSPACE QUOTE SEMICOLON LEFTBRACKET RIGHTBRACKET BACKSLASH EQUAL LEFTALT RIGHTALT INSERT "
    "DELETE HOME END PAGEUP PAGEDOWN";

bool isSpace(char c) {
  return c == ' ' || c == '\t' || c == '\r';
}
bool endsStatement(char c) {
  return c == ';' || c == '\n' || c == '#' || c == '}';
}

std::string quoted(const std::string& text) {
  return std::string("\"").append(safeText(text, 40)).append("\"");
}

using namespace df::Keyboard;

/// Holds or releases the key that is down, if any. Returns `holds`.
bool holdOrRelease(Key& down, bool holds, std::vector<BotAction>& out) {
  if (down != UNDEFINED_KEY) out.emplace_back(KeyAction{down, holds ? df::KEY_DOWN : df::KEY_RELEASED});
  if (!holds) down = UNDEFINED_KEY;
  return holds;
}

}  // namespace

std::vector<BotAction> ScriptPlayer::tick() {
  std::vector<BotAction> out;
  m_remaining = std::max(m_remaining - 1, 0);
  if (holdOrRelease(m_down, m_remaining > 0, out)) return out;
  skipLoops();
  if (m_at >= m_script.steps().size()) return out;
  const BotStep& step = m_script.steps()[m_at++];
  m_remaining = 1;
  switch (step.kind) {
    case BotStep::Kind::kPress:
    case BotStep::Kind::kHold:
      m_down = step.key;
      m_remaining = step.kind == BotStep::Kind::kHold ? step.count : 1;
      out.emplace_back(KeyAction{step.key, df::KEY_PRESSED});
      break;
    case BotStep::Kind::kWait:
      m_remaining = step.count;
      break;
    case BotStep::Kind::kClick:
      out.emplace_back(BotClick{df::CLICKED, step.button, step.x, step.y});
      break;
    case BotStep::Kind::kMove:
      out.emplace_back(BotClick{df::MOVED, df::Mouse::UNDEFINED_MOUSE_BUTTON, step.x, step.y});
      break;
    case BotStep::Kind::kChat:
      out.emplace_back(BotChat{step.text});
      break;
    default:
      break;
  }
  return out;
}

/// Advances to the next step that takes time. Terminates, because every loop and script contains such a step.
void ScriptPlayer::skipLoops() {
  const auto& steps = m_script.steps();
  while (m_at < steps.size()) {
    const BotStep& step = steps[m_at];
    if (step.kind == BotStep::Kind::kLoop) {
      m_rounds.push_back(step.count);
      ++m_at;
    } else if (step.kind == BotStep::Kind::kEndLoop) {
      if (--m_rounds.back() > 0) {
        m_at = step.target + 1;
      } else {
        m_rounds.pop_back();
        ++m_at;
      }
    } else if (step.kind == BotStep::Kind::kRestart) {
      m_at = 0;
    } else {
      return;
    }
  }
}

RandomPlayer::RandomPlayer(std::uint64_t seed, int view_width, int view_height)
    : m_random(seed), m_width(std::max(view_width, 1)), m_height(std::max(view_height, 1)) {}

// Does not use std::uniform_int_distribution, because its results differ between standard libraries.
int RandomPlayer::below(int limit) {
  return static_cast<int>(m_random() % static_cast<std::uint64_t>(limit));
}

std::vector<BotAction> RandomPlayer::tick() {
  static constexpr std::array<Key, 12> kKeys = {SPACE, SPACE, LEFTARROW, RIGHTARROW, UPARROW, DOWNARROW,
                                                W,     A,     S,         D,          RETURN,  SPACE};
  std::vector<BotAction> out;
  if (holdOrRelease(m_down, m_remaining-- > 0, out)) return out;
  m_remaining = 1 + below(12);
  const int choice = below(10);
  if (choice < 6) {
    m_down = kKeys[static_cast<std::size_t>(below(static_cast<int>(kKeys.size())))];
    out.emplace_back(KeyAction{m_down, df::KEY_PRESSED});
  } else if (choice < 9) {
    out.emplace_back(BotClick{df::CLICKED, df::Mouse::LEFT, below(m_width), below(m_height)});
  }
  return out;
}

std::optional<df::Keyboard::Key> keyByName(const std::string& name) {
  std::string upper;
  for (const char c : name) upper.push_back(static_cast<char>(std::toupper(static_cast<unsigned char>(c))));
  if (upper.size() == 1 && upper[0] >= '0' && upper[0] <= '9') upper = std::string("NUM") + upper;
  std::istringstream names{std::string(kKeyNames)};
  int key = 0;
  for (std::string one; names >> one; ++key) {
    if (one == upper) return static_cast<df::Keyboard::Key>(key);
  }
  return std::nullopt;
}

/// Parses a script statement by statement, with a stack of open loops.
class BotScriptParser {
 public:
  explicit BotScriptParser(const std::string& text) : m_text(text) {}

  std::variant<BotScript, ScriptError> run() {
    while (!m_error && skipToStatement()) statement();
    if (!m_error && !m_loops.empty()) fail("'}' is missing at the end of a repeat");
    if (!m_error && m_script.m_steps.empty()) fail("the script has no statements");
    if (m_error) return *m_error;
    return std::move(m_script);
  }

 private:
  bool atEnd() const { return m_at >= m_text.size(); }
  char here() const { return m_text[m_at]; }

  void advance() {
    if (here() == '\n') {
      ++m_line;
      m_column = 0;
    }
    ++m_at;
    ++m_column;
  }

  void markWord() {
    m_word_line = m_line;
    m_word_column = m_column;
  }

  /// Records an error at the last marked word, unless an error was recorded already.
  void fail(const std::string& message) {
    if (!m_error) m_error = ScriptError{m_word_line, m_word_column, message};
  }

  /// Skips blanks, separators and comments. Returns false at the end of the script.
  bool skipToStatement() {
    while (!atEnd()) {
      if (here() == '#') {
        while (!atEnd() && here() != '\n') advance();
      } else if (isSpace(here()) || here() == ';' || here() == '\n') {
        advance();
      } else {
        markWord();
        return true;
      }
    }
    markWord();
    return false;
  }

  /// Returns the next word of the statement; empty at its end.
  std::string word() {
    while (!atEnd() && isSpace(here())) advance();
    markWord();
    std::string text;
    while (!atEnd() && !isSpace(here()) && !endsStatement(here()) && here() != '{') {
      text.push_back(here());
      advance();
    }
    return text;
  }

  int number(const char* what, int least, int most) {
    const auto value = readNumber(word(), least, most);
    if (!value)
      fail(std::string(what) + " must be a number from " + std::to_string(least) + " to " +
           std::to_string(most));
    return value.value_or(least);
  }

  df::Keyboard::Key key() {
    const std::string name = word();
    const auto found = keyByName(name);
    if (!found)
      fail(name.empty() ? "the name of a key is missing" : std::string("there is no key ") + quoted(name));
    return found.value_or(df::Keyboard::UNDEFINED_KEY);
  }

  void statement() {
    if (here() == '}') return endLoop();
    const std::string verb = word();
    BotStep step;
    using Kind = BotStep::Kind;
    if (verb == "press") {
      step.kind = Kind::kPress;
      step.key = key();
    } else if (verb == "hold") {
      step.kind = Kind::kHold;
      step.key = key();
      step.count = number("the number of ticks", 1, kMaxCount);
    } else if (verb == "wait") {
      step.kind = Kind::kWait;
      step.count = number("the number of ticks", 1, kMaxCount);
    } else if (verb == "click" || verb == "move") {
      step.kind = verb == "click" ? Kind::kClick : Kind::kMove;
      step.x = number("the column", 0, kMaxViewWidth - 1);
      step.y = number("the row", 0, kMaxViewHeight - 1);
      if (verb == "click") step.button = button();
    } else if (verb == "chat") {
      step.kind = Kind::kChat;
      step.text = restOfStatement();
      if (step.text.empty()) fail("chat requires a text");
    } else if (verb == "repeat") {
      return repeat();
    } else {
      return fail(quoted(verb.empty() ? std::string(1, here()) : verb) +
                  " is not a statement: expected press, hold, wait, click, move, chat or repeat");
    }
    finish(std::move(step));
  }

  df::Mouse::Button button() {
    const std::string name = word();
    if (name == "right") return df::Mouse::RIGHT;
    if (name == "middle") return df::Mouse::MIDDLE;
    if (!name.empty() && name != "left") fail("invalid button: expected left, right or middle");
    return df::Mouse::LEFT;
  }

  std::string restOfStatement() {
    while (!atEnd() && isSpace(here())) advance();
    markWord();
    std::string text;
    // Inside a repeat, '}' ends the text as it ends every other statement.
    while (!atEnd() && here() != ';' && here() != '\n' && (here() != '}' || m_loops.empty())) {
      text.push_back(here());
      advance();
    }
    text.erase(text.find_last_not_of(" \t\r") + 1);
    return text;
  }

  void repeat() {
    const std::size_t at = m_at;
    const int line = m_line;
    const int column = m_column;
    if (word().empty() && (atEnd() || here() != '{')) {
      const bool something =
          std::any_of(m_script.m_steps.begin(), m_script.m_steps.end(),
                      [](const BotStep& step) { return step.kind != BotStep::Kind::kLoop; });
      if (!m_loops.empty() || !something)
        return fail("repeat without a number must follow a statement, outside other repeats");
      finish({.kind = BotStep::Kind::kRestart});
      if (!m_error && skipToStatement()) fail("nothing can follow a repeat without a number");
      return;
    }
    m_at = at;
    m_line = line;
    m_column = column;
    BotStep step{.kind = BotStep::Kind::kLoop, .count = number("the number of rounds", 1, kMaxCount)};
    if (m_error) return;
    word();
    if (atEnd() || here() != '{') return fail("'{' is missing after repeat N");
    advance();
    if (m_loops.size() >= kMaxDepth) return fail("repeats are nested too deep");
    m_loops.push_back(m_script.m_steps.size());
    m_script.m_steps.push_back(std::move(step));
  }

  void endLoop() {
    advance();
    if (m_loops.empty()) return fail("'}' without a repeat");
    // An empty loop would spin without a tick.
    if (m_loops.back() + 1 == m_script.m_steps.size()) return fail("a repeat needs a statement");
    m_script.m_steps.push_back({.kind = BotStep::Kind::kEndLoop, .target = m_loops.back()});
    m_loops.pop_back();
  }

  void finish(BotStep step) {
    const std::string rest = word();
    if (!rest.empty() || (!atEnd() && here() == '{')) fail(quoted(rest) + " is unexpected here");
    if (m_script.m_steps.size() >= kMaxSteps) fail("the script is too long");
    m_script.m_steps.push_back(std::move(step));
  }

  const std::string& m_text;
  std::size_t m_at = 0;
  int m_line = 1;
  int m_column = 1;
  int m_word_line = 1;
  int m_word_column = 1;
  std::vector<std::size_t> m_loops;
  std::optional<ScriptError> m_error;
  BotScript m_script;
};

std::variant<BotScript, ScriptError> BotScript::parse(const std::string& text) {
  return BotScriptParser(text).run();
}

}  // namespace naiad

#include "client/terminal/TerminalType.h"

#include <curses.h>
#include <term.h>
#include <unistd.h>

#include <cstdlib>
#include <stdexcept>

#include "shared/values/Canvas.h"

namespace naiad {
namespace {

constexpr std::size_t kMaxShown = 40;

enum class Kind { kUnknown, kCannotDraw, kDraws };

Kind kindOf(const std::string& name) {
  int error = 0;
  TERMINAL* const p_before = cur_term;
  if (setupterm(const_cast<char*>(name.c_str()), STDOUT_FILENO, &error) != OK) {
    return error == 1 ? Kind::kCannotDraw : Kind::kUnknown;  // 1: a hardcopy terminal
  }
  const char* p_move = tigetstr(const_cast<char*>("cup"));
  const bool moves = p_move != nullptr && p_move != reinterpret_cast<char*>(-1);
  TERMINAL* const p_probed = set_curterm(p_before);
  if (p_probed != nullptr && p_probed != p_before) del_curterm(p_probed);
  return moves ? Kind::kDraws : Kind::kCannotDraw;
}

/// Like kindOf(), with the compiled-in description if the system has none; TERMINFO stays set for Screen.
Kind kindWithBuiltIn(const std::string& name) {
  const Kind kind = kindOf(name);
  const char* const p_description = builtInTerminal(name);
  if (kind != Kind::kUnknown || p_description == nullptr) return kind;
  const char* const p_before = std::getenv("TERMINFO");
  const std::string before = p_before != nullptr ? p_before : "";
  setenv("TERMINFO", p_description, 1);
  const Kind built_in = kindOf(name);
  if (built_in == Kind::kDraws) return built_in;
  p_before != nullptr ? setenv("TERMINFO", before.c_str(), 1) : unsetenv("TERMINFO");
  return built_in;
}

/// Returns "TERM=NAME" for a message on the terminal itself: drawable characters only, at most kMaxShown.
std::string shown(const std::string& name) {
  std::string text = "TERM=";
  std::size_t count = 0;
  for (const char32_t ch : df::decodeUtf8(name)) {
    if (++count > kMaxShown) break;
    df::appendUtf8(text, df::isDrawable(ch) ? ch : U'?');
  }
  return text;
}

}  // namespace

TerminalType chooseTerminalType(const char* p_term) {
  const std::string term = p_term != nullptr ? p_term : "";
  if (term.empty())
    throw std::runtime_error(
        "TERM is not set. Set it to the type of this terminal, for example TERM=xterm-256color.");
  // Terminals of these types have no description, or a poor one, on purpose.
  const bool refuses = term == "dumb" || term == "unknown";
  const Kind kind = refuses ? Kind::kCannotDraw : kindWithBuiltIn(term);
  if (kind == Kind::kDraws) return {term, ""};
  if (kind == Kind::kCannotDraw) {
    throw std::runtime_error(shown(term) + " has no movable cursor: dfclient cannot draw on it.");
  }
  for (const char* p_name : {"xterm-256color", "xterm"}) {
    if (kindWithBuiltIn(p_name) == Kind::kDraws)
      return {p_name, shown(term) + " is not known on this system; using " + p_name + "."};
  }
  throw std::runtime_error(
      shown(term) +
      " is not known on this system, and neither is xterm. Install terminal descriptions (ncurses-base).");
}

}  // namespace naiad

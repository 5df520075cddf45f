// naiad_keys: the cost of methods of holding keys in the games, as lines `keys key=value ...`, or with
// --markdown as the table of docs/terminals.md.
#include <cstdio>
#include <cstring>

#include "Figures.h"

namespace naiad {
namespace {

using First = HoldRule::First;
using std::chrono::milliseconds;

const std::vector<KeyMethod>& methods() {
  static constexpr auto kStay = HoldRule::kCompanion;
  static const std::vector<KeyMethod> s_methods = {
      {"releases", {}, true},
      {"tap", {First::kTap, milliseconds(0), false}},
      {"usual", {First::kUsual, milliseconds(0), false}},
      {"learned", {First::kLearned, milliseconds(0), false}},
      {"shipped", {}},
      {"shipped-600", {First::kTap, milliseconds(600), true}},
      {"usual+", {First::kUsual, kStay, true}},
      {"learned+", {First::kLearned, kStay, true}},
      {"go", {First::kTap, milliseconds(0), true}, false, true},
  };
  return s_methods;
}

void print(const char* p_format) {
  for (const std::string& game : keyGames()) {
    for (const int pause : {250, 500}) {
      TypedKeyboard::Options keyboard;
      keyboard.pause = milliseconds(pause);
      for (const KeyMethod& method : methods()) {
        const PatternFigures p = runPatterns(game, method, keyboard);
        const PlayFigures f = playGame(game, method, keyboard);
        std::printf(p_format, game.c_str(), pause, method.name.c_str(), p.tap_over, p.hold_over, p.behind,
                    p.stalled, p.missed, f.good, f.bad);
        std::fflush(stdout);
      }
    }
  }
}

}  // namespace
}  // namespace naiad

int main(int argc, char** argv) {
  const bool markdown = argc == 2 && std::strcmp(argv[1], "--markdown") == 0;
  if (argc > 1 && !markdown) {
    std::fputs("usage: naiad_keys [--markdown]\n", stderr);
    return 2;
  }
  naiad::print(markdown ? "| %s | %d ms | `%s` | %.1f | %.1f | %.1f | %.0f | %d | %d | %d |\n"
                        : "keys game=%s pause_ms=%d method=%s tap_over=%.1f hold_over=%.1f behind=%.1f "
                          "stalled_ms=%.0f missed=%d reached=%d lost=%d\n");
  return 0;
}

// Prints the animated picture of docs/games.md: Saucer Shoot with eight pilots, as an SVG with a group for
// each frame. usage: moving-picture GAME.so >docs/page/eight-pilots.svg
#include <cstdint>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "GameTest.h"

namespace {

constexpr int kPilots = 8;
constexpr int kPictures = 36;
constexpr int kTicksPerPicture = 3;  // a tenth of a second
constexpr int kCellWidth = 8;
constexpr int kCellHeight = 16;
const char* const kColors[] = {"#555", "#f66", "#6d6", "#ee5", "#79f", "#d7d", "#5dd", "#ddd"};

/// Presses keys as a beginner would.
void pressSome(df::GameTest& game, std::mt19937& random, std::uint32_t pilot) {
  using namespace df::Keyboard;
  constexpr Key kWays[] = {UPARROW, DOWNARROW, LEFTARROW, RIGHTARROW};
  if (random() % 4 == 0) game.down(kWays[random() % 4], pilot);
  if (random() % 5 == 0) {
    for (const Key key : kWays) game.up(key, pilot);
  }
  if (random() % 6 == 0) game.down(SPACE, pilot), game.up(SPACE, pilot);
}

std::string escaped(char32_t ch) {
  if (ch == U'<') return "&lt;";
  if (ch == U'>') return "&gt;";
  if (ch == U'&') return "&amp;";
  std::string text;
  df::appendUtf8(text, ch);
  return text;
}

/// Prints a row as SVG texts: each run of cells of one colour at its position.
void printRow(const df::Canvas& canvas, int y) {
  for (int x = 0; x < canvas.width();) {
    if (canvas.at(x, y).ch == U' ') {
      ++x;
      continue;
    }
    const df::Color color = canvas.at(x, y).color;
    const int begin = x;
    std::string text;
    for (; x < canvas.width() && canvas.at(x, y).ch != U' ' && canvas.at(x, y).color == color; ++x)
      text += escaped(canvas.at(x, y).ch);
    std::printf("<text x=\"%d\" y=\"%d\" class=\"c%d\"", begin * kCellWidth, y * kCellHeight + 12, color & 7);
    if (x > begin + 1) std::printf(" textLength=\"%d\"", (x - begin) * kCellWidth);  // for any font
    std::printf(">%s</text>", text.c_str());
  }
}

void printHead(int width, int height) {
  const double seconds = kPictures * kTicksPerPicture / 30.0;
  std::printf(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %d %d\" font-family=\"monospace\" "
      "font-size=\"13\" xml:space=\"preserve\"><style>g{opacity:0;animation:show %.2fs steps(1) infinite}"
      "@keyframes show{0%%{opacity:1}%.3f%%{opacity:0}}",
      width, height, seconds, 100.0 / kPictures);
  for (int i = 0; i < 8; ++i) std::printf(".c%d{fill:%s}", i, kColors[i]);
  for (int i = 0; i < kPictures; ++i)
    std::printf("#p%d{animation-delay:%.2fs}", i, seconds * i / kPictures - seconds);
  std::printf("</style><rect width=\"%d\" height=\"%d\" fill=\"#111\"/>\n", width, height);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return std::fputs("usage: moving-picture GAME.so\n", stderr), 2;
  df::GameTest game(argv[1], 5);
  std::mt19937 random(2);
  std::vector<std::uint32_t> pilots;
  for (int i = 0; i < kPilots; ++i) pilots.push_back(game.join("pilot " + std::to_string(i + 1)));
  game.press(df::Keyboard::P);
  const df::Canvas first = game.canvas();
  printHead(first.width() * kCellWidth, first.height() * kCellHeight);
  const auto fly = [&](int ticks) {
    for (int i = 0; i < ticks; ++i) {
      for (const std::uint32_t pilot : pilots) pressSome(game, random, pilot);
      game.tick();
    }
  };
  fly(90);
  for (int i = 0; i < kPictures; ++i) {
    fly(kTicksPerPicture);
    const df::Canvas canvas = game.canvas();
    std::printf("<g id=\"p%d\">", i);
    for (int y = 0; y < canvas.height(); ++y) printRow(canvas, y);
    std::printf("</g>\n");
  }
  std::printf("</svg>\n");
  return game.isOver() ? 1 : 0;
}

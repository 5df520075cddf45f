// naiad_scene_curses: the scene as an ordinary terminal program, for ssh and mosh.
//
// It draws 30 times a second, and at once after a key. It writes its pictures to a Truth.
#include <curses.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <clocale>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "../../Guarded.h"
#include "../Monotonic.h"
#include "../SharedFile.h"
#include "Crowd.h"
#include "Status.h"
#include "Truth.h"

namespace {

using namespace bench::path;

constexpr Nanoseconds kTick{static_cast<std::int64_t>(1e9 / kTicksPerSecond)};

class Screen {
 public:
  Screen() {
    std::setlocale(LC_ALL, "");
    initscr();
    cbreak();
    noecho();
    writeWhole();
    nodelay(stdscr, TRUE);
    keypad(stdscr, TRUE);
    set_escdelay(20);
    curs_set(0);
    start_color();
    // Black background, the default of curses programs. White (7) is pair 0.
    for (short color = 1; color < 7; ++color) init_pair(color, color, COLOR_BLACK);
  }
  ~Screen() { endwin(); }
  Screen(const Screen&) = delete;
  Screen& operator=(const Screen&) = delete;

  void show(const Picture& scene, char echo, std::uint32_t arrows) {
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) put(x, y, scene.at(x, y));
    }
    put(kEchoColumn, kStatusRow, {echo, kStatusColor});
    // The marker is on one of the four corner cells. The others are cleared.
    for (std::uint32_t corner = 0; corner < 4; ++corner) putMarker(corner, corner == arrows % 4 ? '@' : ' ');
    refresh();
  }

 private:
  /// Keeps the terminal driver from splitting curses' output at every line feed and backspace, because each
  /// piece may become a separate packet.
  static void writeWhole() {
    nonl();
    termios modes{};
    tcgetattr(STDOUT_FILENO, &modes);
    modes.c_oflag &= ~static_cast<tcflag_t>(OPOST);
    tcsetattr(STDOUT_FILENO, TCSANOW, &modes);
  }
  static void put(int x, int y, Cell cell) {
    // A character added to the last cell would scroll the screen; insch() does not.
    const chtype ch = static_cast<chtype>(static_cast<unsigned char>(cell.ch)) | COLOR_PAIR(cell.color % 7);
    if (x == kWidth - 1 && y == kHeight - 1) {
      mvinsch(y, x, ch);
    } else {
      mvaddch(y, x, ch);
    }
  }
  static void putMarker(std::uint32_t arrows, char ch) {
    const MarkerCell cell = markerAfter(arrows);
    put(cell.x, cell.y, {ch, kStatusColor});
  }
};

/// Waits for a key until the deadline. False if the terminal is closed.
bool waitForKey(Nanoseconds deadline) {
  const Nanoseconds left = deadline - monotonicNow();
  pollfd input{0, POLLIN, 0};
  const timespec timeout = toTimespec(left > Nanoseconds(0) ? left : Nanoseconds(0));
  if (ppoll(&input, 1, &timeout, nullptr) <= 0) return true;
  return (input.revents & (POLLHUP | POLLERR)) == 0;
}

void run(Truth& truth, std::uint64_t seed) {
  Crowd crowd(seed);
  Screen screen;
  Picture scene;
  char echo = kNoKey;
  std::uint32_t arrows = 0;
  Nanoseconds next = monotonicNow();
  while (waitForKey(next)) {
    bool changed = false;
    for (int key = getch(); key != ERR; key = getch()) {
      changed = true;
      if (key >= 'a' && key <= 'z') echo = static_cast<char>(key);
      if (key == KEY_RIGHT || key == KEY_DOWN || key == KEY_LEFT || key == KEY_UP) ++arrows;
    }
    const Nanoseconds now = monotonicNow();
    if (now >= next) {
      crowd.tick();
      scene = drawScene(crowd);
      truth.publish(crowd.ticks(), now, scene);
      changed = true;
      // If this is a whole tick late, because the terminal did not accept the bytes, the next tick is due a
      // tick from now.
      next = now - next > kTick ? now + kTick : next + kTick;
    }
    if (changed) screen.show(scene, echo, arrows);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: naiad_scene_curses TRUTH_FILE SEED\n");
    return 2;
  }
  return bench::guarded("naiad_scene_curses", [argv] {
    const auto truth = SharedFile<Truth>::create(argv[1]);
    run(*truth, std::strtoull(argv[2], nullptr, 10));
    return 0;
  });
}

#include "client/terminal/HiddenLine.h"

#include <fcntl.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>

namespace naiad {
namespace {

constexpr std::size_t kMaxLine = 255;  // bytes
constexpr char kControlC = 3;

void write(int terminal, const std::string& text) {
  // Errors are ignored: if the terminal is gone, reading fails as well.
  if (::write(terminal, text.data(), text.size()) < 0) return;
}

std::optional<std::string> readLine(int terminal) {
  std::string line;
  line.reserve(kMaxLine + 1);  // an exception would leave the terminal without echo
  for (char c = 0; line.size() <= kMaxLine;) {
    const ssize_t size = ::read(terminal, &c, 1);
    if (size < 0 && errno == EINTR) continue;
    if (size != 1 || c == kControlC) return std::nullopt;
    if (c == '\n') return line;
    line.push_back(c);
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> readHiddenLine(const std::string& prompt) {
  const int terminal = ::open("/dev/tty", O_RDWR | O_NOCTTY | O_CLOEXEC);
  if (terminal < 0) return std::nullopt;
  std::optional<std::string> line;
  termios before{};
  const bool is_known = tcgetattr(terminal, &before) == 0;
  termios modes = before;
  // Switches off the keyboard's signals, too: one would end the process and leave the terminal without echo.
  modes.c_lflag &= ~static_cast<tcflag_t>(ECHO | ISIG);
  modes.c_cc[VEOL] = kControlC;  // Ctrl-C ends the line at once
  if (is_known && tcsetattr(terminal, TCSAFLUSH, &modes) == 0) {
    write(terminal, prompt);
    line = readLine(terminal);
    write(terminal, "\n");
    tcsetattr(terminal, TCSAFLUSH, &before);
  }
  ::close(terminal);
  return line;
}

}  // namespace naiad

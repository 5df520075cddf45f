#include "client/terminal/HiddenLine.h"

#include <fcntl.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>

namespace naiad {
namespace {

constexpr std::size_t kMaxLine = 255;  // bytes
constexpr char kControlC = 3;

/// Switches off the terminal's echo and the keyboard's signals until it is destroyed, because a signal would
/// end the process and leave the terminal without echo.
class EchoOff {
 public:
  explicit EchoOff(int terminal) : m_terminal(terminal) {
    m_changed = tcgetattr(terminal, &m_before) == 0;
    termios modes = m_before;
    modes.c_lflag &= ~static_cast<tcflag_t>(ECHO | ISIG);
    modes.c_cc[VEOL] = kControlC;  // Ctrl-C ends the line at once
    m_changed = m_changed && tcsetattr(terminal, TCSAFLUSH, &modes) == 0;
  }
  ~EchoOff() {
    if (m_changed) tcsetattr(m_terminal, TCSAFLUSH, &m_before);
  }
  EchoOff(const EchoOff&) = delete;
  EchoOff& operator=(const EchoOff&) = delete;
  bool isOn() const { return m_changed; }

 private:
  int m_terminal;
  bool m_changed = false;
  termios m_before{};
};

void write(int terminal, const std::string& text) {
  // Errors are ignored: if the terminal is gone, reading fails as well.
  if (::write(terminal, text.data(), text.size()) < 0) return;
}

std::optional<std::string> readLine(int terminal) {
  std::string line;
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
  {
    const EchoOff echo_off(terminal);
    if (echo_off.isOn()) {
      write(terminal, prompt);
      line = readLine(terminal);
      write(terminal, "\n");
    }
  }
  ::close(terminal);
  return line;
}

}  // namespace naiad

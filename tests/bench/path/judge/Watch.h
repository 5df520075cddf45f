// A simulated person at a terminal in which a program runs.
#pragma once

#include <poll.h>
#include <pty.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "../Monotonic.h"
#include "../scene/Picture.h"
#include "../scene/Status.h"
#include "EchoJudge.h"
#include "FrameJudge.h"
#include "Terminal.h"
#include "tests/bench/Process.h"

namespace bench::path {

/// A program that runs in a terminal of 80×24 cells.
class PtyProgram {
 public:
  /// Starts the program with TERM=xterm-256color. Throws std::runtime_error.
  explicit PtyProgram(const std::vector<std::string>& command) : m_buffer(65536) {
    winsize size{};
    size.ws_col = kWidth;
    size.ws_row = kHeight;
    m_pid = forkpty(&m_terminal, nullptr, nullptr, &size);
    if (m_pid < 0) throw std::runtime_error("there is no terminal to be had");
    if (m_pid == 0) becomeCommand(command);
  }
  /// Closes the terminal, and kills the program if it does not end.
  ~PtyProgram() {
    close(m_terminal);
    kill(m_pid, SIGHUP);
    for (int i = 0; i < 50; ++i) {
      if (waitpid(m_pid, nullptr, WNOHANG) != 0) return;
      usleep(10'000);
    }
    kill(m_pid, SIGKILL);
    waitpid(m_pid, nullptr, 0);
  }
  PtyProgram(const PtyProgram&) = delete;
  PtyProgram& operator=(const PtyProgram&) = delete;

  /// Returns the next output; empty at the deadline, or when the program has ended.
  std::string_view read(Nanoseconds deadline) {
    pollfd terminal{m_terminal, POLLIN, 0};
    const timespec timeout = toTimespec(std::max(deadline - monotonicNow(), Nanoseconds(0)));
    if (ppoll(&terminal, 1, &timeout, nullptr) <= 0) return {};
    const ssize_t size = ::read(m_terminal, m_buffer.data(), m_buffer.size());
    if (size > 0) return {m_buffer.data(), static_cast<std::size_t>(size)};
    if (size == 0 || (errno != EINTR && errno != EAGAIN)) m_ended = true;
    return {};
  }
  bool hasEnded() const { return m_ended; }
  /// Types these bytes.
  void write(std::string_view bytes) const {
    while (!bytes.empty()) {
      const ssize_t size = ::write(m_terminal, bytes.data(), bytes.size());
      if (size <= 0) return;  // the program has ended, which read() notices
      bytes.remove_prefix(static_cast<std::size_t>(size));
    }
  }

 private:
  [[noreturn]] static void becomeCommand(const std::vector<std::string>& command) {
    setenv("TERM", "xterm-256color", 1);
    setenv("LC_ALL", "C.UTF-8", 1);
    std::vector<char*> argv = argvOf(command);
    execvp(argv[0], argv.data());
    _exit(127);
  }

  int m_terminal = -1;
  pid_t m_pid = -1;
  bool m_ended = false;
  std::vector<char> m_buffer;
};

/// Presses keys at random times: letters, and arrows if requested.
class Typist {
 public:
  /// Mean time between two keys, distributed evenly between 0 and twice this.
  static constexpr Nanoseconds kMeanLetterGap{200'000'000};
  static constexpr Nanoseconds kMeanArrowGap{600'000'000};

  Typist(std::uint64_t seed, bool arrows, Nanoseconds now) : m_random(seed), m_arrows(arrows) {
    m_letter = now + gap(kMeanLetterGap);
    m_arrow = now + gap(kMeanArrowGap);
  }

  enum class Key { kLetter, kArrow };
  /// Returns a key that is due. Call again until it returns nullopt.
  std::optional<Key> due(Nanoseconds now) {
    if (now >= m_letter) {
      m_letter = now + gap(kMeanLetterGap);
      return Key::kLetter;
    }
    if (m_arrows && now >= m_arrow) {
      m_arrow = now + gap(kMeanArrowGap);
      return Key::kArrow;
    }
    return std::nullopt;
  }
  /// Returns when the next key is due.
  Nanoseconds next() const { return m_arrows && m_arrow < m_letter ? m_arrow : m_letter; }

 private:
  Nanoseconds gap(Nanoseconds mean) {
    const double share = std::generate_canonical<double, 53>(m_random);
    return Nanoseconds(static_cast<std::int64_t>(2 * share * static_cast<double>(mean.count())));
  }

  std::mt19937_64 m_random;
  bool m_arrows;
  Nanoseconds m_letter{};
  Nanoseconds m_arrow{};
};

/// A simulated person at the terminal. Types, and records when each frame and each key appears on the screen.
class Watch {
 public:
  /// Types `first_keys` once the scene is on the screen. The other arguments must outlive the watch.
  Watch(PtyProgram& program, Terminal& terminal, const Truth& truth, const Typist& typist,
        std::string first_keys)
      : m_program(program),
        m_terminal(terminal),
        m_frames(truth),
        m_typist(typist),
        m_first_keys(std::move(first_keys)) {}

  /// Watches until a frame counts, at most until `end`. Throws std::runtime_error if the program ends.
  void untilShown(Nanoseconds end) {
    while (monotonicNow() < end && m_frames.shown().empty()) lookUntil(end);
  }
  /// Types and watches. Throws std::runtime_error if the program ends.
  void until(Nanoseconds end) {
    while (monotonicNow() < end) {
      type();
      lookUntil(std::min(end, m_typist.next()));
    }
  }

  const FrameJudge& frames() const { return m_frames; }
  const EchoJudge& letters() const { return m_letters; }
  const EchoJudge& arrows() const { return m_arrows; }

 private:
  /// Waits for output of the program until `end`, and processes it.
  void lookUntil(Nanoseconds end) {
    const std::string_view bytes = m_program.read(end);
    if (m_program.hasEnded()) throw std::runtime_error("the program has ended");
    if (!bytes.empty()) look(bytes);
  }
  /// Processes output frame by frame, because it may contain several frames.
  void look(std::string_view bytes) {
    const Nanoseconds now = monotonicNow();
    Picture screen;
    while (!bytes.empty()) {
      bytes = m_terminal.feed(bytes);
      screen = m_terminal.picture();
      m_frames.look(screen, now);
    }
    m_program.write(m_terminal.takeAnswers());
    if (counterIn(screen)) m_program.write(std::exchange(m_first_keys, {}));
    const char echo = screen.at(kEchoColumn, kStatusRow).ch;
    if (echo >= 'a' && echo <= 'z') m_letters.look(static_cast<std::uint32_t>(echo - 'a'), now);
    // After n arrows the marker is on corner n, and the last arrow was number n - 1.
    if (const auto marker = markerIn(screen)) m_arrows.look((*marker + 3) % 4, now);
  }
  void type() {
    const Nanoseconds now = monotonicNow();
    const auto key = m_typist.due(now);
    if (!key) return;
    if (*key == Typist::Key::kLetter) {
      const char letter = static_cast<char>('a' + m_letters.press(now) % 26);
      m_program.write({&letter, 1});
    } else {
      m_terminal.pressArrow(m_arrows.press(now));
      m_program.write(m_terminal.takeAnswers());
    }
  }

  PtyProgram& m_program;
  Terminal& m_terminal;
  FrameJudge m_frames;
  Typist m_typist;
  std::string m_first_keys;
  EchoJudge m_letters{26};
  EchoJudge m_arrows{4};
};

}  // namespace bench::path

// A simulated person at the terminal. Types, and records when each frame and each key appears on the screen.
#pragma once

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "../scene/Status.h"
#include "EchoJudge.h"
#include "FrameJudge.h"
#include "PtyProgram.h"
#include "Terminal.h"
#include "Typist.h"

namespace bench::path {

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

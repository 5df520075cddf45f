// Somebody at the terminal: types, and notes what comes onto the screen when.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "EchoJudge.h"
#include "FrameJudge.h"
#include "PtyProgram.h"
#include "Terminal.h"
#include "Typist.h"

namespace bench::path {

class Watch {
 public:
  /// `first_keys` are typed when the scene is on the screen. All others outlive the watch.
  Watch(PtyProgram& program, Terminal& terminal, const Truth& truth, const Typist& typist,
        std::string first_keys);

  /// Only look, until a frame counts; no longer than `end`. Throws std::runtime_error if the program ends.
  void untilShown(Nanoseconds end);
  /// Type and look. Throws std::runtime_error if the program ends.
  void until(Nanoseconds end);

  const FrameJudge& frames() const { return m_frames; }
  const EchoJudge& letters() const { return m_letters; }
  const EchoJudge& arrows() const { return m_arrows; }

 private:
  void lookUntil(Nanoseconds end);
  void look(std::string_view bytes);
  void type();

  PtyProgram& m_program;
  Terminal& m_terminal;
  FrameJudge m_frames;
  Typist m_typist;
  std::string m_first_keys;
  EchoJudge m_letters{26};
  EchoJudge m_arrows{4};
};

}  // namespace bench::path

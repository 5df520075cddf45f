// A terminal emulator (libvterm) that shows what a person would see.
#pragma once

#include <vterm.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "../scene/Picture.h"

namespace bench::path {

class Terminal {
 public:
  Terminal();

  /// Processes output of the program up to the byte that changes the counter, that is, its row left of the
  /// echo. Returns the rest of the output; "" if all was processed.
  std::string_view feed(std::string_view bytes);
  /// Returns the screen. Characters outside ASCII become '?'; the default colour counts as white.
  Picture picture() const;
  /// Presses arrow key `n` of the sequence right, down, left, up, right and so on. takeAnswers() then returns
  /// its bytes.
  void pressArrow(std::uint32_t n);
  /// Returns the terminal's bytes for the program since the last call: answers to queries, and arrow keys in
  /// the mode that the program has set.
  std::string takeAnswers();

 private:
  struct Free {
    void operator()(VTerm* p_term) const { vterm_free(p_term); }
  };
  static void collect(const char* bytes, std::size_t size, void* p_answers);
  static int noteDamage(VTermRect where, void* p_touched);

  bool m_touched = false;  // the counter has changed
  std::string m_answers;
  std::unique_ptr<VTerm, Free> m_term;
  VTermScreen* m_screen;
};

}  // namespace bench::path

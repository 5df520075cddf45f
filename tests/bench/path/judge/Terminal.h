// A terminal emulator (libvterm): what a person would see after these bytes.
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

  /// The program wrote these bytes: take in all up to one that changes the counter's row left of the echo, or
  /// all of them. Returns what is left.
  std::string_view feed(std::string_view bytes);
  /// A character that is no ASCII becomes '?'; the default colour counts as white.
  Picture picture() const;
  /// Press the n-th of right, down, left, up, right, …; see takeAnswers().
  void pressArrow(std::uint32_t n);
  /// What the terminal sends to the program since the last call: answers to queries, arrow keys as the
  /// program has asked for them.
  std::string takeAnswers();

 private:
  struct Free {
    void operator()(VTerm* p_term) const { vterm_free(p_term); }
  };
  static void collect(const char* bytes, std::size_t size, void* p_answers);
  static int noteDamage(VTermRect where, void* p_touched);

  bool m_touched = false;  // the counter
  std::string m_answers;
  std::unique_ptr<VTerm, Free> m_term;
  VTermScreen* m_screen;
};

}  // namespace bench::path

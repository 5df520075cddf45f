// A terminal emulator (libvterm) that shows what a person would see.
#pragma once

#include <vterm.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "../scene/Status.h"

namespace bench::path {

class Terminal {
 public:
  Terminal() : m_term(vterm_new(kHeight, kWidth)), m_screen(vterm_obtain_screen(m_term.get())) {
    m_callbacks.damage = &Terminal::noteDamage;
    vterm_set_utf8(m_term.get(), 1);
    vterm_output_set_callback(m_term.get(), &Terminal::collect, &m_answers);
    vterm_screen_set_callbacks(m_screen, &m_callbacks, &m_touched);
    vterm_screen_set_damage_merge(m_screen, VTERM_DAMAGE_CELL);
    vterm_screen_enable_altscreen(m_screen, 1);
    vterm_screen_reset(m_screen, 1);
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  /// Processes output of the program up to the byte that changes the counter, that is, its row left of the
  /// echo. Returns the rest of the output; "" if all was processed.
  std::string_view feed(std::string_view bytes) {
    m_touched = false;
    while (!bytes.empty() && !m_touched) {
      vterm_input_write(m_term.get(), bytes.data(), 1);
      bytes.remove_prefix(1);
    }
    return bytes;
  }
  /// Returns the screen. Characters outside ASCII become '?'; the default colour counts as white.
  Picture picture() const {
    Picture picture;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        VTermScreenCell cell;
        vterm_screen_get_cell(m_screen, {y, x}, &cell);
        const std::uint32_t ch = cell.chars[0];
        if (ch == 0 || ch == ' ') continue;
        picture.at(x, y) = {ch < 0x7F ? static_cast<char>(ch) : '?', colorOf(cell.fg)};
      }
    }
    return picture;
  }
  /// Presses arrow key `n` of the sequence right, down, left, up, right and so on. takeAnswers() then returns
  /// its bytes.
  void pressArrow(std::uint32_t n) {
    static constexpr std::array<VTermKey, 4> kArrows = {VTERM_KEY_RIGHT, VTERM_KEY_DOWN, VTERM_KEY_LEFT,
                                                        VTERM_KEY_UP};
    vterm_keyboard_key(m_term.get(), kArrows[n % kArrows.size()], VTERM_MOD_NONE);
  }
  /// Returns the terminal's bytes for the program since the last call: answers to queries, and arrow keys in
  /// the mode that the program has set.
  std::string takeAnswers() { return std::exchange(m_answers, {}); }

 private:
  struct Free {
    void operator()(VTerm* p_term) const { vterm_free(p_term); }
  };
  /// Returns the colour's number. A bright colour counts as its plain form, because dfclient draws blue
  /// bright where possible: plain blue on black is hard to read.
  static std::uint8_t colorOf(const VTermColor& color) {
    constexpr std::uint8_t kWhite = 7, kColors = 8;
    if (VTERM_COLOR_IS_DEFAULT_FG(&color) || !VTERM_COLOR_IS_INDEXED(&color)) return kWhite;
    const std::uint8_t index = color.indexed.idx;
    return index < 2 * kColors ? index % kColors : index;
  }
  static void collect(const char* bytes, std::size_t size, void* p_answers) {
    static_cast<std::string*>(p_answers)->append(bytes, size);
  }
  static int noteDamage(VTermRect where, void* p_touched) {
    if (where.end_row > kStatusRow && where.start_col < kEchoColumn) *static_cast<bool*>(p_touched) = true;
    return 1;
  }

  bool m_touched = false;  // the counter has changed
  std::string m_answers;
  VTermScreenCallbacks m_callbacks{};
  std::unique_ptr<VTerm, Free> m_term;
  VTermScreen* m_screen;
};

}  // namespace bench::path

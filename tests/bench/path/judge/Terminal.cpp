#include "Terminal.h"

#include <array>
#include <utility>

#include "../scene/Status.h"

namespace bench::path {
namespace {

constexpr std::uint8_t kWhite = 7;
constexpr std::uint8_t kColors = 8;  // colours of the game; their eight bright forms follow

/// Returns the colour's number. A bright colour counts as its plain form, because dfclient draws blue bright
/// where possible: plain blue on black is hard to read.
std::uint8_t colorOf(const VTermColor& color) {
  if (VTERM_COLOR_IS_DEFAULT_FG(&color) || !VTERM_COLOR_IS_INDEXED(&color)) return kWhite;
  const std::uint8_t index = color.indexed.idx;
  return index < 2 * kColors ? index % kColors : index;
}

VTermScreenCallbacks callbacks(int (*damage)(VTermRect, void*)) {
  VTermScreenCallbacks result{};
  result.damage = damage;
  return result;
}

}  // namespace

Terminal::Terminal() : m_term(vterm_new(kHeight, kWidth)), m_screen(vterm_obtain_screen(m_term.get())) {
  static const VTermScreenCallbacks kCallbacks = callbacks(&Terminal::noteDamage);
  vterm_set_utf8(m_term.get(), 1);
  vterm_output_set_callback(m_term.get(), &Terminal::collect, &m_answers);
  vterm_screen_set_callbacks(m_screen, &kCallbacks, &m_touched);
  vterm_screen_set_damage_merge(m_screen, VTERM_DAMAGE_CELL);
  vterm_screen_enable_altscreen(m_screen, 1);
  vterm_screen_reset(m_screen, 1);
}

void Terminal::collect(const char* bytes, std::size_t size, void* p_answers) {
  static_cast<std::string*>(p_answers)->append(bytes, size);
}

int Terminal::noteDamage(VTermRect where, void* p_touched) {
  if (where.end_row > kStatusRow && where.start_col < kEchoColumn) *static_cast<bool*>(p_touched) = true;
  return 1;
}

std::string_view Terminal::feed(std::string_view bytes) {
  m_touched = false;
  while (!bytes.empty() && !m_touched) {
    vterm_input_write(m_term.get(), bytes.data(), 1);
    bytes.remove_prefix(1);
  }
  return bytes;
}

Picture Terminal::picture() const {
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

void Terminal::pressArrow(std::uint32_t n) {
  static constexpr std::array<VTermKey, 4> kArrows = {VTERM_KEY_RIGHT, VTERM_KEY_DOWN, VTERM_KEY_LEFT,
                                                      VTERM_KEY_UP};
  vterm_keyboard_key(m_term.get(), kArrows[n % kArrows.size()], VTERM_MOD_NONE);
}

std::string Terminal::takeAnswers() {
  return std::exchange(m_answers, {});
}

}  // namespace bench::path

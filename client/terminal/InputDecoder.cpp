#include "client/terminal/InputDecoder.h"

#include <algorithm>
#include <array>
#include <utility>

#include "client/terminal/KeyTable.h"
#include "shared/values/Canvas.h"

namespace naiad {
namespace {

constexpr std::size_t kMaxParameters = 48;
constexpr int kMaxNumber = 1 << 24;
constexpr int kMaxCell = 9999;

bool isText(int code) {
  return code >= 0x20 && code != 0x7F && !(code >= 0x80 && code < 0xA0) && code <= 0x10FFFF &&
         !(code >= 0xD800 && code <= 0xDFFF) && !(code >= 0xE000 && code <= 0xF8FF);
}

}  // namespace

/// The numbers of `a:b:c;d:e;…`: up to six fields of up to three parts; −1 for missing parts.
struct InputDecoder::Numbers {
  std::array<std::array<int, 3>, 6> field{};
  bool well_formed = true;

  explicit Numbers(std::string_view text) {
    for (auto& parts : field) parts.fill(-1);
    std::size_t f = 0;
    std::size_t p = 0;
    for (const char c : text) {
      if (c >= '0' && c <= '9') {
        if (f >= field.size() || p >= 3) continue;
        int& n = field[f][p];
        n = std::min(std::max(n, 0) * 10 + (c - '0'), kMaxNumber);
      } else if (c == ';') {
        ++f;
        p = 0;
      } else if (c == ':') {
        ++p;
      } else {
        well_formed = false;
      }
    }
  }

  /// Applies the modifiers and action in the field `modifiers:event`, which xterm and kitty share.
  void applyModifiers(KeyEvent& event) const {
    if (field[1][0] > 0) event.modifiers |= static_cast<std::uint8_t>((field[1][0] - 1) & 0x0F);
    if (field[1][1] == 2) event.action = KeyEvent::Action::kRepeat;
    if (field[1][1] == 3) event.action = KeyEvent::Action::kRelease;
  }

  /// Decodes `CSI code:shifted:base ; modifiers:event ; text u`.
  KeyEvent kittyKey() const {
    KeyEvent event;
    const auto& code = field[0];
    // On a keyboard with another script, the third part is the key in the US layout.
    event.key = keyOfKitty(code[0] > 0x7F && code[2] > 0 ? code[2] : code[0]);
    applyModifiers(event);
    // Ctrl-] opens the menu, so ']' counts on any level of the key, and by position.
    if ((event.modifiers & kControl) != 0 && (code[1] == ']' || code[2] == ']'))
      event.key = df::Keyboard::RIGHTBRACKET;
    if (event.action == KeyEvent::Action::kRelease) return event;
    if (isText(field[2][0])) {
      event.ch = static_cast<char32_t>(field[2][0]);
    } else if ((event.modifiers & (kControl | kAlt | kSuper)) == 0) {
      const int typed = (event.modifiers & kShift) != 0 && code[1] > 0 ? code[1] : code[0];
      event.ch = isText(typed) ? static_cast<char32_t>(typed) : characterOfKeypad(code[0]);
    }
    return event;
  }

  /// Decodes `CSI virtual key ; scan code ; UTF-16 unit ; down ; control keys ; repeats _` of character `ch`.
  KeyEvent windowsKey(int ch) const {
    constexpr int kRightAlt = 1;
    constexpr int kRightControl = 4;
    constexpr int kLeftControl = 8;
    const int held = std::max(field[4][0], 0);
    KeyEvent event;
    event.key = keyOfWindows(field[0][0], field[1][0], (held & 0x100) != 0);
    if (event.key == df::Keyboard::UNDEFINED_KEY && ch > 0)
      event = ch < 0x20 ? keyOfControl(static_cast<unsigned char>(ch))
                        : KeyEvent{keyOfCharacter(static_cast<char32_t>(ch)).key};
    // Ctrl-], typed with AltGr in some layouts; without the right Control, AltGr alone types ']'.
    if (ch == 0x1D || (ch == ']' && (held & kRightControl) != 0)) {
      event = keyOfControl(0x1D);
      if (field[3][0] <= 0) event.action = KeyEvent::Action::kRelease;
      return event;
    }
    if ((held & 0x10) != 0) event.modifiers |= kShift;
    // Windows reports AltGr, which types characters, as right Alt and left Control.
    const bool alt_gr = (held & kRightAlt) != 0 && (held & kLeftControl) != 0 && isText(ch);
    if (!alt_gr && (held & 0x0C) != 0) event.modifiers |= kControl;
    if (!alt_gr && (held & 0x03) != 0) event.modifiers |= kAlt;
    if (field[3][0] <= 0) {
      event.action = KeyEvent::Action::kRelease;
    } else if (isText(ch) && (event.modifiers & (kControl | kAlt)) == 0) {
      event.ch = static_cast<char32_t>(ch);
    }
    return event;
  }
};

std::vector<TerminalEvent> InputDecoder::feed(std::string_view bytes, Time now) {
  Events out = flush(now);
  if (!bytes.empty()) m_last = now;
  for (const char c : bytes) decodeByte(static_cast<unsigned char>(c), out);
  return out;
}

std::vector<TerminalEvent> InputDecoder::flush(Time now) {
  Events out = m_record_decoder ? m_record_decoder->flush(now) : Events();
  const auto due = ownDeadline();
  if (!due || now < *due) return out;
  if (m_state == State::kEscape && !m_pasting) {
    if (m_meta) emitKey(out, keyOfControl(0x1B));
    emitKey(out, keyOfControl(0x1B));
  }
  endPaste(out);
  m_meta = false;
  enterState(State::kGround);
  return out;
}

std::optional<InputDecoder::Time> InputDecoder::deadline() const {
  const auto own = ownDeadline();
  const auto spelled = m_record_decoder ? m_record_decoder->deadline() : std::nullopt;
  return own && spelled ? std::min(own, spelled) : own ? own : spelled;
}

std::optional<InputDecoder::Time> InputDecoder::ownDeadline() const {
  if (m_state == State::kEscape && !m_pasting) return m_last + kEscapeDelay;
  if (m_pasting) return m_last + kPasteDelay;
  if (m_state != State::kGround) return m_last + kSequenceDelay;
  return std::nullopt;
}

void InputDecoder::enterState(State state) {
  m_state = state;
  m_overlong = false;
  m_parameters.clear();
  m_utf8.clear();
  if (state == State::kGround) m_meta = false;
}

void InputDecoder::decodeByte(unsigned char byte, Events& out) {
  switch (m_state) {
    case State::kGround:
      return decodeGround(byte, out);
    case State::kEscape:
      return decodeEscape(byte, out);
    case State::kCsi:
    case State::kSs3:
      return decodeSequence(byte, out);
    case State::kUtf8:
      return decodeUtf8Byte(byte, out);
    case State::kX10Mouse:
      return decodeX10(byte, out);
    case State::kLinuxFunction: {
      const bool known = byte >= 'A' && byte <= 'E';
      if (known) emitKey(out, {static_cast<df::Keyboard::Key>(df::Keyboard::F1 + (byte - 'A'))});
      return enterState(State::kGround);
    }
    case State::kString:
      if (byte == 0x1B) return enterState(State::kStringEscape);
      if (byte == 0x07 || byte == 0x18 || byte == 0x1A) enterState(State::kGround);
      return;
    case State::kStringEscape:
      // ST is ESC \; any other ESC ends the string and begins another sequence.
      if (byte == '\\') return enterState(State::kGround);
      enterState(State::kEscape);
      return decodeEscape(byte, out);
  }
}

void InputDecoder::decodeGround(unsigned char byte, Events& out) {
  if (byte == 0x1B) return enterState(State::kEscape);
  if (m_pasting && byte < 0x80) return addPasted(byte);
  if (byte < 0x20 || byte == 0x7F) return emitKey(out, keyOfControl(byte));
  if (byte < 0x80) return emitKey(out, keyOfCharacter(byte));
  if (byte >= 0xC2 && byte < 0xF5) {
    enterState(State::kUtf8);
    m_utf8.push_back(static_cast<char>(byte));
  }
}

void InputDecoder::decodeUtf8Byte(unsigned char byte, Events& out) {
  if ((byte & 0xC0) != 0x80) {  // an invalid character; this byte may begin a valid one
    enterState(State::kGround);
    return decodeGround(byte, out);
  }
  m_utf8.push_back(static_cast<char>(byte));
  const auto lead = static_cast<unsigned char>(m_utf8[0]);
  const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (m_utf8.size() < length) return;
  const std::u32string decoded = df::decodeUtf8(m_utf8);
  enterState(State::kGround);
  if (decoded.size() == 1 && isText(static_cast<int>(decoded[0]))) {
    if (m_pasting) return addPasted(decoded[0]);
    emitKey(out, keyOfCharacter(decoded[0]));
  }
}

void InputDecoder::decodeEscape(unsigned char byte, Events& out) {
  if (byte == '[') return enterState(State::kCsi);
  if (byte == 'O') return enterState(State::kSs3);
  if (byte == ']' || byte == 'P' || byte == 'X' || byte == '^' || byte == '_')
    return enterState(State::kString);
  // The Escape key twice, or rxvt's Alt with a cursor key.
  if (std::exchange(m_meta, true)) emitKey(out, keyOfControl(0x1B));
  if (byte == 0x1B) return;
  enterState(State::kGround);
  if (byte >= 0x80) return decodeGround(byte, out);
  KeyEvent event = byte < 0x20 || byte == 0x7F ? keyOfControl(byte) : keyOfCharacter(byte);
  event.modifiers |= kAlt;
  event.ch = 0;
  emitKey(out, event);
}

void InputDecoder::decodeSequence(unsigned char byte, Events& out) {
  if (byte == 0x1B) {
    m_meta = false;
    return enterState(State::kEscape);
  }
  if (byte == 0x18 || byte == 0x1A) return enterState(State::kGround);
  if (byte < 0x20 || byte >= 0x7F) return;
  // rxvt ends shifted editing keys with '$', which is not a final byte anywhere else.
  const bool rxvt_shift =
      byte == '$' && m_state == State::kCsi && !m_parameters.empty() &&
      std::all_of(m_parameters.begin(), m_parameters.end(), [](char c) { return c >= '0' && c <= '9'; });
  if (byte < 0x40 && !rxvt_shift) {
    if (m_parameters.size() < kMaxParameters) {
      m_parameters.push_back(static_cast<char>(byte));
    } else {
      m_overlong = true;
    }
    return;
  }
  const bool is_csi = m_state == State::kCsi;
  const bool is_empty = is_csi && m_parameters.empty();
  if (is_empty && byte == '[') return enterState(State::kLinuxFunction);
  if (is_empty && byte == 'M') return enterState(State::kX10Mouse);
  if (!m_overlong) finishSequence(byte, !is_csi, out);
  enterState(State::kGround);
}

void InputDecoder::finishSequence(unsigned char final, bool ss3, Events& out) {
  if (!ss3 && m_parameters.empty() && final == 'O' && !m_pasting) out.emplace_back(FocusLost{});
  if (!ss3 && (final == '~' || final == '^' || final == '@' || final == '$')) {
    if (final == '^' || final == '@') m_parameters += ";5";  // 5: Control. The Shift of rxvt's '@' is ignored
    if (final == '$') m_parameters += ";2";
    return finishTilde(out);
  }
  const char prefix = m_parameters.empty() ? '\0' : m_parameters[0];
  if (!ss3 && prefix == '<' && (final == 'M' || final == 'm')) {
    const Numbers numbers(std::string_view(m_parameters).substr(1));
    const auto& f = numbers.field;
    const bool complete = numbers.well_formed && f[0][0] >= 0 && f[1][0] > 0 && f[2][0] > 0;
    if (complete) emitMouse(out, f[0][0], f[1][0] - 1, f[2][0] - 1, final == 'm');
    return;
  }
  if (!ss3 && prefix == '?' && final == 'u') {
    const Numbers numbers(std::string_view(m_parameters).substr(1));
    if (numbers.well_formed && !m_pasting) out.emplace_back(KittyReply{std::max(numbers.field[0][0], 0)});
    return;
  }
  Numbers numbers(m_parameters);
  if (!numbers.well_formed) return;
  if (!ss3 && final == 'u') return emitKey(out, numbers.kittyKey());
  if (!ss3 && final == '_') return decodeKeyRecord(numbers, out);
  KeyEvent event{keyOfFinal(static_cast<char>(final), ss3)};
  // Some terminals write SS3 5 P instead of CSI 1 ; 5 P.
  if (ss3 && numbers.field[1][0] < 0) numbers.field[1][0] = numbers.field[0][0];
  numbers.applyModifiers(event);
  if (final >= 'a' && final <= 'd') event.modifiers |= ss3 ? kControl : kShift;
  if (final == 'Z') event.modifiers |= kShift;
  if (m_meta) event.modifiers |= kAlt;
  // The first number of a cursor position report is a row; that of a key is 1 or missing.
  if (ss3 || numbers.field[0][0] <= 1) emitKey(out, event);
}

void InputDecoder::finishTilde(Events& out) {
  const Numbers numbers(m_parameters);
  if (!numbers.well_formed) return;
  const int number = numbers.field[0][0];
  if (number == 200) m_pasting = true;
  if (number == 201) endPaste(out);
  KeyEvent event{keyOfTilde(number)};
  numbers.applyModifiers(event);
  if (m_meta) event.modifiers |= kAlt;
  // xterm's modifyOtherKeys: CSI 27 ; modifiers ; code ~
  if (number == 27 && numbers.field[2][0] > 0) event.key = keyOfKitty(numbers.field[2][0]);
  emitKey(out, event);
}

// Windows Terminal sends mouse reports, replies and the marks around a paste byte by byte, each byte in a key
// record without a key, and the text of a paste as records of the keys that type it. m_record_decoder decodes
// these.
void InputDecoder::decodeKeyRecord(const Numbers& numbers, Events& out) {
  if (m_is_record_decoder) return;
  if (!m_record_decoder) {
    m_record_decoder = std::make_unique<InputDecoder>();
    m_record_decoder->m_is_record_decoder = true;
  }
  const bool is_down = numbers.field[3][0] > 0;
  int ch = std::max(numbers.field[2][0], 0);
  if (ch >= 0xDC00 && ch <= 0xDFFF && m_surrogate != 0)
    ch = 0x10000 + (m_surrogate - 0xD800) * 0x400 + (ch - 0xDC00);
  m_surrogate = ch >= 0xD800 && ch <= 0xDBFF ? ch : 0;
  if (m_surrogate != 0 || m_pasting) return;
  if (numbers.field[0][0] > 0 && !m_record_decoder->deadline()) {
    emitKey(out, numbers.windowsKey(ch));
  } else if (is_down && ch > 0 && ch <= 0x10FFFF) {
    std::string bytes;
    df::appendUtf8(bytes, static_cast<char32_t>(ch));
    for (const char c : bytes) m_record_decoder->decodeByte(static_cast<unsigned char>(c), out);
    m_record_decoder->m_last = m_last;
  }
}

void InputDecoder::decodeX10(unsigned char byte, Events& out) {
  m_parameters.push_back(static_cast<char>(byte));
  if (m_parameters.size() < 3) return;
  const auto value = [this](std::size_t i) { return static_cast<unsigned char>(m_parameters[i]) - 32; };
  const int code = value(0);
  const int x = value(1) - 1;
  const int y = value(2) - 1;
  if (code >= 0 && x >= 0 && y >= 0) {
    const bool released = (code & 3) == 3 && (code & 32) == 0;
    emitMouse(out, released ? code & ~3 : code, x, y, released);
  }
  enterState(State::kGround);
}

void InputDecoder::emitMouse(Events& out, int code, int x, int y, bool released) {
  if (m_pasting || code >= 64) return;  // games do not use the wheel and further buttons
  static constexpr std::array<df::Mouse::Button, 4> kButtons = {
      df::Mouse::LEFT, df::Mouse::MIDDLE, df::Mouse::RIGHT, df::Mouse::UNDEFINED_MOUSE_BUTTON};
  MouseEvent event;
  event.x = std::min(x, kMaxCell);
  event.y = std::min(y, kMaxCell);
  event.button = kButtons[static_cast<std::size_t>(code & 3)];
  const bool moved = (code & 32) != 0;
  const bool has_button = event.button != df::Mouse::UNDEFINED_MOUSE_BUTTON;
  event.action = released               ? MouseEvent::Action::kRelease
                 : moved && has_button  ? MouseEvent::Action::kDrag
                 : moved || !has_button ? MouseEvent::Action::kMotion
                                        : MouseEvent::Action::kPress;
  out.emplace_back(event);
}

void InputDecoder::addPasted(char32_t ch) {
  const bool rest_of_line_end = ch == U'\n' && m_pasted_return;
  m_pasted_return = ch == U'\r';
  if (rest_of_line_end || m_pasted.size() >= kMaxPaste) return;
  if (ch == U'\r' || ch == U'\n' || ch == U'\t') ch = U' ';
  if (ch >= U' ' && ch != U'\x7f') m_pasted.push_back(ch);
}

void InputDecoder::endPaste(Events& out) {
  if (m_pasting && !m_pasted.empty()) out.emplace_back(PasteEvent{m_pasted});
  m_pasting = m_pasted_return = false;
  m_pasted.clear();
}

void InputDecoder::emitKey(Events& out, KeyEvent event) {
  const bool is_known = event.key != df::Keyboard::UNDEFINED_KEY || event.ch != 0;
  if (is_known && !m_pasting) out.emplace_back(event);
}

}  // namespace naiad

// Decodes the bytes of the player's terminal into events, in the encodings that common terminals use.
//
// ncurses would decode keys too, but not releases, not mouse motion under every TERM, and it waits a second
// after an ESC. So the client reads fd 0 itself. This decoder uses neither terminal nor clock. It decodes:
//   - plain characters, control bytes, UTF-8, Alt as an ESC before the character
//   - cursor, editing and function keys of xterm, rxvt, the Linux console (CSI and SS3), with modifiers
//   - the kitty keyboard protocol (press, repeat, release, alternate keys, text) and the reply to its query
//   - the key records of Windows Terminal (win32-input-mode), also those that contain a paste or mouse report
//   - the mouse as SGR (1006) and as X10 bytes
//   - pasted text (bracketed paste), which never becomes keys
//   - the report that the terminal has lost the focus
// Unknown sequences and other replies are dropped whole: a byte of a sequence never becomes a key. Memory is
// bounded whatever arrives.
//
// Keys are those that type the character on a US keyboard. Letters of other scripts than Latin go by
// position: the one that the terminal reports, or else that of the standard layout.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "shared/values/Keyboard.h"

namespace naiad {

/// Modifier keys held with a key, as a sum of bits.
enum Modifier : std::uint8_t { kShift = 1, kAlt = 2, kControl = 4, kSuper = 8 };

/// A key, as reported by the terminal. Without the kitty protocol, terminals report only presses, and repeats
/// as presses; KeyHoldTracker guesses which are repeats, and the releases.
struct KeyEvent {
  enum class Action : std::uint8_t { kPress, kRepeat, kRelease };
  df::Keyboard::Key key = df::Keyboard::UNDEFINED_KEY;  ///< undefined for characters without a key
  char32_t ch = 0;  ///< the character for a text line; 0 if the key types none
  Action action = Action::kPress;
  std::uint8_t modifiers = 0;
  friend bool operator==(const KeyEvent&, const KeyEvent&) = default;
};

/// The mouse, in terminal cells counted from 0.
struct MouseEvent {
  enum class Action : std::uint8_t { kPress, kDrag, kMotion, kRelease };
  int x = 0;
  int y = 0;
  df::Mouse::Button button = df::Mouse::UNDEFINED_MOUSE_BUTTON;
  Action action = Action::kMotion;
  friend bool operator==(const MouseEvent&, const MouseEvent&) = default;
};

/// The reply to `CSI ? u`: the terminal supports the kitty keyboard protocol. `flags`: its active flags.
struct KittyReply {
  int flags = 0;
  friend bool operator==(const KittyReply&, const KittyReply&) = default;
};

/// Pasted text, as one event. Line ends and tabs have become blanks; other control characters are removed.
struct PasteEvent {
  std::u32string text;  ///< limited to InputDecoder::kMaxPaste characters
  friend bool operator==(const PasteEvent&, const PasteEvent&) = default;
};

/// The report that the terminal has lost the focus: it will not report the release of held keys.
struct FocusLost {
  friend bool operator==(const FocusLost&, const FocusLost&) = default;
};

using TerminalEvent = std::variant<KeyEvent, MouseEvent, KittyReply, PasteEvent, FocusLost>;

class InputDecoder {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// An ESC that no byte follows for this long is the Escape key.
  static constexpr std::chrono::milliseconds kEscapeDelay{25};
  /// An incomplete sequence is dropped after a pause of this length.
  static constexpr std::chrono::milliseconds kSequenceDelay{500};
  /// A paste ends after a pause of this length; later bytes are keys, including Return.
  static constexpr std::chrono::milliseconds kPasteDelay{2000};
  /// Limit on the characters of a paste; the rest is dropped.
  static constexpr std::size_t kMaxPaste = 1000;

  /// Decodes `bytes`, read at `now`. Sequences may be split anywhere between calls.
  std::vector<TerminalEvent> feed(std::string_view bytes, Time now);
  /// Returns the events that a timeout has decided, such as a lone ESC. Call at deadline().
  std::vector<TerminalEvent> flush(Time now);
  /// Returns when flush() will next have something to do; nullopt while no sequence is open.
  std::optional<Time> deadline() const;
  /// Returns the number of stored bytes of incomplete sequences; at most 128.
  std::size_t pendingBytes() const {
    return m_parameters.size() + m_utf8.size() + (m_record_decoder ? m_record_decoder->pendingBytes() : 0);
  }
  /// True once a key record of Windows Terminal was received: then keys are reported with their releases.
  bool hasKeyRecords() const { return m_record_decoder != nullptr; }

 private:
  enum class State {
    kGround,
    kEscape,         ///< after ESC
    kCsi,            ///< after ESC [
    kSs3,            ///< after ESC O
    kLinuxFunction,  ///< after ESC [ [
    kX10Mouse,       ///< after ESC [ M, before three bytes
    kString,         ///< OSC, DCS, APC, PM, SOS, until ST or BEL
    kStringEscape,   ///< an ESC inside such a string
    kUtf8,
  };
  using Events = std::vector<TerminalEvent>;

  std::optional<Time> ownDeadline() const;
  void decodeByte(unsigned char byte, Events& out);
  void decodeGround(unsigned char byte, Events& out);
  void decodeEscape(unsigned char byte, Events& out);
  void decodeSequence(unsigned char byte, Events& out);
  void decodeUtf8Byte(unsigned char byte, Events& out);
  void decodeX10(unsigned char byte, Events& out);
  void finishSequence(unsigned char final, bool ss3, Events& out);
  void finishTilde(Events& out);
  struct Numbers;
  void decodeKeyRecord(const Numbers& numbers, Events& out);
  void emitKey(Events& out, KeyEvent event);
  void addPasted(char32_t ch);
  void endPaste(Events& out);
  void emitMouse(Events& out, int code, int x, int y, bool released);
  void enterState(State state);

  State m_state = State::kGround;
  bool m_overlong = false;       ///< the sequence is too long to be valid: drop it up to its end
  bool m_meta = false;           ///< an ESC came before the sequence (rxvt's Alt)
  bool m_pasting = false;        ///< between CSI 200 ~ and CSI 201 ~
  std::u32string m_pasted;       ///< text since CSI 200 ~
  bool m_pasted_return = false;  ///< the last pasted character was CR: drop an LF after it
  std::string m_parameters;
  std::string m_utf8;
  Time m_last{};
  std::unique_ptr<InputDecoder>
      m_record_decoder;              ///< decodes bytes in key records; null before the first record
  bool m_is_record_decoder = false;  ///< this is m_record_decoder of another decoder: ignore key records
  int m_surrogate = 0;               ///< first half of a surrogate pair, from a key record; 0: none
};

}  // namespace naiad

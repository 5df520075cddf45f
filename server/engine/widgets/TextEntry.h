// A line of text that the player types; RETURN calls callback().
//
// An entry that is made while a player's join, key or mouse is handled belongs to that player: it takes only
// their keys. Other entries take all players' keys, unless setPlayer() names a player.
#pragma once

#include <cstdint>
#include <string>

#include "EventKeyboard.h"
#include "EventMouse.h"
#include "ViewObject.h"

namespace df {

/// Attributes that a TextEntry has beyond those of a ViewObject, as bits.
enum class TextEntryAttribute : unsigned int {
  TEXT = 1 << (ViewObjectAttributeMax + 0),
  APPEARANCE = 1 << (ViewObjectAttributeMax + 1),
  ALL_TEXT = TEXT,
  MODIFIED_TEXT = TEXT,
  LIMIT = APPEARANCE,
  CURSOR = APPEARANCE,
  CURSOR_CHAR = APPEARANCE,
  BLINK_RATE = APPEARANCE,
  NUMBERS_ONLY = APPEARANCE,
};
/// Number of attributes, with those of a ViewObject.
inline constexpr int TextEntryAttributeMax = ViewObjectAttributeMax + 2;

class TextEntry : public ViewObject {
 public:
  /// Makes an empty entry for up to 30 characters (compat: 1), interested in KEYBOARD_EVENT, for the player
  /// whose input is being handled. The cursor shows and hides every 15 ticks (compat: 10).
  TextEntry();

  /// Called when the player presses RETURN.
  virtual void callback() = 0;

  /// The characters typed so far. A text longer than the limit raises the limit.
  void setText(std::string new_text);
  const std::string& getText() const { return m_text; }
  void clearText() { setText(""); }
  /// Maximum length of the text, in characters. setLimit() truncates a longer text.
  void setLimit(int new_limit);
  int getLimit() const { return m_limit; }
  /// Index at which the next character is inserted, 0 to the length of the text.
  void setCursor(int new_cursor);
  int getCursor() const { return m_cursor; }
  void setCursorChar(char new_cursor_char) { m_cursor_char = new_cursor_char; }  ///< Default '_'.
  char getCursorChar() const { return m_cursor_char; }
  /// Number of ticks for which the cursor is shown, and then hidden; 0: always shown.
  void setBlinkRate(int new_blink_rate) { m_blink_rate = new_blink_rate; }
  int getBlinkRate() const { return m_blink_rate; }
  void setNumbersOnly(bool new_numbers_only = true) { m_numbers_only = new_numbers_only; }  ///< Digits only.
  bool numbersOnly() const { return m_numbers_only; }

  /// Player whose keys the entry takes; 0: all players. When that player has left, it takes all players'
  /// keys, so that the game does not wait in vain.
  void setPlayer(std::uint32_t new_player) { m_player = new_player; }
  std::uint32_t getPlayer() const { return m_player; }

  int eventHandler(const Event* p_e) override;
  /// Draws the view string, then the text with the cursor.
  DF_DRAW draw() override;

 private:
  bool takesKey(const EventKeyboard& key) const;
  void type(char ch);

  std::string m_text;
  int m_limit = 30;
  int m_cursor = 0;
  char m_cursor_char = '_';
  int m_blink_rate = 15;
  bool m_numbers_only = false;
  bool m_shift = false;
  std::uint32_t m_player = 0;
};

}  // namespace df

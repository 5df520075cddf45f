// Several lines of text in a box on the view. If the text is longer than the box, its end is shown.
#pragma once

#include <string>
#include <vector>

#include "Event.h"
#include "ViewObject.h"

namespace df {

/// Attributes that a TextBox has beyond those of a ViewObject, as bits.
enum class TextBoxAttribute : unsigned int {
  TEXT = 1 << (ViewObjectAttributeMax + 0),
  APPEARANCE = 1 << (ViewObjectAttributeMax + 1),
};
/// Number of attributes, with those of a ViewObject.
inline constexpr int TextBoxAttributeMax = ViewObjectAttributeMax + 2;

class TextBox : public ViewObject {
 public:
  /// Makes an empty box, 30 by 5 characters, with padding and word wrap.
  TextBox();

  /// setText() replaces the text, addText() appends to it.
  void setText(std::string new_text) { m_text = std::move(new_text); }
  void addText(const std::string& new_text) { m_text += new_text; }
  const std::string& getText() const { return m_text; }
  void clearText() { m_text.clear(); }
  /// Size inside the border, in characters: 1 by 1 to 400 by 150. setSize() ignores other sizes.
  void setSize(Vector new_size);
  Vector getSize() const { return m_size; }
  /// Whether there is a blank on either side of each row.
  void setPadding(bool new_padding) { m_padding = new_padding; }
  bool getPadding() const { return m_padding; }
  /// Whether lines are broken at blanks.
  void setWordWrap(bool new_word_wrap) { m_word_wrap = new_word_wrap; }
  bool getWordWrap() const { return m_word_wrap; }

  /// Draws the box around its position, with the last lines of the text.
  DF_DRAW draw() override;
  /// Returns all lines of the text, broken as draw() shows them.
  std::vector<std::string> lines() const;

 private:
  std::string m_text;
  Vector m_size{30, 5};
  bool m_padding = true;
  bool m_word_wrap = true;
};

}  // namespace df

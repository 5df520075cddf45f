// Several lines of text in a box on the view; of a longer text the end is shown.
#pragma once

#include <string>
#include <vector>

#include "Event.h"
#include "ViewObject.h"

namespace df {

/// Attributes beyond a ViewObject's.
enum class TextBoxAttribute : unsigned int {
  TEXT = 1 << (ViewObjectAttributeMax + 0),
  APPEARANCE = 1 << (ViewObjectAttributeMax + 1),
};
/// Attributes in all, with those of a ViewObject.
inline constexpr int TextBoxAttributeMax = ViewObjectAttributeMax + 2;

class TextBox : public ViewObject {
 public:
  /// Empty, 30 by 5 characters, with padding and word wrap.
  TextBox();

  /// The text: all of it, or more behind it.
  void setText(std::string new_text) { m_text = std::move(new_text); }
  void addText(const std::string& new_text) { m_text += new_text; }
  const std::string& getText() const { return m_text; }
  void clearText() { m_text.clear(); }
  /// Characters inside the border, 1 by 1 to 400 by 150.
  void setSize(Vector new_size);
  Vector getSize() const { return m_size; }
  /// A blank on either side of each row.
  void setPadding(bool new_padding) { m_padding = new_padding; }
  bool getPadding() const { return m_padding; }
  /// Break lines at blanks.
  void setWordWrap(bool new_word_wrap) { m_word_wrap = new_word_wrap; }
  bool getWordWrap() const { return m_word_wrap; }

  /// The box around its place, and in it the last lines.
  DF_DRAW draw() override;
  /// The text in lines as they are shown, all of them.
  std::vector<std::string> lines() const;

 private:
  std::string m_text;
  Vector m_size{30, 5};
  bool m_padding = true;
  bool m_word_wrap = true;
};

}  // namespace df

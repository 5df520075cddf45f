// A text on the view that can be clicked: it changes colour under the mouse, and a click calls callback().
#pragma once

#include "EventMouse.h"
#include "ViewObject.h"

namespace df {

/// The attribute that a Button has beyond those of a ViewObject, as a bit.
enum class ButtonAttribute : unsigned int {
  APPEARANCE = 1 << (ViewObjectAttributeMax + 0),
  HIGHLIGHT_COLOR = APPEARANCE,
  DEFAULT_COLOR = APPEARANCE,
};
/// Number of attributes, with those of a ViewObject.
inline constexpr int ButtonAttributeMax = ViewObjectAttributeMax + 1;

class Button : public ViewObject {
 public:
  /// Makes a button without a value, in the default colour and red under the mouse. It is interested in
  /// MSE_EVENT and is placed at the top (compat: in the middle of the view).
  Button();

  /// Called when the button is clicked.
  virtual void callback() = 0;

  /// Colour of the button while the pointer is on it.
  void setHighlightColor(Color new_highlight_color) { m_highlight_color = new_highlight_color; }
  Color getHighlightColor() const { return m_highlight_color; }
  /// Colour of the button while the pointer is elsewhere.
  void setDefaultColor(Color new_default_color);
  Color getDefaultColor() const { return m_default_color; }
  /// True if the mouse is on the button, border included.
  bool mouseOverButton(const EventMouse* p_e) const;

  int eventHandler(const Event* p_e) override;

 private:
  Color m_highlight_color = RED;
  Color m_default_color = COLOR_DEFAULT;
};

}  // namespace df

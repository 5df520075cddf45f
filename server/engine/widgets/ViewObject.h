// Shows a text and a value, such as points, at a fixed place of the view (book, Listing 4.175).
//
// The position of a ViewObject is a cell of the view, not of the world: it is always drawn at this cell of
// every player's view. It collides with nothing.
#pragma once

#include <string>

#include "Color.h"
#include "Event.h"
#include "EventView.h"
#include "Object.h"

namespace df {

/// Places on the view: at 1/6, 1/2 or 5/6 of its width.
enum ViewObjectLocation {
  UNDEFINED = -1,
  TOP_LEFT,
  TOP_CENTER,
  TOP_RIGHT,
  CENTER_LEFT,
  CENTER_CENTER,
  CENTER_RIGHT,
  BOTTOM_LEFT,
  BOTTOM_CENTER,
  BOTTOM_RIGHT,
};

/// Attributes that a ViewObject has beyond those of an Object. Names after APPEARANCE are older names of it.
DF_ENUM ViewObjectAttribute : unsigned int{
                                  VALUE = 1 << (ObjectAttributeMax + 0),
                                  APPEARANCE = 1 << (ObjectAttributeMax + 1),
                                  VIEW_STRING = APPEARANCE,
                                  BORDER = APPEARANCE,
                                  COLOR = APPEARANCE,
                                  LOCATION = APPEARANCE,
                                  DRAW_VALUE = APPEARANCE,
                              };
/// Number of attributes, with those of an Object.
inline constexpr int ViewObjectAttributeMax = ObjectAttributeMax + 2;

class ViewObject : public Object {
 public:
  /// Makes a SPECTRAL Object of type "ViewObject" at MAX_ALTITUDE, interested in VIEW_EVENT, at the top in
  /// the middle, with a border, the default colour and the value 0.
  ViewObject();

  /// Draws the text and the value centred at its position, with the border if set. Returns 0, else -1.
  DF_DRAW draw() override;
  /// Sets the value or adds to it, and returns 1, if the event is a VIEW_EVENT whose tag is the text; else 0.
  int eventHandler(const Event* p_e) override;

  /// Sets the position to 1/6, 1/2 or 5/6 of the view's width, in the top, middle or bottom row; a border at
  /// the top or bottom takes that row, and the text is in the row next to it.
  virtual void setLocation(ViewObjectLocation new_location);
  /// Returns the location; UNDEFINED after setPosition().
  ViewObjectLocation getLocation() const { return m_location; }
  /// Sets the position to a cell of the view. Returns 0, or -1 if it is out of range.
  int setPosition(Vector new_pos) override;

  /// The number behind the text.
  virtual void setValue(int new_value) { m_value = new_value; }
  int getValue() const { return m_value; }
  /// Whether to show the value behind the text.
  virtual void setDrawValue(bool new_draw_value = true) { m_draw_value = new_draw_value; }
  bool getDrawValue() const { return m_draw_value; }
  virtual void setBorder(bool new_border);  ///< Whether a frame is drawn.
  bool getBorder() const { return m_border; }
  virtual void setColor(Color new_color) { m_color = new_color; }  ///< Colour of text, value and border.
  Color getColor() const { return m_color; }
  /// Text before the value. EventViews with this text as their tag set the value.
  virtual void setViewString(std::string new_view_string) { m_view_string = std::move(new_view_string); }
  const std::string& getViewString() const { return m_view_string; }

  using Object::deserialize;
  using Object::isModified;
  using Object::serialize;
  std::string serialize(std::string attr = "") override;
  int deserialize(std::string s) override;
  /// Returns true, because these attributes are always written with the ViewObject.
  virtual bool isModified(ViewObjectAttribute /*attribute*/) const { return true; }
  std::string toString() const { return m_view_string + " " + std::to_string(m_value); }

 protected:
  /// Draws `text` centred at this ViewObject's position, with the border if there is one. Returns 0, else -1.
  int drawText(const std::string& text) const;

 private:
  std::string m_view_string;
  int m_value = 0;
  bool m_draw_value = true;
  bool m_border = true;
  Color m_color = COLOR_DEFAULT;
  ViewObjectLocation m_location = TOP_CENTER;
};

}  // namespace df

// Sets the value of view objects (book, Listing 4.177): sent with WM.onEvent(), applied by view objects with
// the tag as their text.
#pragma once

#include <string>
#include <utility>

#include "Event.h"

namespace df {

/// ViewObjects register interest in this themselves.
inline const EventType VIEW_EVENT("df-view");

class EventView : public Event {
 public:
  /// An event with tag VIEW_EVENT (compat: empty) and value 0, which is not added.
  EventView();
  /// An event for the view objects with this text: adds the value to theirs if `new_delta`, else replaces it.
  EventView(std::string new_tag, int new_value, bool new_delta)
      : Event(&VIEW_EVENT), m_tag(std::move(new_tag)), m_value(new_value), m_delta(new_delta) {}

  /// Text of the ViewObjects that it is for (ViewObject::setViewString).
  void setTag(std::string new_tag) { m_tag = std::move(new_tag); }
  const std::string& getTag() const { return m_tag; }
  /// New value, or the amount added to the old one.
  void setValue(int new_value) { m_value = new_value; }
  int getValue() const { return m_value; }
  /// Whether the value is added.
  void setDelta(bool new_delta) { m_delta = new_delta; }
  bool getDelta() const { return m_delta; }

 private:
  std::string m_tag;
  int m_value;
  bool m_delta;
};

}  // namespace df

// Sets the value of view objects (book, Listing 4.177). A game sends it with WM.onEvent(); it changes the
// view objects whose text equals its tag.
#pragma once

#include <string>
#include <utility>

#include "Event.h"

namespace df {

/// ViewObjects register interest in this themselves.
inline const EventType VIEW_EVENT("df-view");

class EventView : public Event {
 public:
  /// Makes an event with tag VIEW_EVENT (compat: empty) that sets the value to 0.
  EventView();
  /// Makes an event for view objects with the text `new_tag`: sets their value; if `new_delta`, adds to it.
  EventView(std::string new_tag, int new_value, bool new_delta)
      : Event(&VIEW_EVENT), m_tag(std::move(new_tag)), m_value(new_value), m_delta(new_delta) {}

  /// Text of the ViewObjects that the event is for (ViewObject::setViewString).
  void setTag(std::string new_tag) { m_tag = std::move(new_tag); }
  const std::string& getTag() const { return m_tag; }
  /// New value or, with getDelta(), the amount added to the old value.
  void setValue(int new_value) { m_value = new_value; }
  int getValue() const { return m_value; }
  /// Whether the value is added to the ViewObject's value instead of replacing it.
  void setDelta(bool new_delta) { m_delta = new_delta; }
  bool getDelta() const { return m_delta; }

 private:
  std::string m_tag;
  int m_value;
  bool m_delta;
};

}  // namespace df

// An event, which an Object gets in its eventHandler() (book, Listing 4.51). It is a container: a type name
// and, in derived classes, a few values. Games derive their own and send them with WM.onEvent().
#pragma once

#include <string>
#include <utility>

#include "EventType.h"
#include "StandardHeaders.h"

namespace df {

/// Type of an Event without a name.
inline const EventType UNDEFINED_EVENT("df-undefined");

class Event {
 public:
  /// Makes an event of type UNDEFINED_EVENT.
  Event() = default;
  virtual ~Event() = default;

  /// Sets the name by which Objects register interest and distinguish events. Names that begin with "df-"
  /// belong to the engine.
  void setType(std::string new_type) {
    m_type = EventType(std::move(new_type));
    m_p_known_type = nullptr;
  }
  /// Returns the type: one of the constants, such as STEP_EVENT, or a game's own name (book, Listing 4.45).
  const EventType& getType() const { return m_p_known_type != nullptr ? *m_p_known_type : m_type; }

 protected:
  /// Makes an event of an engine type. Keeps only the pointer, so `p_known_type` must never be destroyed.
  explicit Event(const EventType* p_known_type) : m_p_known_type(p_known_type) {}

 private:
  const EventType* m_p_known_type = &UNDEFINED_EVENT;
  EventType m_type;
};

}  // namespace df

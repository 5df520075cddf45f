// The name of a kind of Event: a std::string in all respects but one. The engine's own events share the
// constants of their types, so a handler that asks `p_e->getType() == df::COLLISION_EVENT` mostly compares
// two addresses.
#pragma once

#include <string>
#include <utility>

#include "detail/Dialect.h"

namespace df {

class EventType : public std::string {
 public:
  EventType() = default;
  /// Of this name; two of one name are equal.
  // Explicit: a comparison with any other string is that of strings.
  explicit EventType(std::string name) : std::string(std::move(name)) {}

  friend bool operator==(const EventType& a, const EventType& b) {
    return &a == &b || static_cast<const std::string&>(a) == static_cast<const std::string&>(b);
  }
};

}  // namespace df

// The name of a kind of Event: a std::string with a faster comparison. The engine's events refer to the
// constants of their types, so a handler that asks `p_e->getType() == df::COLLISION_EVENT` mostly compares
// two addresses.
#pragma once

#include <string>
#include <utility>

#include "detail/LanguageStandard.h"

namespace df {

class EventType : public std::string {
 public:
  EventType() = default;
  /// Makes a type of this name; two types of one name are equal.
  // Explicit, so that comparing a type with a std::string does not first convert that string to an EventType.
  explicit EventType(std::string name) : std::string(std::move(name)) {}

  friend bool operator==(const EventType& a, const EventType& b) {
    return &a == &b || static_cast<const std::string&>(a) == static_cast<const std::string&>(b);
  }
};

}  // namespace df

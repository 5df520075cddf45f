// Listing 4.112 of the Dragonfly book.
#pragma once

#include "Event.h"

namespace textbook {

const std::string OUT_EVENT = "df::out";

class EventOut : public Event {
 public:
  EventOut();
};

}  // namespace textbook

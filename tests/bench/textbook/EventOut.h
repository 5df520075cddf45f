// Book, Listing 4.112.
#pragma once

#include "Event.h"

namespace textbook {

const std::string OUT_EVENT = "df::out";

class EventOut : public Event {
 public:
  EventOut();
};

}  // namespace textbook

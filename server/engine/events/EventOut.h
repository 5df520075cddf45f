// Sent to an Object whose move took it from inside the world boundary to outside (book, Listing 4.112).
//
// An Object that stays outside gets no second event, and one that was placed outside gets none. No interest
// needs to be registered. The Object has already moved when it gets the event.
#pragma once

#include "Event.h"

namespace df {

/// Type of EventOut, which is sent without registration.
inline const EventType OUT_EVENT("df-out");

class EventOut : public Event {
 public:
  EventOut() : Event(&OUT_EVENT) {}
};

}  // namespace df

// An event that tells every saucer that a nuke went off.
#pragma once

#include "Event.h"

const std::string NUKE_EVENT = "nuke";

class EventNuke : public df::Event {
 public:
  EventNuke() { setType(NUKE_EVENT); }
};

// Where the world is known: what an EventView begins with depends on it.

#include "engine/events/EventView.h"

#include "engine/world/World.h"

namespace df {

EventView::EventView()
    : EventView(World::current().compat() ? std::string() : std::string(VIEW_EVENT), 0, false) {}

}  // namespace df

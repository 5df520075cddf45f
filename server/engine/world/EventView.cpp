// The default constructor of EventView, which needs the current world.

#include "engine/events/EventView.h"

#include "engine/world/World.h"

namespace df {

EventView::EventView()
    : EventView(World::current().compat() ? std::string() : std::string(VIEW_EVENT), 0, false) {}

}  // namespace df

// The parts of a world, put together by hand. The host lends them its store and interests, for Objects are
// made in the current world, and does nothing else.
#pragma once

#include <string>
#include <vector>

#include "engine/world/Capture.h"
#include "engine/world/EventDispatch.h"
#include "engine/world/InputQueue.h"
#include "engine/world/Interests.h"
#include "engine/world/Mover.h"
#include "engine/world/ObjectRegistry.h"
#include "engine/world/Tick.h"
#include "engine/world/Views.h"
#include "engine/world/World.h"
#include "engine/world/WorldExtras.h"
#include "engine/world/WorldLog.h"
#include "engine/world/WorldState.h"
#include "engine/world/WorldStore.h"

namespace df::test {

struct Parts {
  Parts() {
    log.setSink([this](const std::string& line) { lines.push_back(line); });
  }

  df::World host;
  df::World::Scope scope{host};
  std::vector<std::string> lines;
  int shutdowns = 0;

  df::WorldStore& store = host.store();
  df::WorldLog log;
  df::WorldState state;
  df::LazyExtras extras{store, log, state};
  df::ObjectRegistry objects{store, host.interests(), log};
  df::EventDispatch events{objects, host.interests(), state, [this] { ++shutdowns; }};
  df::Views views{store, log};
  df::Capture picture{store, views, events, extras, state};
  df::Mover mover{objects, views, events, state};
  df::InputQueue input{objects, views, events, mover, extras, state};
  df::Tick tick{host, objects, events, picture, mover, input, extras, state};
};

}  // namespace df::test

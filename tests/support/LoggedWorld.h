// A world that is current while this exists, and its log lines.
#pragma once

#include <string>
#include <vector>

#include "engine/world/World.h"
#include "engine/world/WorldLog.h"

namespace df::test {

struct LoggedWorld {
  LoggedWorld() {
    world.log().setSink([this](const std::string& line) { lines.push_back(line); });
  }
  LoggedWorld(const LoggedWorld&) = delete;
  LoggedWorld& operator=(const LoggedWorld&) = delete;
  ~LoggedWorld() { world.shutDown(); }

  std::vector<std::string> lines;
  World world;
  World::Scope scope{world};
};

}  // namespace df::test

// Fixture for tests of swept moves.
#pragma once

#include <string>
#include <vector>

#include "tests/server/engine/Probe.h"

namespace df::test {

/// The distance between neighbouring positions, in cells.
inline constexpr double kUnit = 1 / 4294967296.0;

class SweptWorld : public WorldTest {
 protected:
  Probe* make(const std::string& name, double x, double y, Solidness solidness = HARD) {
    auto* p = new Probe(name, &received, Vector(x, y));
    p->setSolidness(solidness);
    return p;
  }
  Probe* makeSwept(const std::string& name, double x, double y, Solidness solidness = HARD) {
    Probe* p = make(name, x, y, solidness);
    p->setSwept();
    return p;
  }
  /// Makes a wall of one column, from row 0 to row 23.
  Probe* makeWall(const std::string& name, double x, Solidness solidness = HARD) {
    Probe* p = make(name, x, 0, solidness);
    p->setBox(Box(Vector(-0.5, -0.5), 1, 24));
    return p;
  }
  static Received pairs(const std::string& mover, const std::vector<std::string>& others) {
    Received list;
    for (const std::string& other : others) {
      list.push_back(mover + ":df-collision");
      list.push_back(other + ":df-collision");
    }
    return list;
  }
};

}  // namespace df::test

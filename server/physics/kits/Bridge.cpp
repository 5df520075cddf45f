#include "physics/kits/Bridge.h"

#include "physics/body/PhysicsManager.h"

namespace df {

std::vector<Body*> makeBridge(Vector left, Vector right, int planks) {
  constexpr double kGap = 0.4, kThickness = 0.9;
  const Vector span = right - left;
  const double length = planks > 0 ? span.x() / planks : 0;
  std::vector<Body*> made;
  if (!(length > kGap)) return made;
  Body* p_before = nullptr;
  for (int i = 0; i < planks; ++i) {
    auto* p_plank = new Body;
    p_plank->setType("Bridge");
    p_plank->setPosition(left + Vector(length * (i + 0.5), span.y() * (i + 0.5) / planks));
    p_plank->setTurning();
    p_plank->setBoxShape(length - kGap, kThickness);
    p_plank->setDrawing(BodyDrawing::FILL);
    PM.addHinge(p_before, p_plank, left + Vector(length * i, span.y() * i / planks));
    p_before = p_plank;
    made.push_back(p_plank);
  }
  PM.addHinge(p_before, nullptr, right);
  return made;
}

}  // namespace df

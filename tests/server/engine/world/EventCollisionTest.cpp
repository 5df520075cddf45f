#include <gtest/gtest.h>

#include "engine/world/EventCollision.h"

namespace df::test {
namespace {

std::string typeOfMover(const EventCollision& collision) {
  return collision.getObject1()->getType();
}

TEST(EventCollisionHeader, IncludesTheObjectHeader) {
  Object mover;
  EXPECT_EQ(typeOfMover(EventCollision(&mover, nullptr, Vector())), "Object");
}

}  // namespace
}  // namespace df::test

// Objects as text, ids set by the game, and paths.

#include <sstream>

#include "engine/world/EventPath.h"
#include "engine/world/PathFind.h"
#include "tests/server/engine/Probe.h"

namespace df::test {
namespace {

using ObjectText = WorldTest;

constexpr unsigned kPosition = static_cast<unsigned>(ObjectAttribute::POSITION);

TEST_F(ObjectText, SerializedObjectReadsBackEqual) {
  Object a;
  a.setType("ship");
  a.setPosition(Vector(2.5, -3));
  a.setVelocity(Vector(0.25, 1));
  a.setBox(Box(Vector(-1, -2), 3, 4));
  a.setAltitude(4);
  a.setSolidness(SOFT);
  a.setVisible(false);
  const std::string text = a.serialize("ALL");
  EXPECT_NE(text.find("pos-x:2.5,pos-y:-3,"), std::string::npos) << text;

  Object b;
  EXPECT_EQ(b.deserialize(text), 0);
  EXPECT_EQ(b.getType(), "ship");
  EXPECT_EQ(b.getId(), a.getId());
  EXPECT_EQ(b.getPosition(), a.getPosition());
  EXPECT_EQ(b.getVelocity(), a.getVelocity());
  EXPECT_EQ(b.getBox(), a.getBox());
  EXPECT_EQ(b.getAltitude(), 4);
  EXPECT_EQ(b.getSolidness(), SOFT);
  EXPECT_FALSE(b.isVisible());
  EXPECT_EQ(b.deserialize("altitude:99,"), -1);
}

TEST_F(ObjectText, WritesOnlyChangesSinceTheLastWrite) {
  Object o;
  EXPECT_TRUE(o.isModified());
  o.serialize("ALL");
  EXPECT_FALSE(o.isModified());
  EXPECT_EQ(o.serialize(), "");
  o.setPosition(Vector(1, 2));
  EXPECT_TRUE(o.isModified(ObjectAttribute::POSITION));
  EXPECT_FALSE(o.isModified(ObjectAttribute::TYPE));
  EXPECT_EQ(o.getModified(), kPosition);
  EXPECT_EQ(o.serialize(), "pos-x:1,pos-y:2,");
  EXPECT_FALSE(o.isModified());
  o.setModified(kPosition);
  EXPECT_EQ(o.serialize(), "pos-x:1,pos-y:2,");
  EXPECT_FALSE(o.isModified());
}

TEST_F(ObjectText, DeserializeReportsTheAttributesItRead) {
  PlacedObject a(Vector(7, 8));
  std::stringstream stream;
  EXPECT_EQ(a.serialize(&stream, kPosition), 0);
  Object b;
  unsigned brought = 0;
  EXPECT_EQ(b.deserialize(&stream, &brought), 0);
  EXPECT_EQ(brought, kPosition);
  EXPECT_EQ(b.getPosition(), Vector(7, 8));
  EXPECT_EQ(a.serialize(nullptr, 0), -1);
  std::stringstream vector;
  EXPECT_EQ(Vector(0.1, -2).serialize(&vector), 0);
  Vector v;
  EXPECT_EQ(v.deserialize(&vector), 0);
  EXPECT_EQ(v, Vector(0.1, -2));
  EXPECT_EQ(v.deserialize(&vector), -1);
  EXPECT_TRUE(!Vector());
}

TEST_F(ObjectText, ObjectIsFoundByAGameChosenId) {
  Object a;
  const int before = a.getId();
  EXPECT_EQ(Object::max_id, before);
  a.setId(1000);
  EXPECT_EQ(a.getId(), 1000);
  EXPECT_EQ(WM.objectWithId(1000), &a);
  EXPECT_EQ(WM.objectWithId(before), nullptr);
  Object b;
  EXPECT_EQ(b.getId(), before + 1);
  EXPECT_EQ(Object::max_id, before + 1);
}

/// Builds a wall from (20,0) down, with `height` characters, one per row.
void build(std::vector<std::unique_ptr<Object>>& wall, int height) {
  for (int y = 0; y < height; ++y) {
    wall.push_back(std::make_unique<Object>());
    wall.back()->setBox(Box(Vector(-0.4, -0.4), 0.8, 0.8));
    wall.back()->setPosition(Vector(20, y));
  }
}

TEST_F(ObjectText, WalkerGoesAroundAWallToItsTarget) {
  std::vector<std::unique_ptr<Object>> wall;
  build(wall, 20);
  Probe walker("walker", &received, Vector(10, 5));
  walker.setBox(Box(Vector(-0.4, -0.4), 0.8, 0.8));
  walker.setSpeed(0.7);
  walker.pathTo(Vector(30, 5));
  EXPECT_EQ(received, std::vector<std::string>{"walker:df-path"});
  EXPECT_TRUE(walker.getFollowPath());
  int ticks = 0;
  for (; walker.getFollowPath() && ticks < 200; ++ticks) world.tick();
  EXPECT_EQ(walker.getPosition(), Vector(30, 5));
  EXPECT_EQ(walker.getVelocity(), Vector());
  EXPECT_EQ(received.size(), 1u);  // only the path event: no collision
  EXPECT_GT(ticks, 50);
}

TEST_F(ObjectText, MissingPathIsReportedByAnEvent) {
  std::vector<std::unique_ptr<Object>> wall;
  build(wall, 24);
  Probe walker("walker", nullptr, Vector(10, 5));
  walker.setBox(Box(Vector(-0.4, -0.4), 0.8, 0.8));
  SearchResult result = FOUND;
  walker.on_event = [&](Probe&, const Event& e) { result = dynamic_cast<const EventPath&>(e).getResult(); };
  walker.pathTo(Vector(30, 5));
  EXPECT_EQ(result, NOT_FOUND);
  EXPECT_FALSE(walker.getFollowPath());
  EXPECT_TRUE(findPath(walker, Vector(1e9, 0)).getPath().empty());
}

TEST_F(ObjectText, PathIteratesItsNodes) {
  Path path;
  EXPECT_EQ(path.nextNode(), Vector(-1, -1));
  EXPECT_TRUE(path.endOfPath());
  path.setPath({Vector(1, 1), Vector(2, 2)});
  EXPECT_EQ(path.nextNode(), Vector(1, 1));
  EXPECT_EQ(path.previousNode(), Vector(-1, -1));
  path++;
  EXPECT_TRUE(path.endOfPath());
  path++;
  EXPECT_EQ(path.getIndex(), 1);
  EXPECT_EQ(path.setIndex(2), -1);
  EXPECT_EQ(path.getEnd(), Vector(2, 2));
}

}  // namespace
}  // namespace df::test

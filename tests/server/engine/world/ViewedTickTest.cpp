#include "engine/events/EventMouse.h"
#include "engine/world/LagCompensation.h"
#include "tests/server/engine/Probe.h"

namespace df::test {
namespace {

using Names = std::vector<std::string>;

Names names(const ObjectList& list) {
  Names out;
  for (int i = 0; i < list.getCount(); ++i) out.push_back(list[i]->getType());
  return out;
}

/// A record of what players saw: every Object was drawn ten cells to the left of its position, except
/// `hidden`, which was not drawn.
class TenToTheLeft : public LagCompensation {
 public:
  explicit TenToTheLeft(const World& world) : m_world(world) {}
  std::optional<FixedVector> positionOf(ObjectKey object, const ViewedTick& seen) const override {
    last = seen;
    if (object == hidden) return std::nullopt;
    return toFixed(m_world.store().find(object)->getPosition() - Vector(10, 0));
  }
  std::optional<FixedVector> viewCornerOf(std::uint32_t player, const ViewedTick&) const override {
    return player == 1 ? corner : std::nullopt;
  }
  mutable ViewedTick last;
  ObjectKey hidden;
  std::optional<FixedVector> corner;  ///< corner of the first player's view

 private:
  const World& m_world;
};

using SeenAt = WorldTest;

TEST_F(SeenAt, FindsObjectsWhereTheyAreDrawn) {
  const Probe dot("dot", nullptr, Vector(10.6, 5));  // in cell 11
  Probe ship("ship", nullptr, Vector(20, 10));       // three by two: cells 19 to 21, rows 10 and 11
  ship.setBox(Box(Vector(-1.5, -1), 3, 2));
  Probe small("small", nullptr, Vector(30, 10));
  small.setBox(Box(Vector(-0.2, -0.2), 0.4, 0.4));
  EXPECT_EQ(names(WM.objectsSeenAt(Vector(11, 5))), Names{"dot"});
  EXPECT_EQ(names(WM.objectsSeenAt(Vector(10, 5))), Names{});
  EXPECT_EQ(names(WM.objectsSeenAt(Vector(30, 10))), Names{"small"});
  int cells = 0;
  for (int y = 0; y < 24; ++y) {
    for (int x = 15; x < 25; ++x) cells += WM.objectsSeenAt(Vector(x, y)).getCount();
  }
  EXPECT_EQ(cells, 6);
  EXPECT_EQ(names(WM.objectsSeenAt(Vector(19, 11))), Names{"ship"});
  ship.setVisible(false);
  EXPECT_EQ(names(WM.objectsSeenAt(Vector(19, 11))), Names{});
}

TEST_F(SeenAt, LagCompensationAppliesOnlyToInputWithATick) {
  TenToTheLeft compensation(world);
  world.input().setLagCompensation(&compensation);
  const std::uint32_t ann = world.input().join("ann", RED);
  Probe dot("dot", nullptr, Vector(40, 5));
  Names at_click;
  dot.hear(MSE_EVENT, [&](Probe&, const Event& e) {
    at_click = names(WM.objectsSeenAt(static_cast<const EventMouse&>(e).getMousePosition()));
  });
  world.input().mouse(ann, CLICKED, Mouse::LEFT, 30, 5, {true, 70, 74});
  GM.tick();
  EXPECT_EQ(at_click, Names{"dot"});
  EXPECT_EQ(compensation.last.base, 70u);
  EXPECT_EQ(compensation.last.drawn, 74u);
  world.input().mouse(ann, CLICKED, Mouse::LEFT, 40, 5);
  GM.tick();
  EXPECT_EQ(at_click, Names{"dot"});
  world.input().mouse(ann, CLICKED, Mouse::LEFT, 30, 5);
  GM.tick();
  EXPECT_EQ(at_click, Names{});
  compensation.hidden = dot.key();
  world.input().mouse(ann, CLICKED, Mouse::LEFT, 30, 5, {true, 70, 74});
  GM.tick();
  EXPECT_EQ(at_click, Names{});
  EXPECT_EQ(names(WM.objectsSeenAt(Vector(40, 5))), Names{"dot"});  // between inputs: the present positions
  world.input().setLagCompensation(nullptr);
}

TEST_F(SeenAt, ClickUsesTheViewThePlayerSaw) {
  TenToTheLeft compensation(world);
  world.input().setLagCompensation(&compensation);
  const std::uint32_t ann = world.input().join("ann", RED);
  const std::uint32_t bob = world.input().join("bob", BLUE);
  Probe dot("dot", nullptr, Vector(40, 5));
  std::vector<Vector> clicks;
  dot.hear(MSE_EVENT, [&](Probe&, const Event& e) {
    clicks.push_back(static_cast<const EventMouse&>(e).getMousePosition());
  });
  compensation.corner = toFixed(Vector(6.6, -2));  // the view begins with cell 7
  world.input().mouse(ann, CLICKED, Mouse::LEFT, 30, 5, {true, 70, 74});
  world.input().mouse(ann, CLICKED, Mouse::LEFT, 30, 5);
  world.input().mouse(bob, CLICKED, Mouse::LEFT, 30, 5, {true, 70, 74});
  GM.tick();
  EXPECT_EQ(clicks, (std::vector<Vector>{Vector(37, 3), Vector(30, 5), Vector(30, 5)}))
      << "if no one says what the player saw, the present view counts";
  world.input().setLagCompensation(nullptr);
}

TEST_F(SeenAt, LookingBackIsOffUntilTheGameEnablesIt) {
  EXPECT_FALSE(world.input().isLagCompensated());
  WM.setLagCompensated();
  EXPECT_TRUE(world.input().isLagCompensated());
  world.shutDown();
  EXPECT_FALSE(WM.isLagCompensated());
}

}  // namespace
}  // namespace df::test

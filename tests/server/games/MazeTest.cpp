#include <gtest/gtest.h>

#include <deque>
#include <vector>

#include "GameMains.h"
#include "HostedGame.h"

namespace naiad {
namespace {

using namespace df;

struct Step {
  Keyboard::Key key;
  Vector way;
};
const std::vector<Step> kSteps = {{Keyboard::RIGHTARROW, Vector(2, 0)},
                                  {Keyboard::DOWNARROW, Vector(0, 1)},
                                  {Keyboard::LEFTARROW, Vector(-2, 0)},
                                  {Keyboard::UPARROW, Vector(0, -1)}};

bool isWall(const World& world, const Object& walker, Vector at) {
  const ObjectList there = world.objects().getCollisions(&walker, at);
  for (int i = 0; i < there.getCount(); ++i)
    if (there[i]->getType() == "Wall") return true;
  return false;
}

/// Returns the keys of a shortest path to the exit; none if there is no path.
std::vector<Keyboard::Key> solve(const World& world, const Object& walker) {
  const Vector exit = world.objects().objectsOfType("Exit")[0]->getPosition();
  const auto name = [](Vector v) { return std::pair(v.x(), v.y()); };
  std::map<std::pair<double, double>, std::vector<Keyboard::Key>> known = {{name(walker.getPosition()), {}}};
  std::deque<Vector> next = {walker.getPosition()};
  while (!next.empty()) {
    const Vector at = next.front();
    next.pop_front();
    if (at == exit) return known[name(at)];
    for (const Step& step : kSteps) {
      const Vector there = at + step.way;
      if (known.contains(name(there)) || isWall(world, walker, there)) continue;
      known[name(there)] = known[name(at)];
      known[name(there)].push_back(step.key);
      next.push_back(there);
    }
  }
  return {};
}

TEST(Maze, EverySeedHasSevenHundredWallsAndAPath) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    hostGame(maze_main, seed, [](World& world) {
      const std::uint32_t ann = joinAnn(world);
      EXPECT_EQ(world.objects().objectsOfType("Wall").getCount(), 700);
      EXPECT_GE(solve(world, *world.views().player(ann)->getObject()).size(), 70u);
    });
  }
}

TEST(Maze, ABotWithThePathWinsThreeMazes) {
  hostGame(maze_main, 1, [](World& world) {
    const std::uint32_t ann = world.input().join("ann", RED);
    world.input().join("bob", GREEN);
    world.tick();
    const Vector corner = world.views().player(ann)->getViewCorner();
    for (int maze = 0; maze < 3; ++maze) {
      for (const Keyboard::Key key : solve(world, *world.views().player(ann)->getObject())) {
        tap(world, ann, key);
        tick(world, 3);
      }
      EXPECT_GT(world.views().player(ann)->getViewCorner().x(), corner.x()) << "it follows the player";
      EXPECT_TRUE(shows(world, ann, "()"));
      world.tick();
      EXPECT_EQ(world.views().player(ann)->getScore(), maze + 1);
      EXPECT_NE(world.picture().renderPlayer(ann).text().find("ann has found the exit!"), std::string::npos);
      tick(world, 70);
      EXPECT_EQ(world.objects().objectsOfType("Wall").getCount(), 700);
      EXPECT_EQ(world.objects().objectsOfType("Walker").getCount(), 2);
    }
  });
}

TEST(Maze, PlayersSwapPlacesInAPassage) {
  hostGame(maze_main, 1, [](World& world) {
    const std::uint32_t ann = world.input().join("ann", RED);
    const std::uint32_t bob = world.input().join("bob", GREEN);
    world.tick();
    const Keyboard::Key first = solve(world, *world.views().player(ann)->getObject()).front();
    tap(world, ann, first);
    tick(world, 4);
    const Vector of_ann = world.views().player(ann)->getObject()->getPosition();
    const Vector of_bob = world.views().player(bob)->getObject()->getPosition();
    ASSERT_NE(of_ann, of_bob);
    tap(world, bob, first);
    tick(world, 4);
    EXPECT_EQ(world.views().player(bob)->getObject()->getPosition(), of_ann);
    EXPECT_EQ(world.views().player(ann)->getObject()->getPosition(), of_bob);
  });
}

}  // namespace
}  // namespace naiad

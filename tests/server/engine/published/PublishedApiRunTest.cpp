// Runs the functions that PublishedApiTest.cpp compiles. That file includes no test headers, so it compiles
// under the conditions of a game.

#include "tests/server/engine/Probe.h"

int published_api_main(int argc, char* argv[]);

namespace df::test {
namespace {

using PublishedApi = WorldTest;

TEST_F(PublishedApi, EveryPublishedNameExistsAndRuns) {
  EXPECT_EQ(published_api_main(0, nullptr), 0);
  EXPECT_EQ(logged("sprites/ship-spr.txt: cannot be read"), 1);
  EXPECT_EQ(logged("games need no sockets here"), 1);
  EXPECT_EQ(logged("is removed from the game"), 0);
}

}  // namespace
}  // namespace df::test

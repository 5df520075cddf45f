// Runs the functions that PublishedApiTest.cpp and PublishedHeaderTest.cpp compile. Those files have the
// includes of a game, and no test headers.

#include <dlfcn.h>

#include "tests/server/engine/Probe.h"
#include "utility.h"

df::ObjectListIterator overObjectsOf(df::ObjectList& list);
bool isWayFound(const df::Event* p_e);
float nearTo(const df::Object* p_o);
int namesOfAGame();
int stepsOfTheEngineSpelledTwice();
void pastTheEngine();
int logStrings(const df::Object& o);
int published_api_main(int argc, char* argv[]);

namespace df::test {
namespace {

using PublishedApi = WorldTest;
using PublishedHeader = WorldTest;

TEST_F(PublishedApi, EveryPublishedNameExistsAndRuns) {
  EXPECT_EQ(published_api_main(0, nullptr), 0);
  EXPECT_EQ(logged("sprites/ship-spr.txt: cannot be read"), 1);
  EXPECT_EQ(logged("games need no sockets here"), 1);
  EXPECT_EQ(logged("is removed from the game"), 0);
}

TEST_F(PublishedHeader, HeaderIncludesTheNamesGamesUse) {
  Probe a("a");
  Probe b("b");
  ObjectList list = WM.getAllObjects();
  ObjectListIterator li = overObjectsOf(list);
  EXPECT_EQ(li.currentObject(), &b);
  expectAt(a, 1, 2);
  EXPECT_TRUE(isWayFound(std::make_unique<EventPath>().get()));
  EXPECT_FLOAT_EQ(nearTo(&a), std::sqrt(5.0f));
  EXPECT_GT(namesOfAGame(), 0);
  EXPECT_EQ(stepsOfTheEngineSpelledTwice(), WM.getAllObjects().getCount());
  pastTheEngine();
}

TEST_F(PublishedHeader, StringsAreLoggedUnchanged) {
  const Probe probe("gems");
  EXPECT_EQ(logStrings(probe), 1);
  EXPECT_EQ(lines, (std::vector<std::string>{"ann has 3 of gems", "ann", "5"}));
}

// An inline string would be one variable for library (C++20) and game (C++17). The two initialise it in
// different ways, and in a C++17 game it would stay empty.
TEST(PublishedHeaderStrings, AreLocalToTheirTranslationUnit) {
  for (const char* name : {"CONFIG_FILENAME", "WINDOW_TITLE_DEFAULT", "FONT_FILE_DEFAULT", "LOGFILE_DEFAULT",
                           "DRAGONFLY_PORT", "UNDEFINED_STATE"}) {
    const std::string symbol = "_ZN2df" + std::to_string(std::strlen(name)) + name + "B5cxx11E";
    EXPECT_EQ(dlsym(RTLD_DEFAULT, symbol.c_str()), nullptr) << name;
  }
  EXPECT_NE(dlsym(RTLD_DEFAULT, "_ZN2df15UNDEFINED_EVENTE"), nullptr) << "an event type is one for all";
}

TEST_F(PublishedHeader, AccelerateAddsAccelerationToVelocity) {
  Probe probe;
  probe.setVelocity(Vector(1, 0));
  probe.setAcceleration(Vector(0.5, 0.25));
  probe.accelerate();
  EXPECT_EQ(probe.getVelocity(), Vector(1.5, 0.25));
  EXPECT_EQ(Box(Vector(1, 2), 3, 4).toString(), "(1.000000,2.000000),3.000000,4.000000");
}

TEST_F(PublishedHeader, SfmlColoursAndClockAreAvailable) {
  EXPECT_TRUE(colorToSFML(RED) == sf::Color::Red);
  EXPECT_TRUE(colorToSFML(BLACK) == sf::Color::Black);
  const sf::Clock clock;
  const sf::Time before = clock.getElapsedTime();
  world.tick();
  EXPECT_GT(clock.getElapsedTime() - before, sf::milliseconds(30));
}

}  // namespace
}  // namespace df::test

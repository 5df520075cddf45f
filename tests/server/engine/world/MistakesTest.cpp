// Tests mistakes of beginners. Each logs one line that names the cause, and docs/when-it-goes-wrong.md lists
// that line. Mistakes that need a process of their own are in tests/loopback/TroubleTest.cpp.

#include <memory>
#include <stdexcept>

#include "engine/events/EventStep.h"
#include "engine/managers/Config.h"
#include "engine/managers/DisplayManager.h"
#include "engine/managers/ResourceManager.h"
#include "engine/world/ActivityPage.h"
#include "engine/world/ClassName.h"
#include "tests/server/engine/Probe.h"
#include "tests/support/NotANumber.h"
#include "tests/support/Text.h"

namespace df::test {

class Saucer : public Object {};

class Deaf : public Object {
 public:
  Deaf() { registerInterest(STEP_EVENT); }
  virtual int eventHandler(Event* /*p_e*/) { return 1; }
};

class Forgetful : public Object {
 public:
  int eventHandler(const Event* p_e) override { return p_e->getType() == STEP_EVENT; }
};

class Registered : public Forgetful {
 public:
  Registered() { registerInterest(KEYBOARD_EVENT); }
};

class Struck : public Forgetful {};
class Asleep : public Forgetful {};
class EventNuke : public Event {};

namespace {

const std::string& page() {
  static const std::string text = naiad::test::contentOf(NAIAD_SOURCE_DIR "/docs/when-it-goes-wrong.md");
  return text;
}

/// Removes the tests' namespace from a line, because a game's own classes are outside all namespaces.
std::string withoutNamespace(std::string line) {
  const std::string prefix = "df::test::";
  for (std::size_t at = 0; (at = line.find(prefix)) != std::string::npos;) line.erase(at, prefix.size());
  return line;
}

class Mistakes : public WorldTest {
 protected:
  /// Expects that this line is the only one logged and is listed on the page.
  void expectLine(const std::string& line) {
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_EQ(withoutNamespace(lines[0]), line);
    EXPECT_NE(page().find("`" + line + "`"), std::string::npos) << "not in the page: " << line;
    lines.clear();
  }
  /// Expects one log line with this beginning, which is listed on the page.
  void expectBeginning(const std::string& beginning) {
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_EQ(lines[0].rfind(beginning, 0), 0u) << lines[0];
    EXPECT_NE(page().find("`" + beginning), std::string::npos) << "not in the page: " << beginning;
    lines.clear();
  }
};

TEST_F(Mistakes, HandlerWithoutOverrideIsReported) {
  new Deaf;
  new Deaf;
  ticks(2);
  expectLine(
      "Deaf registers interest in events but has no matching eventHandler(): it must be "
      "declared \"int eventHandler(const df::Event*) override\"");
}

TEST_F(Mistakes, InterestInAMisspelledEngineEventIsReported) {
  auto* p_saucer = new Saucer;
  p_saucer->registerInterest("step");
  p_saucer->registerInterest("steps");  // no message: may be the game's own event
  expectLine("registerInterest(\"step\"): the engine sends no such event; it sends df::STEP_EVENT");
}

TEST_F(Mistakes, HandlerThatNeverRegisteredIsReportedOnce) {
  new Saucer;  // has no handler
  new Registered;
  (new Asleep)->setActive(false);
  new Forgetful;
  new Forgetful;
  auto* p_struck = new Struck;
  p_struck->setPosition(Vector(40, 12));
  ticks(290);
  (new Saucer)->setPosition(Vector(41, 12));
  WM.moveObject(p_struck, Vector(41, 12));  // collisions need no registration
  new Forgetful;
  EXPECT_TRUE(lines.empty()) << lines[0];
  ticks(400);
  ASSERT_EQ(lines.size(), 1u);
  lines[0].replace(lines[0].find("Forgetful"), 9, "Saucer");
  expectLine(
      "Saucer has an eventHandler() that got no event in 300 ticks, and it registers interest in none: was "
      "registerInterest() forgotten?");
}

TEST_F(Mistakes, UnknownConfigurationKeyIsReportedWithTheNearest) {
  Config::getInstance().loadConfig("frame_tme:20,");
  Config::reportUnknownKeys();
  Config::reportUnknownKeys();
  expectLine("Configuration: there is no key \"frame_tme\"; did you mean frame_time?");
  Config::getInstance().loadConfig("window_title:Saucers\nheadless:true,");
  Config::reportUnknownKeys();
  expectLine("Configuration: a comma is missing before headless");
}

TEST_F(Mistakes, EventWithoutATypeIsReported) {
  const EventNuke nuke;
  WM.onEvent(&nuke);
  WM.onEvent(&nuke);
  expectLine("WM.onEvent() of a EventNuke without a type: setType() was forgotten");
}

TEST_F(Mistakes, HandlerExceptionIsReported) {
  auto* p_saucer = new Probe("Saucer");
  p_saucer->hear(STEP_EVENT, [](Probe&, const Event&) { throw std::runtime_error("no sprite"); });
  world.tick();
  expectLine("An object of type Saucer threw an exception and is removed from the game: no sprite");
}

TEST_F(Mistakes, NestedRunIsReported) {
  auto* p_saucer = new Probe("Saucer");
  p_saucer->hear(STEP_EVENT, [](Probe&, const Event&) { GM.run(); });
  ticks(2);
  EXPECT_EQ(GM.getStepCount(), 2);
  expectLine("GM.run() inside a handler does nothing: the game is running");
}

TEST_F(Mistakes, MissingSpriteFileIsReported) {
  EXPECT_EQ(RM.loadSprite("sprites/saucr.txt", "saucer"), -1);
  expectBeginning("Sprite saucer: sprites/saucr.txt: cannot be read; looked in /");
}

TEST_F(Mistakes, OverlongSpriteRowIsReportedWithItsLine) {
  const std::string file = std::string(NAIAD_SOURCE_DIR) + "/tests/server/engine/sprites/bad-long-row.txt";
  EXPECT_EQ(RM.loadSprite(file, "saucer"), -1);
  EXPECT_EQ(logged(":7: the row has 4 characters instead of 3"), 1);
  EXPECT_NE(page().find(":7: the row has 4 characters instead of 3`"), std::string::npos);
}

TEST_F(Mistakes, UnknownSpriteLabelIsReported) {
  auto* p_saucer = new Saucer;
  EXPECT_EQ(p_saucer->setSprite("saucr"), -1);
  EXPECT_EQ(p_saucer->setSprite("saucr"), -1);
  expectLine("setSprite(\"saucr\") of Saucer: no sprite is loaded under this label; loaded: none");
  RM.loadSprite(std::string(NAIAD_SOURCE_DIR) + "/tests/server/engine/sprites/simple.txt", "saucer");
  const auto p_page = std::make_unique<ActivityPage>();
  world.setActivityPage(p_page.get());
  EXPECT_EQ(RM.getSprite("saucr"), nullptr) << "games ask so whether it is still to be loaded";
  EXPECT_EQ(RM.getSprite("saucr"), nullptr);
  world.setActivityPage(nullptr);
  const std::string line = "RM.getSprite(\"saucr\"): nothing is loaded under this label; loaded: saucer";
  EXPECT_EQ(p_page->lines[0].text, line);
  EXPECT_EQ(p_page->lines_written, 1u);
  EXPECT_EQ(logged(line), 0) << "it need not be a fault";
  EXPECT_NE(page().find("`" + line + "`"), std::string::npos);
}

TEST_F(Mistakes, MissingSoundFileIsReported) {
  EXPECT_EQ(RM.loadSound("sounds/fier.wav", "fire"), -1);
  expectBeginning("Sound: sounds/fier.wav: cannot be read; looked in /");
}

TEST_F(Mistakes, UnknownSoundIsSilentAndReported) {
  world.store().setWatched(true);
  RM.getSound("fire")->play();
  RM.getSound("fire")->play(true);
  expectLine("RM.getSound(\"fire\"): nothing is loaded under this label; loaded: none");
  RM.getMusic("theme")->play();
  expectLine("RM.getMusic(\"theme\"): nothing is loaded under this label; loaded: none");
  world.tick();
  EXPECT_TRUE(world.picture().view().sounds.empty());
}

TEST_F(Mistakes, ClassWithoutSetTypeIsReported) {
  new Saucer;
  EXPECT_TRUE(world.objects().objectsOfType("Saucer").isEmpty());
  EXPECT_TRUE(world.objects().objectsOfType("Saucer").isEmpty());
  EXPECT_TRUE(world.objects().objectsOfType("Bullet").isEmpty());  // no message: there may be no Bullet now
  expectLine(
      "WM.objectsOfType(\"Saucer\") finds none: class Saucer does not call "
      "setType(\"Saucer\")");
}

TEST_F(Mistakes, RefusingSettersAreReportedOnceEach) {
  auto* p_saucer = new Saucer;
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(p_saucer->setAltitude(5), -1);
    EXPECT_EQ(p_saucer->setPosition(Vector(kNan, 1)), -1);
  }
  ASSERT_EQ(lines.size(), 2u);
  const std::string second = lines.back();
  lines.pop_back();
  expectLine("Refused: setAltitude of Saucer: an altitude is 0 to 4 (further ones are only counted)");
  lines = {second};
  expectLine(
      "Refused: setPosition of Saucer: a number is not finite (a division by 0?) or out of range "
      "(further ones are only counted)");
  EXPECT_EQ(world.log().refusals(), 6u);
  EXPECT_EQ(p_saucer->setSolidness(static_cast<Solidness>(7)), -1);
  expectLine(
      "Refused: setSolidness of Saucer: a solidness is HARD, SOFT or SPECTRAL (further ones are only "
      "counted)");
  p_saucer->setVelocity(Vector(1 / (kNan - kNan), 0));
  expectLine(
      "Refused: setVelocity of Saucer: a number is not finite (a division by 0?) or out of range "
      "(further ones are only counted)");
  DM.drawCh(Vector(kNan, 0), 'x', RED);
  expectLine(
      "Refused: drawCh of DisplayManager: a number is not finite (a division by 0?) or out of range (further "
      "ones are only counted)");
}

TEST_F(Mistakes, NullObjectsAreReported) {
  WM.markForDelete(static_cast<Object*>(nullptr));
  expectLine("WM.markForDelete() of a null pointer");
  WM.moveObject(nullptr, Vector());
  expectLine("WM.moveObject() of a null pointer");
}

TEST_F(Mistakes, DeletingAnObjectNotMadeWithNewIsReported) {
  Saucer saucer;
  WM.markForDelete(&saucer);
  world.tick();
  expectLine("Marked for deletion, but not made with new, so only removed: object of type Saucer");
}

TEST(ClassName, MatchesTheSourceCode) {
  struct Local {};
  EXPECT_EQ(classNameOf(typeid(Saucer)), "df::test::Saucer");
  EXPECT_NE(classNameOf(typeid(Local)).find("Local"), std::string::npos);
}

}  // namespace
}  // namespace df::test

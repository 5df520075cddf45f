#include "engine/events/EventStep.h"
#include "engine/managers/DisplayManager.h"
#include "engine/widgets/Button.h"
#include "engine/widgets/Pause.h"
#include "engine/widgets/TextBox.h"
#include "engine/widgets/TextEntry.h"
#include "engine/widgets/ViewObject.h"
#include "tests/server/engine/Probe.h"

namespace df::test {
namespace {

class ViewObjectTest : public WorldTest {
 protected:
  std::string row(int y) {
    const std::string text = world.picture().render(viewCorner()).rowText(y);
    return text.substr(0, text.find_last_not_of(' ') + 1);
  }
  FixedVector viewCorner() const { return *toFixed(WM.getView().getCorner()); }
};

TEST_F(ViewObjectTest, DefaultsToSpectralTopmostWithBorderAndValue) {
  const ViewObject points;
  EXPECT_EQ(points.getSolidness(), SPECTRAL);
  EXPECT_EQ(points.getAltitude(), MAX_ALTITUDE);
  EXPECT_EQ(points.getLocation(), TOP_CENTER);
  EXPECT_TRUE(points.getBorder());
  EXPECT_TRUE(points.getDrawValue());
  EXPECT_EQ(points.getValue(), 0);
  EXPECT_EQ(points.getColor(), COLOR_DEFAULT);
}

TEST_F(ViewObjectTest, ShowsTextAndValueInABorder) {
  ViewObject points;
  points.setViewString("Points");
  points.setValue(42);
  world.tick();
  // The text of 11 characters is centred in a window of 80 cells.
  EXPECT_EQ(row(0), std::string(34, ' ') + "+-----------+");
  EXPECT_EQ(row(1), std::string(34, ' ') + "| Points 42 |");
  EXPECT_EQ(row(2), std::string(34, ' ') + "+-----------+");
}

TEST_F(ViewObjectTest, BorderlessObjectLiesOnTheOutermostRow) {
  ViewObject points;
  points.setViewString("Lives");
  points.setBorder(false);
  world.tick();
  EXPECT_EQ(row(0), std::string(37, ' ') + "Lives 0");
  points.setLocation(BOTTOM_LEFT);
  points.setDrawValue(false);
  world.tick();
  EXPECT_EQ(row(0), "");
  EXPECT_EQ(row(23), std::string(11, ' ') + "Lives");
}

TEST_F(ViewObjectTest, LocationsAreAtSixthsOfTheWidth) {
  ViewObject o;
  o.setLocation(TOP_LEFT);
  EXPECT_NEAR(o.getPosition().x(), 80 / 6.0, 1e-6);
  o.setLocation(BOTTOM_RIGHT);
  EXPECT_NEAR(o.getPosition().x(), 80 * 5 / 6.0, 1e-6);
  EXPECT_EQ(o.getPosition().y(), 22);
  o.setLocation(CENTER_CENTER);
  EXPECT_EQ(o.getPosition(), Vector(40, 12));
  o.setPosition(Vector(3, 4));
  EXPECT_EQ(o.getLocation(), UNDEFINED);
  o.setBorder(false);
  EXPECT_EQ(o.getPosition(), Vector(3, 4));
}

TEST_F(ViewObjectTest, ViewEventsSetAndAddForMatchingTags) {
  ViewObject points;
  points.setViewString("Points");
  ViewObject lives;
  lives.setViewString("Lives");
  const EventView set("Points", 10, false);
  EXPECT_EQ(WM.onEvent(&set), 2);
  const EventView add("Points", -3, true);
  WM.onEvent(&add);
  EXPECT_EQ(points.getValue(), 7);
  EXPECT_EQ(lives.getValue(), 0);
}

TEST_F(ViewObjectTest, StaysOnScreenWhenTheViewMoves) {
  WM.setBoundary(Box(Vector(), 400, 100));
  ViewObject points;
  points.setViewString("P");
  points.setBorder(false);
  points.setLocation(TOP_LEFT);
  world.tick();
  const std::string before = row(0);
  EXPECT_NE(before, "");
  WM.setViewPosition(Vector(300, 70));
  world.tick();
  EXPECT_EQ(row(0), before);
}

TEST_F(ViewObjectTest, IsDrawnInEveryPlayersView) {
  WM.setBoundary(Box(Vector(), 400, 100));
  ViewObject points;
  points.setViewString("P");
  points.setBorder(false);
  points.setLocation(TOP_LEFT);
  const std::uint32_t player = joined("ann");
  auto* p_ship = new PlacedObject(Vector(300, 70));
  world.views().player(player)->setObject(p_ship);
  world.tick();
  EXPECT_NE(world.picture().renderPlayer(player).rowText(0).find("P 0"), std::string::npos);
  EXPECT_EQ(world.picture().renderPlayer(player).rowText(0), world.picture().render({}).rowText(0));
}

struct Entry : TextEntry {
  std::vector<std::string> entered;
  void callback() override { entered.push_back(getText()); }
};

TEST_F(ViewObjectTest, TextEntryTakesKeysUntilReturn) {
  Entry entry;
  entry.setViewString("Name:");
  press(Keyboard::LEFTSHIFT);
  press(Keyboard::A);
  press(Keyboard::LEFTSHIFT, KEY_RELEASED);
  press(Keyboard::B);
  press(Keyboard::B, KEY_RELEASED);
  press(Keyboard::NUM7);
  press(Keyboard::NUM0);
  press(Keyboard::BACKSPACE);
  EXPECT_EQ(entry.getText(), "Ab7");
  press(Keyboard::LEFTARROW);
  press(Keyboard::MINUS);
  EXPECT_EQ(entry.getText(), "Ab-7");
  press(Keyboard::RETURN);
  EXPECT_EQ(entry.entered, std::vector<std::string>{"Ab-7"});
  entry.setBlinkRate(0);
  world.tick();
  EXPECT_NE(row(1).find("Name: Ab-_7"), std::string::npos) << row(1);
}

TEST_F(ViewObjectTest, TextEntryBelongsToThePlayerThatOpenedIt) {
  const std::uint32_t ann = joined("ann"), bob = joined("bob", BLUE);
  Entry* p_entry = nullptr;
  Probe probe;
  probe.hear(KEYBOARD_EVENT, [&](Probe& p, const Event&) {
    p_entry = new Entry;
    p.unregisterInterest(KEYBOARD_EVENT);
  });
  pressedBy({ann}, Keyboard::SPACE);
  ASSERT_NE(p_entry, nullptr);
  EXPECT_EQ(p_entry->getPlayer(), ann);
  p_entry->clearText();
  world.input().key(bob, Keyboard::LEFTSHIFT, KEY_PRESSED);
  world.input().key(ann, Keyboard::A, KEY_PRESSED);
  world.input().key(bob, Keyboard::B, KEY_PRESSED);
  world.input().key(bob, Keyboard::RETURN, KEY_PRESSED);
  world.tick();
  EXPECT_EQ(p_entry->getText(), "a");
  EXPECT_TRUE(p_entry->entered.empty());
  left(ann);
  pressedBy({bob}, Keyboard::RETURN);
  EXPECT_EQ(p_entry->entered, std::vector<std::string>{"a"}) << "any player can finish";
}

TEST_F(ViewObjectTest, UnassignedTextEntryTakesKeysOfAllPlayers) {
  const std::uint32_t ann = world.input().join("ann", RED);
  const std::uint32_t bob = world.input().join("bob", BLUE);
  Entry entry;
  EXPECT_EQ(entry.getPlayer(), 0u);
  world.input().key(ann, Keyboard::A, KEY_PRESSED);
  world.input().key(bob, Keyboard::B, KEY_PRESSED);
  world.tick();
  EXPECT_EQ(entry.getText(), "ab");
  entry.setPlayer(bob);
  world.input().key(ann, Keyboard::A, KEY_PRESSED);
  world.input().key(bob, Keyboard::B, KEY_PRESSED);
  world.tick();
  EXPECT_EQ(entry.getText(), "abb");
  entry.setPlayer(0);
  pressedBy({ann}, Keyboard::C);
  EXPECT_EQ(entry.getText(), "abbc");
}

TEST_F(ViewObjectTest, TextEntryEnforcesLengthLimitAndDigitsOnly) {
  Entry entry;
  entry.setLimit(2);
  entry.setNumbersOnly();
  press(Keyboard::A);
  for (int i = 0; i < 5; ++i) press(Keyboard::NUM1);
  EXPECT_EQ(entry.getText(), "11");
  entry.setText("12345");
  EXPECT_EQ(entry.getLimit(), 5);
  entry.clearText();
  EXPECT_EQ(entry.getCursor(), 0);
  press(Keyboard::BACKSPACE);
  EXPECT_EQ(entry.getText(), "");
}

TEST_F(ViewObjectTest, TextBoxWrapsWordsAndShowsTheEnd) {
  TextBox box;
  box.setSize(Vector(10, 2));
  box.setText("one two three\nfour");
  box.addText(" five");
  EXPECT_EQ(box.lines(), (std::vector<std::string>{"one two", "three", "four", "five"}));
  box.setLocation(CENTER_CENTER);
  world.tick();
  EXPECT_NE(row(11).find("| four     |"), std::string::npos) << row(11);
  EXPECT_NE(row(12).find("| five     |"), std::string::npos) << row(12);
  box.setWordWrap(false);
  box.setPadding(false);
  box.setText("abcdefghijklm");
  EXPECT_EQ(box.lines(), (std::vector<std::string>{"abcdefghij", "klm"}));
}

struct Quit : Button {
  int calls = 0;
  void callback() override { ++calls; }
};

TEST_F(ViewObjectTest, ButtonLightsUpUnderTheMouseAndIsClicked) {
  Quit quit;
  quit.setViewString("Quit");
  EventMouse event;
  event.setMouseAction(MOVED);
  event.setMousePosition(Vector(40, 1));
  WM.onEvent(&event);
  EXPECT_EQ(quit.getColor(), RED);
  EXPECT_EQ(quit.calls, 0);
  event.setMouseAction(CLICKED);
  event.setMouseButton(Mouse::LEFT);
  WM.onEvent(&event);
  EXPECT_EQ(quit.calls, 1);
  event.setMousePosition(Vector(60, 1));
  WM.onEvent(&event);
  EXPECT_EQ(quit.calls, 1);
  EXPECT_EQ(quit.getColor(), COLOR_DEFAULT);
}

TEST_F(ViewObjectTest, PauseStopsStepsMovesAndInputUntilResumed) {
  Probe mover("mover", &received, Vector(5, 5));
  mover.setVelocity(Vector(1, 0));
  mover.registerInterest(STEP_EVENT);
  mover.registerInterest(KEYBOARD_EVENT);
  mover.on_draw = [](Probe& p) { DM.drawCh(p.getPosition(), '@', RED); };
  new Pause(Keyboard::P);
  press(Keyboard::P);
  received.clear();
  EXPECT_TRUE(world.isPaused());
  for (int i = 0; i < 3; ++i) world.tick();
  press(Keyboard::A);
  EXPECT_TRUE(received.empty());
  expectAt(mover, 5, 5);
  EXPECT_EQ(row(5), "     @");
  EXPECT_EQ(world.getStepCount(), 3);
  press(Keyboard::P);
  world.tick();
  expectAt(mover, 6, 5);
  EXPECT_FALSE(received.empty());
}

TEST_F(ViewObjectTest, DeletingThePauseResumesTheGame) {
  auto* p_pause = new Pause(Keyboard::P);
  press(Keyboard::P);
  delete p_pause;
  EXPECT_FALSE(world.isPaused());
}

}  // namespace
}  // namespace df::test

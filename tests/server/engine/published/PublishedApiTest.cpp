// Every header and name of the published engine that games use, used as in games: with `using namespace`,
// with and without `df::`, relying on the engine's indirect includes. The test is that this file compiles;
// running it shows that no name crashes.

#include <vector.h>

#include <SFML/Graphics/RenderWindow.hpp>
#include <SFML/Window/Mouse.hpp>

#include "Animation.h"
#include "Box.h"
#include "Button.h"
#include "Circle.h"
#include "Clock.h"
#include "Color.h"
#include "Config.h"
#include "Debris.h"
#include "DisplayManager.h"
#include "Event.h"
#include "EventCollision.h"
#include "EventKeyboard.h"
#include "EventKeyboardNetwork.h"
#include "EventMouse.h"
#include "EventMouseNetwork.h"
#include "EventNetwork.h"
#include "EventNetworkAccept.h"
#include "EventNetworkClose.h"
#include "EventNetworkConnect.h"
#include "EventNetworkCreate.h"
#include "EventNetworkCustom.h"
#include "EventNetworkDelete.h"
#include "EventNetworkGameOver.h"
#include "EventNetworkSync.h"
#include "EventOut.h"
#include "EventPath.h"
#include "EventStep.h"
#include "EventView.h"
#include "Fader.h"
#include "Frame.h"
#include "GameManager.h"
#include "GraphicsManager.h"
#include "InputManager.h"
#include "Line.h"
#include "LogManager.h"
#include "Manager.h"
#include "Music.h"
#include "NetworkManager.h"
#include "NetworkNode.h"
#include "Object.h"
#include "ObjectList.h"
#include "ObjectListIterator.h"
#include "Particle.h"
#include "Path.h"
#include "PathFind.h"
#include "Pause.h"
#include "Precipitation.h"
#include "Ref.h"
#include "ResourceManager.h"
#include "SceneGraph.h"
#include "Shape.h"
#include "Sound.h"
#include "Sprite.h"
#include "State.h"
#include "StateMachine.h"
#include "TextBox.h"
#include "TextEntry.h"
#include "Vector.h"
#include "ViewObject.h"
#include "WorldManager.h"
#include "utility.h"

using namespace df;

// Class names that many games use; the engine's own classes of these names must not collide with them.
class Player : public Object {};
class Runner : public Object {};

namespace {

#if !defined(DF_REGISTER_INTEREST) || !defined(GM) || !defined(WM) || !defined(LM) || !defined(RM) || \
    !defined(DM) || !defined(IM) || !defined(NM)
#error a macro is missing
#endif

// Some games' handlers lack a final return. Calling one would be undefined behaviour.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wreturn-type"
class Careless : public df::Object {
 public:
  int eventHandler(const df::Event* p_e) {
    if (p_e->getType() == df::STEP_EVENT) return 1;
  }
};
#pragma GCC diagnostic pop

class EventNuke : public Event {
 public:
  EventNuke() { setType("nuke"); }
};

class Hero : public Object {
 private:
  Sound* p_sound;
  int fire_countdown;
  void kbd(const EventKeyboard* p_keyboard_event);

 public:
  int lives = 3;
  Hero();
  ~Hero();
  int eventHandler(const Event* p_e);
  int draw(void);
};

Hero::Hero() {
  if (setSprite("ship") != 0) LM.writeLog("Hero::Hero(): no sprite %s", "ship");
  registerInterest(df::KEYBOARD_EVENT);
  registerInterest(STEP_EVENT);
  registerInterest(MSE_EVENT);
  setType("Hero");
  setSolidness(df::HARD);
  setAltitude(MAX_ALTITUDE - 1);
  Vector p(7, WM.getBoundary().getVertical() / 2);
  setPosition(p);
  p_sound = RM.getSound("fire");
  if (p_sound) p_sound->play();
  fire_countdown = 0;
}

Hero::~Hero() {
  df::EventView ev("Lives", -1, true);
  WM.onEvent(&ev);
  addParticles(df::SPARKS, getPosition(), 1.5, df::YELLOW);
  addParticles(df::ParticleType::SMOKE, getPosition());
  DM.shake(20, 20, 5);
}

int Hero::eventHandler(const Event* p_e) {
  if (p_e->getType() == df::KEYBOARD_EVENT) {
    const df::EventKeyboard* p_keyboard_event = dynamic_cast<const df::EventKeyboard*>(p_e);
    kbd(p_keyboard_event);
    return 1;
  }
  if (p_e->getType() == MSE_EVENT) {
    const EventMouse* p = static_cast<const EventMouse*>(p_e);
    return p->getMouseAction() == EventMouseAction::MOVED ||
           p->getMouseButton() == Mouse::EventMouseButton::RIGHT;
  }
  if (p_e->getType() == STEP_EVENT) {
    const EventStep* p_step = dynamic_cast<const EventStep*>(p_e);
    if (p_step->getStepCount() % 2 == 0 && fire_countdown > 0) fire_countdown--;
    return 1;
  }
  return Object::eventHandler(p_e);
}

void Hero::kbd(const EventKeyboard* p) {
  switch (p->getKey()) {
    case Keyboard::Q:
      if (p->getKeyboardAction() == KEY_PRESSED) GM.setGameOver();
      break;
    case Keyboard::Key::W:
    case df::Keyboard::UPARROW:
      if (p->getKeyboardAction() == df::EventKeyboardAction::KEY_DOWN) setVelocity(Vector(0, -0.5));
      break;
    case Keyboard::SPACE: {
      EventNuke nuke;
      WM.onEvent(&nuke);
      break;
    }
    default:
      return;
  }
}

int Hero::draw() {
  Object::draw();
  DM.drawCh(getPosition(), '0' + lives, df::RED);
  DM.drawCh(getPosition(), '*', 255, 0, 128);
  return DM.drawString(getPosition(), "ship " + df::toString(lives), CENTER_JUSTIFIED,
                       getSolidness() == HARD ? CYAN : WHITE);
}

class Points : public ViewObject {
 public:
  Points() {
    setLocation(TOP_RIGHT);
    setViewString("Points");
    setColor(df::YELLOW);
    setBorder(false);
    setDrawValue(true);
    setValue(getValue() + 1);
  }
  int draw() override { return ViewObject::draw(); }
  void setValue(int new_value) override { ViewObject::setValue(new_value); }
};

class Name : public TextEntry {
 public:
  void callback() override { clearText(); }
};

class Level : public Manager {
 public:
  Level() { setType("Level"); }
  int startUp() override { return Manager::startUp(); }
  void shutDown() override { Manager::shutDown(); }
};

class Chase : public State {
 public:
  void Enter(Object*) override {}
  void Execute(Object* p_o) override { p_o->setSpeed(0.5); }
};

class Node : public NetworkNode {
 public:
  int eventHandler(const Event* p_e) override { return NetworkNode::eventHandler(p_e); }
  int handleData(const EventNetwork* p_e) override { return p_e->getBytes() + p_e->getSocket(); }
  int handleClose(const EventNetwork* p_e) override { return p_e->getSocketIndex(); }
  Object* createObject(std::string object_type) override { return object_type == "Hero" ? new Hero : NULL; }
};

class Saved : public Object {
 public:
  std::string serialize(std::string attr = "") override { return Object::serialize(attr); }
  int serialize(std::stringstream* p_ss, unsigned int attr = 0) override {
    return Object::serialize(p_ss, attr);
  }
  int deserialize(std::stringstream* p_ss, unsigned int* p_a = NULL) override {
    return Object::deserialize(p_ss, p_a);
  }
  int setActive(bool active = true) override { return Object::setActive(active); }
};

void loadResources() {
  RM.loadSprite("sprites/ship-spr.txt", "ship");
  RM.loadSound("sounds/fire.wav", "fire");
  RM.loadMusic("sounds/theme.wav", "theme");
  Sprite* p_sprite = RM.getSprite("ship");
  if (p_sprite) {
    p_sprite->setColor(RED);
    p_sprite->setSlowdown(p_sprite->getSlowdown() * p_sprite->getFrameCount());
    printf("%s %d %d\n", p_sprite->getLabel().c_str(), p_sprite->getWidth(), p_sprite->getHeight());
  }
  Music* p_music = RM.getMusic("theme");
  if (p_music) {
    p_music->play();
    p_music->getMusic()->setVolume(50);
    p_music->stop();
  }
  Sound sound;
  sound.setLabel("x");
  sound.pause();
  sound.stop();
  sound.getSound().setVolume(10);
  RM.unloadSprite("ship");
}

void worldManager(Object* p_o) {
  ObjectList all = WM.getAllObjects();
  ObjectListIterator li(&all);
  for (li.first(); !li.isDone(); li.next()) {
    Object* p_temp_o = li.currentObject();
    if (p_temp_o->getType() == "Saucer") WM.markForDelete(p_temp_o);
  }
  ObjectList list = WM.objectsOfType("Hero");
  ObjectList empty;
  empty = WM.getCollisions(p_o, p_o->getPosition());
  if (!list.isEmpty() && !list.isFull() && list.getCount() > 0) empty.insert(list[0]);
  empty.remove(p_o);
  empty.clear();
  if (empty != list) empty = list + empty;
  WM.setBoundary(Box(Vector(0, 0), 160, 48));
  WM.setView(Box(Vector(), DM.getHorizontal(), DM.getVertical()));
  WM.setViewFollowing(p_o);
  WM.setViewFollowing(NULL);
  WM.setViewPosition(Vector(40, 12));
  WM.setViewSlack(Vector(0.2f, 0.2f));
  WM.moveObject(p_o, WM.getView().getCorner() + Vector(WM.getView().getHorizontal() / 2, 5));
  if (WM.objectWithId(p_o->getId()) != p_o || WM.isCollision(p_o, Vector(3, 3)))
    LM.writeLog(1, "moved %d", 1);
  WM.solidObjects();
  WM.objectsAtPosition(Vector(1, 1));
  WM.getSceneGraph().activeObjects();
  const Ref<Object> ref = p_o;  // not in the published engine, but must compile in the C++ version of games
  if (ref != nullptr && NULL != ref.get() && p_o != ref.get() && ref != p_o) LM.writeLog(1, "another one");
  WM.removeObject(p_o);
  WM.insertObject(p_o);
  WM.setBoundary(Box(Vector(), 80, 24));
}

void objects(Object* p_o) {
  p_o->setId(Object::max_id + 1);
  p_o->setActive(true);
  p_o->setVisible(p_o->isActive());
  p_o->setDirection(Vector(1, 0));
  p_o->setSpeed(p_o->getSpeed() + p_o->getDirection().getX() + p_o->getVelocity().getMagnitude());
  p_o->setVelocity(Vector());
  p_o->setAcceleration(Vector());
  p_o->predictPosition();
  p_o->setBox(Box(p_o->getBox().getCorner(), p_o->getBox().getHorizontal(), p_o->getBox().getVertical()));
  Animation animation = p_o->getAnimation();
  animation.setIndex(animation.getIndex());
  animation.setSlowdownCount(animation.getSlowdownCount());
  if (animation.getSprite() == NULL) animation.setSprite(p_o->getSprite());
  animation.draw(p_o->getPosition());
  p_o->setAnimation(animation);
  p_o->setSpriteSlowdown(2);
  p_o->setTransparency('#');
  p_o->pathTo(p_o->getPosition() + Vector(1, 1));
  p_o->setFollowPath(false);
  p_o->isModified(ObjectAttribute::POSITION);
  p_o->isModified(df::ObjectAttribute::ID);
  p_o->unregisterInterest(STEP_EVENT);
  p_o->toString();
  Shape shape;
  shape.setColor(df::GREEN);
  shape.setType(df::ShapeType::CIRCLE);
  shape.setSize(10);
  p_o->setShape(shape);
}

void managers() {
  LM.setFlush(true);
  LM.setLogLevel(0);
  GM.getStepCount();
  GM.getFrameTime();
  GM.getGameOver();
  IM.getInput();
  DM.getWindow()->setTitle("a game");
  DM.setBackgroundColor(df::BLACK);
  DM.swapBuffers();
  GraphicsManager& graphics_manager = GraphicsManager::getInstance();
  graphics_manager.drawString(Vector(1, 1), "x", LEFT_JUSTIFIED, MAGENTA);
  graphics_manager.drawString(Vector(1, 1), "x", Justification::RIGHT_JUSTIFIED, df::Color::CYAN);
  df::Config& config = df::Config::getInstance();
  spacesToPixels(Vector(config.getWindowHorizontalPixels(), config.getWindowVerticalPixels()));
  pixelsToSpaces(Vector(charWidth(), charHeight()));
  NetworkManager& network_manager = NetworkManager::getInstance();
  if (NM.connect("localhost") >= 0 || NM.isServer()) exit(1);
  if (network_manager.setServer(true, DRAGONFLY_PORT) != 0 || !NM.isServer()) exit(1);
  NM.setMaxConnections(NM.getNumConnections() + 1);
  NM.isConnected();
  NM.setDelay(1);
  NM.close();
  Level level;
  level.startUp();
  if (level.isStarted() && level.getType() == "Level") level.shutDown();
}

void utilities() {
  const Box box(Vector(1, 1), 3, 3);
  lineIntersectsBox(Line(Vector(), Vector(4, 4)), box);
  boxIntersectsBox(box, box);
  boxContainsPosition(box, Vector(2, 2));
  Object o;
  getWorldBox(&o);
  getWorldBox(&o, Vector(1, 2));
  df::distance(Vector(), Vector(3, 4));
  worldToView(viewToWorld(Vector(1, 1)));
  unsigned char r, g, b;
  colorToRGB(df::RED, r, g, b);
  toString(r + g + b);
  match("a:1,b:2", "b");
  maskToString(3);
  splash();
  Clock clock;
  clock.delta();
  clock.split();
  addParticles(5, 1, Vector(5, 5), 1, Vector(), 0, 2, 1, 0.5, 0.1, 5, 2, 255, 10, r, g, b, 10);
  addParticles(PrecipitationType::RAIN, df::Direction::DOWN);
  new Fader(2, 10, 255, r, g, b);
  new Pause(Keyboard::F10);
  Line(Vector(), Vector(5, 5)).draw();
  Circle(Vector(), 2);
  EventNetworkCreate create(NetworkEventLabel::DATA, &o);
  EventNetworkCustom custom(NetworkEventLabel::DATA);
  EventMouseNetwork mouse;
  EventKeyboardNetwork keyboard;
  mouse.setSocketIndex(1);
  keyboard.setSocketIndex(mouse.getSocketIndex());
  if (create.getObject() != &o || custom.getMessage() || mouse.getType() != NETWORK_MSE_EVENT) exit(1);
  if (create.getLabel() == NetworkEventLabel::CLOSE || custom.getType() != NETWORK_CUSTOM_EVENT) exit(1);
  Vector v;
  v.setXY(1, 2);
  v.setX(v.getY());
  v += Vector(1, 1);
  if (v == Vector() || !(v != Vector(0, 0)) || !v) exit(1);
  TextBox box_of_text;
  box_of_text.setSize(Vector(20, 4));
  box_of_text.setText("text");
  box_of_text.addText("more");
  EventOut out;
  EventCollision collision(&o, &o, Vector());
  collision.setObject1(collision.getObject2());
  Frame frame(1, 1, "x");
  frame.draw(Vector(), RED, ' ');
  Sprite sprite(1);
  sprite.setWidth(frame.getWidth());
  sprite.setHeight(frame.getHeight());
  sprite.setLabel("s");
  sprite.addFrame(frame);
  sprite.draw(0, Vector(2, 2), '#');
  explode(&sprite, 0, Vector(9, 9), 10, 0.5, 0);
  StateMachine machine;
  Chase chase;
  machine.setOwner(&o);
  machine.setState(&chase);
  machine.changeState(&chase);
  machine.Update();
}

}  // namespace

int published_api_main(int argc, char* argv[]) {
  if (GM.startUp() != 0) {
    LM.writeLog("Error starting game manager!");
    GM.shutDown();
    return argc > 5 ? atoi(argv[5]) : 1;
  }
  srand(time(NULL));
  loadResources();
  Hero* p_hero = new Hero;
  new Points;
  Name* p_name = new Name;
  p_name->setLimit(10);
  p_name->setText("ann");
  p_name->setPosition(Vector(10, 10));
  new Node;
  new Saved;
  new Player;
  new Runner;
  new Careless;
  worldManager(p_hero);
  objects(p_hero);
  managers();
  utilities();
  EventKeyboard key;
  key.setKey(Keyboard::Q);
  key.setKeyboardAction(KEY_RELEASED);
  WM.onEvent(&key);
  for (int i = 0; i < 50; i++) GM.tick();
  key.setKeyboardAction(KEY_PRESSED);
  WM.onEvent(&key);
  if (!GM.getGameOver()) GM.setGameOver();  // the hero is deleted
  GM.run();
  GM.shutDown();
  return 0;
}

// The complete Saucer Shoot of the Dragonfly book's tutorial, written as for the published engine: a single
// implied player, sprites from files, sounds, a title and an end.
#include "DisplayManager.h"
#include "Event.h"
#include "EventCollision.h"
#include "EventKeyboard.h"
#include "EventMouse.h"
#include "EventOut.h"
#include "EventStep.h"
#include "EventView.h"
#include "GameManager.h"
#include "LogManager.h"
#include "Music.h"
#include "Object.h"
#include "Pause.h"
#include "ResourceManager.h"
#include "ViewObject.h"
#include "WorldManager.h"
#include "utility.h"

#define POINTS_STRING "Points"

const std::string NUKE_EVENT = "nuke";

// An event that tells every saucer that a nuke went off.
class EventNuke : public df::Event {
 public:
  EventNuke() { setType(NUKE_EVENT); }
};

// A star in the background. When it leaves the view, it starts again at the right with another speed.
class Star : public df::Object {
 public:
  Star() {
    setType("Star");
    setSolidness(df::SPECTRAL);
    setAltitude(0);
    setVelocity(df::Vector(-1.0 / (rand() % 10 + 2), 0));
    setPosition(df::Vector(rand() % (int)WM.getBoundary().getHorizontal(),
                           rand() % (int)WM.getBoundary().getVertical()));
  }

  int draw() override { return DM.drawCh(getPosition(), '.', df::WHITE); }

  int eventHandler(const df::Event* p_e) override {
    if (p_e->getType() != df::OUT_EVENT) return 0;
    setPosition(df::Vector(WM.getBoundary().getHorizontal() + rand() % 20,
                           rand() % (int)WM.getBoundary().getVertical()));
    setVelocity(df::Vector(-1.0 / (rand() % 10 + 2), 0));
    return 1;
  }
};

// The score: one point each second, and ten for each saucer.
class Points : public df::ViewObject {
 public:
  Points() {
    setLocation(df::TOP_RIGHT);
    setViewString(POINTS_STRING);
    setColor(df::YELLOW);
    registerInterest(df::STEP_EVENT);
  }

  int eventHandler(const df::Event* p_e) override {
    if (df::ViewObject::eventHandler(p_e)) return 1;
    if (p_e->getType() != df::STEP_EVENT) return 0;
    if (dynamic_cast<const df::EventStep*>(p_e)->getStepCount() % 30 == 0) setValue(getValue() + 1);
    return 1;
  }
};

// The explosion of a saucer or ship. It lasts until its animation ends.
class Explosion : public df::Object {
 public:
  explicit Explosion(df::Vector where) {
    setType("Explosion");
    time_to_live = 1;
    if (setSprite("explosion") == 0)
      time_to_live = getAnimation().getSprite()->getFrameCount() * getAnimation().getSprite()->getSlowdown();
    setSolidness(df::SPECTRAL);
    setPosition(where);
    registerInterest(df::STEP_EVENT);
  }

  int eventHandler(const df::Event* p_e) override {
    if (p_e->getType() != df::STEP_EVENT) return 0;
    if (--time_to_live <= 0) WM.markForDelete(this);
    return 1;
  }

 private:
  int time_to_live;
};

// A bullet fired by the hero.
class Bullet : public df::Object {
 public:
  explicit Bullet(df::Vector hero_pos) {
    setType("Bullet");
    setSprite("bullet");
    setSolidness(df::SOFT);  // SOFT because it starts close to the ship
    setPosition(df::Vector(hero_pos.getX() + 5, hero_pos.getY()));
    setSpeed(1);
  }

  int eventHandler(const df::Event* p_e) override {
    if (p_e->getType() == df::OUT_EVENT) {
      WM.markForDelete(this);
      return 1;
    }
    if (p_e->getType() == df::COLLISION_EVENT) {
      hit(dynamic_cast<const df::EventCollision*>(p_e));
      return 1;
    }
    return 0;
  }

 private:
  void hit(const df::EventCollision* p_collision_event) {
    if (p_collision_event->getObject1()->getType() == "Saucer" ||
        p_collision_event->getObject2()->getType() == "Saucer") {
      WM.markForDelete(p_collision_event->getObject1());
      WM.markForDelete(p_collision_event->getObject2());
    }
  }
};

// A saucer that comes in from the right. A shot saucer is replaced by another; each that gets through brings
// one more.
class Saucer : public df::Object {
 public:
  Saucer() {
    setSprite("saucer");
    setType("Saucer");
    setVelocity(df::Vector(-0.25, 0));
    shot = false;
    registerInterest(NUKE_EVENT);
    moveToStart();
  }

  ~Saucer() override {
    // Adds ten points for this saucer.
    df::EventView ev(POINTS_STRING, 10, true);
    WM.onEvent(&ev);
  }

  int eventHandler(const df::Event* p_e) override {
    if (p_e->getType() == df::OUT_EVENT) {
      out();
      return 1;
    }
    if (p_e->getType() == df::COLLISION_EVENT) {
      hit(dynamic_cast<const df::EventCollision*>(p_e));
      return 1;
    }
    if (p_e->getType() == NUKE_EVENT) {
      new Explosion(getPosition());
      WM.markForDelete(this);
      new Saucer;
      return 1;
    }
    return 0;
  }

 private:
  void out() {
    if (getPosition().getX() >= 0) return;
    moveToStart();
    new Saucer;
  }

  void hit(const df::EventCollision* p_c) {
    df::Object* p_other = p_c->getObject1() == this ? p_c->getObject2() : p_c->getObject1();
    if (p_other->getType() == "Saucer") return;
    if (p_other->getType() == "Bullet" && !shot) {
      shot = true;  // because it may collide with the bullet again in this update
      new Explosion(getPosition());
      df::Sound* p_sound = RM.getSound("explode");
      if (p_sound != NULL) p_sound->play();
      new Saucer;
    }
    if (p_other->getType() == "Hero") {
      WM.markForDelete(p_c->getObject1());
      WM.markForDelete(p_c->getObject2());
    }
  }

  void moveToStart() {
    float world_horiz = WM.getBoundary().getHorizontal();
    float world_vert = WM.getBoundary().getVertical();
    df::Vector temp_pos(world_horiz + rand() % (int)world_horiz + 3.0f,
                        rand() % (int)(world_vert - 5) + 4.0f);
    // Do not start on top of another object.
    df::ObjectList collision_list = WM.getCollisions(this, temp_pos);
    while (!collision_list.isEmpty()) {
      temp_pos.setX(temp_pos.getX() + 1);
      collision_list = WM.getCollisions(this, temp_pos);
    }
    WM.moveObject(this, temp_pos);
  }

  bool shot;
};

// A reticle at the position of the mouse.
class Reticle : public df::Object {
 public:
  Reticle() {
    setType("Reticle");
    setSolidness(df::SPECTRAL);
    setAltitude(df::MAX_ALTITUDE);
    registerInterest(df::MSE_EVENT);
    setPosition(df::Vector(WM.getBoundary().getHorizontal() / 2, WM.getBoundary().getVertical() / 2));
  }

  int draw() override { return DM.drawCh(getPosition(), '+', df::RED); }

  int eventHandler(const df::Event* p_e) override {
    if (p_e->getType() != df::MSE_EVENT) return 0;
    const df::EventMouse* p_mouse_event = dynamic_cast<const df::EventMouse*>(p_e);
    if (p_mouse_event->getMouseAction() != df::MOVED) return 0;
    setPosition(p_mouse_event->getMousePosition());
    return 1;
  }
};

// The game-over message. It lasts until its animation ends; then the title is shown again.
class GameOver : public df::ViewObject {
 public:
  GameOver() {
    setType("GameOver");
    time_to_live = 1;
    if (setSprite("gameover") == 0)
      time_to_live = getAnimation().getSprite()->getFrameCount() * getAnimation().getSprite()->getSlowdown();
    setLocation(df::CENTER_CENTER);
    registerInterest(df::STEP_EVENT);
  }

  // Removes the objects of the round and shows the title again.
  ~GameOver() override {
    df::ObjectList object_list = WM.getAllObjects(true);
    df::ObjectListIterator i(&object_list);
    for (i.first(); !i.isDone(); i.next()) {
      df::Object* p_o = i.currentObject();
      if (p_o->getType() == "Saucer" || p_o->getType() == "ViewObject") WM.markForDelete(p_o);
      if (p_o->getType() == "GameStart") p_o->setActive(true);
    }
  }

  int eventHandler(const df::Event* p_e) override {
    if (p_e->getType() != df::STEP_EVENT) return 0;
    if (--time_to_live <= 0) WM.markForDelete(this);
    return 1;
  }

  int draw() override { return df::Object::draw(); }

 private:
  int time_to_live;
};

// The player's ship: W and S move it, the mouse fires, space sets off a nuke.
class Hero : public df::Object {
 public:
  Hero() {
    setSprite("ship");
    setType("Hero");
    registerInterest(df::KEYBOARD_EVENT);
    registerInterest(df::MSE_EVENT);
    registerInterest(df::STEP_EVENT);
    df::Vector p(7, WM.getBoundary().getVertical() / 2);
    setPosition(p);
    p_reticle = new Reticle;
    move_slowdown = 2;
    move_countdown = move_slowdown;
    fire_slowdown = 15;
    fire_countdown = fire_slowdown;
    nuke_count = 1;
  }

  ~Hero() override {
    new Explosion(getPosition());
    DM.shake(20, 20, 5);
    WM.markForDelete(p_reticle);
    new GameOver;
  }

  int eventHandler(const df::Event* p_e) override {
    if (p_e->getType() == df::KEYBOARD_EVENT) {
      kbd(dynamic_cast<const df::EventKeyboard*>(p_e));
      return 1;
    }
    if (p_e->getType() == df::MSE_EVENT) {
      mouse(dynamic_cast<const df::EventMouse*>(p_e));
      return 1;
    }
    if (p_e->getType() == df::STEP_EVENT) {
      step();
      return 1;
    }
    return 0;
  }

 private:
  void kbd(const df::EventKeyboard* p_keyboard_event) {
    switch (p_keyboard_event->getKey()) {
      case df::Keyboard::W:
        if (p_keyboard_event->getKeyboardAction() == df::KEY_DOWN) move(-1);
        break;
      case df::Keyboard::S:
        if (p_keyboard_event->getKeyboardAction() == df::KEY_DOWN) move(+1);
        break;
      case df::Keyboard::SPACE:
        if (p_keyboard_event->getKeyboardAction() == df::KEY_PRESSED) nuke();
        break;
      case df::Keyboard::Q:
        if (p_keyboard_event->getKeyboardAction() == df::KEY_PRESSED) WM.markForDelete(this);
        break;
      default:
        break;
    }
  }

  void mouse(const df::EventMouse* p_mouse_event) {
    if (p_mouse_event->getMouseAction() == df::CLICKED && p_mouse_event->getMouseButton() == df::Mouse::LEFT)
      fire(p_mouse_event->getMousePosition());
  }

  void step() {
    move_countdown--;
    if (move_countdown < 0) move_countdown = 0;
    fire_countdown--;
    if (fire_countdown < 0) fire_countdown = 0;
  }

  void move(int dy) {
    if (move_countdown > 0) return;
    move_countdown = move_slowdown;
    df::Vector new_pos(getPosition().getX(), getPosition().getY() + dy);
    if (new_pos.getY() > 3 && new_pos.getY() < WM.getBoundary().getVertical() - 1)
      WM.moveObject(this, new_pos);
  }

  void fire(df::Vector target) {
    if (fire_countdown > 0) return;
    fire_countdown = fire_slowdown;
    df::Vector v = target - getPosition();
    v.normalize();
    v.scale(1);
    Bullet* p = new Bullet(getPosition());
    p->setVelocity(v);
    df::Sound* p_sound = RM.getSound("fire");
    if (p_sound) p_sound->play();
  }

  void nuke() {
    if (!nuke_count) return;
    nuke_count--;
    EventNuke nuke;
    WM.onEvent(&nuke);
    df::EventView ev("Nukes", -1, true);
    WM.onEvent(&ev);
  }

  Reticle* p_reticle;
  int move_slowdown;
  int move_countdown;
  int fire_slowdown;
  int fire_countdown;
  int nuke_count;
};

// The title screen: P plays, Q quits.
class GameStart : public df::ViewObject {
 public:
  GameStart() {
    setType("GameStart");
    setSprite("gamestart");
    setLocation(df::CENTER_CENTER);
    registerInterest(df::KEYBOARD_EVENT);
    p_music = RM.getMusic("start music");
    playMusic();
  }

  int eventHandler(const df::Event* p_e) override {
    if (p_e->getType() == df::KEYBOARD_EVENT) {
      df::EventKeyboard* p_keyboard_event = (df::EventKeyboard*)p_e;
      switch (p_keyboard_event->getKey()) {
        case df::Keyboard::P:
          start();
          break;
        case df::Keyboard::Q:
          GM.setGameOver();
          break;
        default:
          break;
      }
      return 1;
    }
    return 0;
  }

  // Draws the sprite, not a ViewObject's " text value ".
  int draw() override { return df::Object::draw(); }

 private:
  void start() {
    new Hero;
    for (int i = 0; i < 16; i++) new Saucer;
    new Points;
    df::ViewObject* p_vo = new df::ViewObject;
    p_vo->setLocation(df::TOP_LEFT);
    p_vo->setViewString("Nukes");
    p_vo->setValue(1);
    p_vo->setColor(df::YELLOW);
    if (p_music) p_music->pause();
    setActive(false);
  }

  void playMusic() {
    if (p_music != NULL) p_music->play();
  }

  df::Music* p_music;
};

void loadResources(void) {
  RM.loadSprite("sprites/saucer-spr.txt", "saucer");
  RM.loadSprite("sprites/ship-spr.txt", "ship");
  RM.loadSprite("sprites/bullet-spr.txt", "bullet");
  RM.loadSprite("sprites/explosion-spr.txt", "explosion");
  RM.loadSprite("sprites/gamestart-spr.txt", "gamestart");
  RM.loadSprite("sprites/gameover-spr.txt", "gameover");
  RM.loadSound("sounds/fire.wav", "fire");
  RM.loadSound("sounds/explode.wav", "explode");
  RM.loadMusic("sounds/start-music.wav", "start music");
}

void populateWorld(void) {
  for (int i = 0; i < 16; i++) new Star;
  new GameStart;
}

int main(int argc, char* argv[]) {
  (void)argc;
  (void)argv;
  if (GM.startUp()) {
    LM.writeLog("Error starting game manager!");
    GM.shutDown();
    return 1;
  }
  LM.setFlush(true);
  df::splash();
  loadResources();
  populateWorld();
  new df::Pause(df::Keyboard::F10);
  GM.run();
  GM.shutDown();
  return 0;
}

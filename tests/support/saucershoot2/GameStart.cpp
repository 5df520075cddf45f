#include "GameStart.h"

#include "EventKeyboard.h"
#include "GameManager.h"
#include "Hero.h"
#include "Points.h"
#include "ResourceManager.h"
#include "Saucer.h"
#include "WorldManager.h"

GameStart::GameStart() {
  setType("GameStart");
  setSprite("gamestart");
  setLocation(df::CENTER_CENTER);
  registerInterest(df::KEYBOARD_EVENT);
  p_music = RM.getMusic("start music");
  playMusic();
}

void GameStart::playMusic() {
  if (p_music != NULL) p_music->play();
}

int GameStart::eventHandler(const df::Event* p_e) {
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

void GameStart::start() {
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

// Draws the sprite, not a ViewObject's " text value ".
int GameStart::draw() {
  return df::Object::draw();
}

#include "Hero.h"

#include "Bullet.h"
#include "DisplayManager.h"
#include "EventNuke.h"
#include "EventStep.h"
#include "EventView.h"
#include "Explosion.h"
#include "GameManager.h"
#include "GameOver.h"
#include "LogManager.h"
#include "ResourceManager.h"
#include "WorldManager.h"

Hero::Hero() {
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

Hero::~Hero() {
  new Explosion(getPosition());
  DM.shake(20, 20, 5);
  WM.markForDelete(p_reticle);
  new GameOver;
}

int Hero::eventHandler(const df::Event* p_e) {
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

void Hero::kbd(const df::EventKeyboard* p_keyboard_event) {
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

void Hero::mouse(const df::EventMouse* p_mouse_event) {
  if (p_mouse_event->getMouseAction() == df::CLICKED && p_mouse_event->getMouseButton() == df::Mouse::LEFT)
    fire(p_mouse_event->getMousePosition());
}

void Hero::step() {
  move_countdown--;
  if (move_countdown < 0) move_countdown = 0;
  fire_countdown--;
  if (fire_countdown < 0) fire_countdown = 0;
}

void Hero::move(int dy) {
  if (move_countdown > 0) return;
  move_countdown = move_slowdown;
  df::Vector new_pos(getPosition().getX(), getPosition().getY() + dy);
  if (new_pos.getY() > 3 && new_pos.getY() < WM.getBoundary().getVertical() - 1) WM.moveObject(this, new_pos);
}

void Hero::fire(df::Vector target) {
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

void Hero::nuke() {
  if (!nuke_count) return;
  nuke_count--;
  EventNuke nuke;
  WM.onEvent(&nuke);
  df::EventView ev("Nukes", -1, true);
  WM.onEvent(&ev);
}

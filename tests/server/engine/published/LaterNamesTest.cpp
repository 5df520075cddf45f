// Names of the published engine's versions 4.20 to 4.25, used as games of that time used them, in C++17. The
// test is that this file compiles; EarlyNamesRunTest.cpp runs it.

#include "Config.h"
#include "DisplayManager.h"
#include "LogManager.h"
#include "NetworkManager.h"
#include "NetworkNode.h"
#include "Object.h"
#include "ResourceManager.h"
#include "TextEntry.h"
#include "ViewObject.h"
#include "WorldManager.h"

class Kite : public df::Object {
 public:
  mutable int calls = 0;
  void setVelocity(df::Vector velocity) override {
    ++calls;
    Object::setVelocity(velocity);
  }
  void setDirection(df::Vector direction) override {
    ++calls;
    Object::setDirection(direction);
  }
  void setAcceleration(df::Vector acceleration) override {
    ++calls;
    Object::setAcceleration(acceleration);
  }
  void setBox(df::Box box) override {
    ++calls;
    Object::setBox(box);
  }
  void setAnimation(df::Animation animation, bool set_box = true) override {
    ++calls;
    Object::setAnimation(animation, set_box);
  }
  int setSprite(std::string label) override {
    ++calls;
    return Object::setSprite(label);
  }
  bool isVisible() const override {
    ++calls;
    return Object::isVisible();
  }
};

class Node : public df::NetworkNode {
 public:
  int accepted = 0;
  int handleAccept(const df::EventNetwork*) override { return ++accepted; }
};

int laterNames() {
  Kite kite;
  df::Object& o = kite;
  o.setVelocity(df::Vector(1, 0));
  o.setDirection(df::Vector(0, 1));
  o.setAcceleration(df::Vector(0, 0));
  o.setBox(df::Box(df::Vector(), 1, 1));
  o.setAnimation(df::Animation());
  if (o.setSprite("no such") == 0 || !o.isVisible() || kite.calls != 7) return 1;
  df::Animation animation;
  animation.setTransform(df::Animation::HORIZONTAL);
  if (animation.getTransform() != df::Transform::HORIZONTAL) return 2;
  animation.setTransform(df::Transform::BOTH);
  if (animation.getTransform() == df::Transform::VERTICAL) return 3;
  for (const df::Transform plain : {df::HORIZONTAL, df::VERTICAL, df::BOTH, df::NONE})
    animation.setTransform(plain);
  if (animation.getTransform() != df::Transform::NO_TRANSFORM) return 9;
  LM.flush();
  df::Config& config = df::Config::getInstance();
  config.setSignals(!config.getSignals());
  if (config.getWindowState() != 0 || config.getWindowStyle() != df::WINDOW_STYLE_DEFAULT) return 4;
  if (NM.sendDelayed() != 0 || NM.sendNow("ping", 4) != -1) return 5;
  unsigned mask = (unsigned int)df::ObjectAttribute::ID | (unsigned int)df::ViewObjectAttribute::VALUE;
  if (!o.isModified((df::ObjectAttribute)mask)) return 6;
  if (df::TextEntryAttribute::CURSOR == df::TextEntryAttribute::TEXT) return 7;
  Node node;
  return node.sendMessage(df::MessageType::SYNC_OBJECT, &o, -1) == -1 ? 0 : 8;
}

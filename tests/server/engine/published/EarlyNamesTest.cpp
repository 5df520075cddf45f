// Names of the published engine's versions 4.1 to 4.14, used as games of that time used them, in C++11. The
// test is that this file compiles; EarlyNamesRunTest.cpp runs it.

#include "DisplayManager.h"
#include "EventCustomNetwork.h"
#include "EventMouseNetwork.h"
#include "GameManager.h"
#include "LogManager.h"
#include "NetworkManager.h"
#include "NetworkNode.h"
#include "ObjectList.h"
#include "PathManager.h"
#include "Position.h"
#include "QuadtreeNode.h"
#include "ResourceManager.h"
#include "Splash.h"
#include "SplashDragonfly.h"
#include "WorldManager.h"

// Early setters returned nothing, and games hid them instead of overriding them.
class Crate : public df::Object {
 public:
  int times_moved = 0;
  void setVelocity(df::Vector velocity) {
    ++times_moved;
    Object::setVelocity(velocity);
  }
  void setBox(df::Box box) { Object::setBox(box); }
};

class Post : public df::NetworkNode {
 public:
  bool touched = false;
  int send(df::Object* p_o, df::MessageType type) {
    if (type == df::SYNC_OBJECT) return sendMessage(df::SYNC_OBJECT, p_o, "ALL");
    if (type == df::MessageType::DELETE_OBJECT) return sendMessage(df::DELETE_OBJECT, p_o);
    return sendMessage(df::CUSTOM_MESSAGE, 4, "ping") +
           sendMessage(df::MOUSE_INPUT, df::CLICKED, df::Mouse::LEFT, df::Vector());
  }
  int eventHandler(const df::Event* p_e) {
    if (p_e->getType() == df::NETWORK_CUSTOM_EVENT)
      touched = dynamic_cast<const df::EventCustomNetwork*>(p_e)->getLabel() == df::Network::DATA;
    return NetworkNode::eventHandler(p_e);
  }
};

int earlyCollisions(df::Object* p_o, df::Vector where) {
  df::ObjectList list = WM.isCollision(p_o, where);
  list = WM.isCollision(p_o, where);
  df::ObjectListIterator li(&list);
  int count = 0;
  for (li.first(); !li.isDone(); li.next()) count += li.currentObject() != NULL ? 1 : 0;
  bool any = WM.isCollision(p_o, where);
  if (WM.isCollision(p_o, where) != any || !WM.isCollision(p_o, where).isEmpty() != any) return -1;
  if (WM.isCollision(p_o, where) == true && count == 0) return -1;
  return count;
}

std::string earlySprites(df::Object* p_o) {
  p_o->setCentered(false);
  if (p_o->isCentered()) return "centred";
  p_o->setCentered();
  if (!p_o->isCentered()) return "not centred";
  return p_o->getSpriteName();
}

bool earlyText(df::Object* p_o) {
  bool all = true;
  const std::string whole = p_o->serialize(all);
  const std::string rest = p_o->serialize(false);
  const std::string place = p_o->serialize("pos");
  return whole.find("id:") == 0 && rest.empty() && place.find("pos-x:") == 0 &&
         place.find("id:") == std::string::npos;
}

bool earlyVelocity(df::Object* p_o) {
  df::Position place(1, 2);
  p_o->setPosition(place);
  place = p_o->getPosition();
  p_o->setXVelocity(0.5f);
  p_o->setYVelocity(-1);
  if (!p_o->isModified(df::POS) || !p_o->isModified(df::VELOCITY)) return false;
  return place.getX() == 1 && p_o->getVelocity() == df::Vector(0.5f, -1) && p_o->getXVelocity() == 0.5f &&
         p_o->getYVelocity() == -1;
}

int earlyDraw(df::Vector where, bool centered) {
  const df::Frame frame(3, 2, "abc#ef");
  return DM.drawFrame(where, frame, centered, df::RED, '#');
}

int earlyNames() {
  Crate crate;
  crate.setVelocity(df::Vector(1, 0));
  df::Object* p_o = &crate;
  p_o->setVelocity(df::Vector(2, 0));
  if (crate.times_moved != 2) return 1;  // called by the base class: virtual as from 4.20 on
  if (!p_o->isModified(df::ID) || !p_o->isModified(df::ObjectAttribute::POSITION) ||
      !p_o->isModified(df::SPRITE))
    return 2;
  const df::ViewObjectAttribute shown = df::VIEW_STRING;
  if (shown == df::ViewObjectAttribute::VALUE) return 3;
  float most = FLT_MAX;
  if (df::MAX_SPRITES + df::MAX_SOUNDS + df::MAX_EVENTS + df::MAX_OBJ_EVENTS > most) return 4;
  new df::Splash;
  new df::SplashDragonfly(df::Vector(3, 4));
  PM.setMinCycleTime(2);
  PM.cycle();
  if (PM.startUp() != 0 || PM.getMinCycleTime() != 2) return 5;
  df::QuadtreeNode node(NULL, 0, df::Box(df::Vector(), 80, 24));
  if (node.insertObject(p_o) != 0 || node.getObjects().getCount() != 1 || node.findOwner(p_o) != &node)
    return 6;
  df::EventCustomNetwork custom(df::Network::DATA);
  Post post;
  post.eventHandler(&custom);
  if (!post.touched) return 7;
  switch (df::MessageType type = df::KEYBOARD_INPUT) {
    case df::SYNC_OBJECT:
    case df::MessageType::CUSTOM_MESSAGE:
      return 8;
    default:
      return post.send(p_o, type) < 0 ? 0 : 9;  // not connected to a server yet
  }
}

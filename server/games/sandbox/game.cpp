// The sandbox: crates, balls, a rope bridge, a cradle, a billiard corner, ragdolls, blobs and a flag, to be
// dragged, thrown, stacked and shot at by everybody who comes. Start reading at Hand, then Things.
#include <algorithm>

#include "EventPlayer.h"
#include "EventStep.h"
#include "GameManager.h"
#include "Hand.h"
#include "Ragdoll.h"
#include "Seconds.h"
#include "Things.h"
#include "WorldManager.h"

namespace {

/// Gives everybody a hand, and turns gravity by a quarter when more than half of them want it.
class Master : public df::Object {
 public:
  Master() {
    setSolidness(df::SPECTRAL);
    setVisible(false);
    registerInterest(df::JOIN_EVENT);
    registerInterest(df::STEP_EVENT);
    PM.setGravity(m_gravity);
  }
  int eventHandler(const df::Event* p_e) override {
    if (const auto* p_join = dynamic_cast<const df::EventJoin*>(p_e))
      new Hand(*WM.getPlayer(p_join->getPlayer()));
    if (p_e->getType() == df::STEP_EVENT) count();
    return 1;
  }

 private:
  void count() {
    std::vector<Hand*> wishes;
    const df::ObjectList hands = WM.objectsOfType("Hand");
    df::ObjectListIterator li(&hands);
    for (li.first(); !li.isDone(); li.next()) {
      auto* p_hand = static_cast<Hand*>(li.currentObject());
      if (p_hand->wantsTurn()) wishes.push_back(p_hand);
    }
    if (2 * static_cast<int>(wishes.size()) <= hands.getCount()) return;
    for (Hand* p_hand : wishes) p_hand->forgetTurn();
    // A cell is twice as high as wide, and so is what gravity does in cells.
    m_gravity = df::Vector(-2 * m_gravity.y(), m_gravity.x() / 2);
    PM.setGravity(m_gravity);
  }

  df::Vector m_gravity = df::perSecondSquared(df::Vector(0, 15));
};

}  // namespace

int main() {
  if (GM.startUp()) return 1;
  GM.setHelp({
      "The sandbox: everything here can be dragged, thrown and shot at.",
      "",
      "left button    drag, and let go to throw",
      "right button   shoot at where you point",
      "C, B, R, X     a crate, a ball, a ragdoll, a blob where you point",
      "G              vote: gravity turns when more than half want it",
  });
  WM.setLookingBack();  // hands grab what they saw
  makeWall(df::Vector(0, 23), 80, 1);
  makeWall(df::Vector(0, 1), 1, 22);
  makeWall(df::Vector(79, 1), 1, 22);
  makeWall(df::Vector(0, 17), 8, 6);
  makeWall(df::Vector(32, 17), 4, 6);
  makeBridge(df::Vector(7.5, 17), df::Vector(31.5, 17), 8);
  makePyramid(df::Vector(42, 22.5), 4);
  makeCradle(df::Vector(20, 4), 5);
  makeBilliard(df::Vector(50, 2), 27, 9);
  new Ball(df::Vector(4, 14), df::GREEN);
  df::makeRagdoll(df::Vector(70, 15));
  makeBlob(df::Vector(13, 14), df::CYAN);
  makeBlob(df::Vector(25, 13), df::MAGENTA);
  makeFlag(df::Vector(2, 3), 7, 3);
  new Master;
  GM.run();
  GM.shutDown();
  return 0;
}

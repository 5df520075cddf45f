// The sandbox: crates, balls, a rope bridge, a cradle, a billiard corner, ragdolls, blobs and a flag. All
// players can drag, throw, stack and shoot them. Start reading at Hand, then main().
#include "Bridge.h"
#include "GameManager.h"
#include "Hand.h"
#include "Obstacle.h"
#include "PhysicsManager.h"
#include "Ragdoll.h"
#include "Seconds.h"
#include "SoftObject.h"
#include "Things.h"

namespace {

/// Rotates gravity by a quarter turn when more than half of the players have voted for it.
class Votes : public df::Object {
 public:
  Votes() {
    setSolidness(df::SPECTRAL);
    setVisible(false);
    registerInterest(df::STEP_EVENT);
    PM.setGravity(df::perSecondSquared(df::Vector(0, 15)));
  }
  int eventHandler(const df::Event* p_e) override {
    if (p_e->getType() != df::STEP_EVENT) return 0;
    const df::ObjectList hands = WM.objectsOfType("Hand");
    int wishes = 0;
    for (int i = 0; i < hands.getCount(); ++i) wishes += static_cast<Hand*>(hands[i])->wantsTurn() ? 1 : 0;
    if (2 * wishes <= hands.getCount()) return 1;
    for (int i = 0; i < hands.getCount(); ++i) static_cast<Hand*>(hands[i])->forgetTurn();
    // A cell is twice as high as wide, so the components of gravity in cells change when it rotates.
    const df::Vector gravity = PM.getGravity();
    PM.setGravity(df::Vector(-2 * gravity.y(), gravity.x() / 2));
    return 1;
  }
};

void makeWall(df::Vector corner, int width, int height) {
  new df::Obstacle(corner, width, height, '%', df::BLUE);
}

void makePyramid(df::Vector foot, int rows) {
  for (int row = 0; row < rows; ++row)
    for (int i = 0; i < rows - row; ++i)
      new Crate(foot + df::Vector(4.2 * i + 2.1 * row, -1 - 2 * row), row % 2 == 0 ? df::YELLOW : df::RED);
}

/// Makes Newton's cradle of this many balls on rods. The first ball starts raised to the side.
void makeCradle(df::Vector where, int balls) {
  constexpr double kRadius = 1.5;
  constexpr double kRod = 5;  // rows
  for (int i = 0; i < balls; ++i) {
    const df::Vector above = where + df::Vector(2 * kRadius * i, 0);
    auto* p_ball =
        new Ball(above + (i == 0 ? df::Vector(-2 * kRod, 0) : df::Vector(0, kRod)), df::MAGENTA, kRadius, 1);
    p_ball->setTurning(false);
    p_ball->setFriction(0);
    p_ball->setDrag(0);
    PM.addDistance(nullptr, p_ball, above, p_ball->getPosition());
  }
}

/// Makes balls without gravity between four rails.
void makeBilliard(df::Vector corner, int width, int height) {
  makeWall(corner, width, 1);
  makeWall(corner + df::Vector(0, height - 1), width, 1);
  makeWall(corner, 1, height);
  makeWall(corner + df::Vector(width - 1, 0), 1, height);
  for (int row = 0; row < 3; ++row) {
    for (int i = 0; i <= row; ++i) {
      const df::Vector at(width / 2.0 + 3 * row, height / 2.0 + (i - row / 2.0) * 1.6);
      auto* p_ball = new Ball(corner + at, df::GREEN, 1.4, 0.95);
      p_ball->setGravityScale(0);
      p_ball->setDrag(0.01);
    }
  }
}

/// Makes a flag that hangs on its left edge.
void makeFlag(df::Vector corner, double width, double height) {
  auto* p_flag = new df::Cloth(corner, width, height, 0.5);
  p_flag->setDrawing(df::BodyDrawing::FILL, ':', df::RED);
  for (int row = 0; row < p_flag->getRows(); ++row) p_flag->pin(p_flag->getNode(0, row));
}

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
  WM.setLagCompensated();  // so that hands grab the thing that their player saw there
  makeWall(df::Vector(0, 23), 80, 1);
  makeWall(df::Vector(0, 1), 1, 22);
  makeWall(df::Vector(79, 1), 1, 22);
  makeWall(df::Vector(0, 17), 8, 6);
  makeWall(df::Vector(32, 17), 4, 6);
  for (df::Body* p_plank : df::makeBridge(df::Vector(7.5, 17), df::Vector(31.5, 17), 8)) {
    makeThing(*p_plank);
    p_plank->setDrawing(df::BodyDrawing::FILL, '#', df::CYAN);
  }
  makePyramid(df::Vector(42, 22.5), 4);
  makeCradle(df::Vector(20, 4), 5);
  makeBilliard(df::Vector(50, 2), 27, 9);
  new Ball(df::Vector(4, 14), df::GREEN);
  df::makeRagdoll(df::Vector(70, 15));
  makeBlob(df::Vector(13, 14), df::CYAN);
  makeBlob(df::Vector(25, 13), df::MAGENTA);
  makeFlag(df::Vector(2, 3), 7, 3);
  new Votes;
  new df::JoinSpawner<Hand>;
  GM.run();
  GM.shutDown();
  return 0;
}

// What lies about in the sandbox. All of it is made of Bodies and joints; the engine does the rest.
#pragma once

#include "Body.h"
#include "PhysicsManager.h"

/// Anything that may be thrown about.
class Thing : public df::Body {
 public:
  explicit Thing(df::Vector where);
};

class Crate : public Thing {
 public:
  Crate(df::Vector where, df::Color color, double width = 4, double height = 2);
};

class Ball : public Thing {
 public:
  Ball(df::Vector where, df::Color color, double radius = 1.6, double restitution = 0.6);
};

// Whole assemblies. Places are in cells.

void makePyramid(df::Vector foot, int rows);
/// Planks from `left` to `right`, hung on both ends.
void makeBridge(df::Vector left, df::Vector right, int planks);
/// Newton's: as many balls on rods; the first is let go from the side.
void makeCradle(df::Vector where, int balls);
/// Balls that feel no gravity, within rails.
void makeBilliard(df::Vector corner, double width, double height);
void makeBlob(df::Vector where, df::Color color);
/// Hung up by its left edge.
void makeFlag(df::Vector corner, double width, double height);
/// A wall that nothing moves.
void makeWall(df::Vector corner, double width, double height);

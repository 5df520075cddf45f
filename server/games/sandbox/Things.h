// What lies about in the sandbox and may be made by hand. All of it is made of Bodies; the engine does the
// rest.
#pragma once

#include "Body.h"

/// Makes a Body one of the things that are counted and thrown about.
void makeThing(df::Body& body);

class Crate : public df::Body {
 public:
  Crate(df::Vector where, df::Color color);
};

class Ball : public df::Body {
 public:
  Ball(df::Vector where, df::Color color, double radius = 1.6, double restitution = 0.6);
};

void makeBlob(df::Vector where, df::Color color);

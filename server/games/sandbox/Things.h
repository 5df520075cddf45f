// The loose things in the sandbox, which players may also make. They are Bodies; the engine does the rest.
#pragma once

#include "Body.h"

/// Sets up a Body as one of the things that players may throw and whose number is limited.
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

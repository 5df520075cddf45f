#include "Things.h"

#include "SoftObject.h"

void makeThing(df::Body& body) {
  body.setType("Thing");
  body.setTurning();
  body.setFriction(0.6);
  body.setDrag(0.001);
}

Crate::Crate(df::Vector where, df::Color color) {
  makeThing(*this);
  setPosition(where);
  setBoxShape(4, 2);
  setDrawing(df::BodyDrawing::FILL, '#', color);
}

Ball::Ball(df::Vector where, df::Color color, double radius, double restitution) {
  makeThing(*this);
  setPosition(where);
  setCircle(radius);
  setMass(radius * radius / 2.5);
  setRestitution(restitution);
  setDrawing(df::BodyDrawing::FILL, 'o', color);
}

void makeBlob(df::Vector where, df::Color color) {
  auto* p_blob = new df::Blob(where, 2.5);
  p_blob->setDrawing(df::BodyDrawing::FILL, 'o', color);
}

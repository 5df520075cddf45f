// Listing 4.26 and following ones of the Dragonfly book.
#pragma once

namespace textbook {

class Vector {
 private:
  float m_x;  // Horizontal component.
  float m_y;  // Vertical component.

 public:
  Vector();
  Vector(float init_x, float init_y);

  float getX() const;
  float getY() const;

  // Return magnitude of vector.
  float getMagnitude() const;
  // Resize vector to have magnitude of 1.
  void normalize();
  // Scale vector.
  void scale(float s);

  Vector operator+(const Vector& other) const;
  Vector operator-(const Vector& other) const;
  bool operator!=(const Vector& other) const;
};

}  // namespace textbook

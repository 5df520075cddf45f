// Stands in for the shapes, texts and pictures of the graphics library SFML, which some games draw directly.
// They accept the usual calls and show nothing. See Sfml.h.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "detail/SfmlValues.h"

namespace sf {

class Drawable {};

enum PrimitiveType { Points, Lines, LineStrip, Triangles, TriangleStrip, TriangleFan, Quads };

struct Vertex {
  Vector2f position;
  Color color = Color::White;

  Vertex() = default;
  Vertex(const Vector2f& new_position, const Color& new_color = Color::White)
      : position(new_position), color(new_color) {}
};

class VertexArray : public Drawable {
 public:
  explicit VertexArray(PrimitiveType /*type*/ = Points, std::size_t count = 0) : m_vertices(count) {}
  Vertex& operator[](std::size_t index) { return m_vertices[index]; }
  std::size_t getVertexCount() const { return m_vertices.size(); }
  void resize(std::size_t count) { m_vertices.resize(count); }
  void append(const Vertex& vertex) { m_vertices.push_back(vertex); }
  void clear() { m_vertices.clear(); }
  void setPrimitiveType(PrimitiveType /*type*/) {}

 private:
  std::vector<Vertex> m_vertices;
};

/// Base of drawn things that have a position.
class Transformable {
 public:
  void setPosition(float x, float y) { m_position = {x, y}; }
  void setPosition(const Vector2f& position) { m_position = position; }
  const Vector2f& getPosition() const { return m_position; }
  void move(float x, float y) { m_position += {x, y}; }
  void move(const Vector2f& offset) { m_position += offset; }
  template <class... T>
  void setOrigin(const T&... /*origin*/) {}
  template <class... T>
  void setScale(const T&... /*factors*/) {}
  template <class... T>
  void scale(const T&... /*factors*/) {}
  template <class T>
  void setRotation(const T& /*angle*/) {}
  template <class T>
  void rotate(const T& /*angle*/) {}

 private:
  Vector2f m_position;
};

class Texture {
 public:
  template <class... T>
  bool loadFromFile(const T&... /*file*/) {
    return true;
  }
  void setSmooth(bool /*smooth*/) {}
  void setRepeated(bool /*repeated*/) {}
  Vector2u getSize() const { return {}; }
};

class Image {
 public:
  template <class... T>
  bool loadFromFile(const T&... /*file*/) {
    return true;
  }
  Vector2u getSize() const { return {}; }
  const std::uint8_t* getPixelsPtr() const { return nullptr; }
};

class Font {
 public:
  template <class... T>
  bool loadFromFile(const T&... /*file*/) {
    return true;
  }
};

/// A Drawable with a fill colour and an outline.
class Shape : public Drawable, public Transformable {
 public:
  void setFillColor(const Color& color) { m_fill = color; }
  const Color& getFillColor() const { return m_fill; }
  void setOutlineColor(const Color& /*color*/) {}
  void setOutlineThickness(float /*thickness*/) {}
  void setTexture(const Texture* /*p_texture*/, bool /*reset*/ = false) {}
  FloatRect getGlobalBounds() const { return {}; }
  FloatRect getLocalBounds() const { return {}; }

 private:
  Color m_fill = Color::White;
};

class CircleShape : public Shape {
 public:
  explicit CircleShape(float radius = 0, std::size_t /*points*/ = 30) : m_radius(radius) {}
  void setRadius(float radius) { m_radius = radius; }
  float getRadius() const { return m_radius; }
  void setPointCount(std::size_t /*count*/) {}

 private:
  float m_radius;
};

class RectangleShape : public Shape {
 public:
  explicit RectangleShape(const Vector2f& size = {}) : m_size(size) {}
  void setSize(const Vector2f& size) { m_size = size; }
  const Vector2f& getSize() const { return m_size; }

 private:
  Vector2f m_size;
};

class ConvexShape : public Shape {
 public:
  explicit ConvexShape(std::size_t /*points*/ = 0) {}
  void setPointCount(std::size_t /*count*/) {}
  void setPoint(std::size_t /*index*/, const Vector2f& /*point*/) {}
};

class Sprite : public Shape {
 public:
  Sprite() = default;
  template <class... T>
  explicit Sprite(const Texture& /*texture*/, const T&... /*part*/) {}
  void setTexture(const Texture& /*texture*/, bool /*reset*/ = false) {}
  void setTextureRect(const IntRect& /*part*/) {}
  void setColor(const Color& color) { setFillColor(color); }
};

class Text : public Shape {
 public:
  enum Style { Regular = 0, Bold = 1, Italic = 2, Underlined = 4 };

  Text() = default;
  Text(std::string text, const Font& /*font*/, unsigned /*size*/ = 30) : m_string(std::move(text)) {}
  void setString(std::string text) { m_string = std::move(text); }
  const std::string& getString() const { return m_string; }
  void setFont(const Font& /*font*/) {}
  void setCharacterSize(unsigned /*size*/) {}
  void setStyle(unsigned /*style*/) {}
  void setColor(const Color& color) { setFillColor(color); }

 private:
  std::string m_string;
};

}  // namespace sf

// Values of the graphics library SFML that games of the published engine use without including it. They work
// as in SFML. See Sfml.h.
#pragma once

#include <cstdint>

#include "detail/LanguageStandard.h"

namespace sf {

template <class T>
struct Vector2 {
  T x{};
  T y{};

  constexpr Vector2() = default;
  constexpr Vector2(T new_x, T new_y) : x(new_x), y(new_y) {}
  template <class U>
  constexpr explicit Vector2(const Vector2<U>& other)
      : x(static_cast<T>(other.x)), y(static_cast<T>(other.y)) {}

  Vector2& operator+=(const Vector2& other) { return *this = *this + other; }
  Vector2& operator-=(const Vector2& other) { return *this = *this - other; }
  Vector2& operator*=(T factor) { return *this = *this * factor; }
  friend constexpr Vector2 operator+(const Vector2& a, const Vector2& b) {
    return {T(a.x + b.x), T(a.y + b.y)};
  }
  friend constexpr Vector2 operator-(const Vector2& a, const Vector2& b) {
    return {T(a.x - b.x), T(a.y - b.y)};
  }
  friend constexpr Vector2 operator-(const Vector2& a) { return {T(-a.x), T(-a.y)}; }
  friend constexpr Vector2 operator*(const Vector2& a, T factor) {
    return {T(a.x * factor), T(a.y * factor)};
  }
  friend constexpr Vector2 operator*(T factor, const Vector2& a) { return a * factor; }
  friend constexpr Vector2 operator/(const Vector2& a, T divisor) {
    return {T(a.x / divisor), T(a.y / divisor)};
  }
  friend constexpr bool operator==(const Vector2& a, const Vector2& b) { return a.x == b.x && a.y == b.y; }
  friend constexpr bool operator!=(const Vector2& a, const Vector2& b) { return !(a == b); }
};

using Vector2f = Vector2<float>;
using Vector2i = Vector2<int>;
using Vector2u = Vector2<unsigned>;

template <class T>
struct Rect {
  T left{};
  T top{};
  T width{};
  T height{};

  constexpr Rect() = default;
  constexpr Rect(T new_left, T new_top, T new_width, T new_height)
      : left(new_left), top(new_top), width(new_width), height(new_height) {}
  constexpr Rect(Vector2<T> position, Vector2<T> size)
      : left(position.x), top(position.y), width(size.x), height(size.y) {}

  bool contains(Vector2<T> point) const { return contains(point.x, point.y); }
  bool contains(T x, T y) const { return x >= left && x < left + width && y >= top && y < top + height; }
};

using FloatRect = Rect<float>;
using IntRect = Rect<int>;

struct Color {
  std::uint8_t r = 0;
  std::uint8_t g = 0;
  std::uint8_t b = 0;
  std::uint8_t a = 255;

  constexpr Color() = default;
  constexpr Color(std::uint8_t red, std::uint8_t green, std::uint8_t blue, std::uint8_t alpha = 255)
      : r(red), g(green), b(blue), a(alpha) {}
  friend constexpr bool operator==(Color x, Color y) {
    return x.r == y.r && x.g == y.g && x.b == y.b && x.a == y.a;
  }
  friend constexpr bool operator!=(Color x, Color y) { return !(x == y); }

  static const Color Black, White, Red, Green, Blue, Yellow, Magenta, Cyan, Transparent;
};

inline constexpr Color Color::Black{0, 0, 0};
inline constexpr Color Color::White{255, 255, 255};
inline constexpr Color Color::Red{255, 0, 0};
inline constexpr Color Color::Green{0, 255, 0};
inline constexpr Color Color::Blue{0, 0, 255};
inline constexpr Color Color::Yellow{255, 255, 0};
inline constexpr Color Color::Magenta{255, 0, 255};
inline constexpr Color Color::Cyan{0, 255, 255};
inline constexpr Color Color::Transparent{0, 0, 0, 0};

/// A span of game time (df::Clock).
class Time {
 public:
  constexpr Time() = default;
  constexpr explicit Time(long microseconds) : m_microseconds(microseconds) {}
  constexpr float asSeconds() const { return static_cast<float>(m_microseconds) / 1e6f; }
  constexpr std::int32_t asMilliseconds() const { return static_cast<std::int32_t>(m_microseconds / 1000); }
  constexpr std::int64_t asMicroseconds() const { return m_microseconds; }
  friend constexpr bool operator<(Time a, Time b) { return a.m_microseconds < b.m_microseconds; }
  friend constexpr bool operator>(Time a, Time b) { return b < a; }
  friend constexpr Time operator+(Time a, Time b) { return Time(a.m_microseconds + b.m_microseconds); }
  friend constexpr Time operator-(Time a, Time b) { return Time(a.m_microseconds - b.m_microseconds); }

 private:
  long m_microseconds = 0;
};

constexpr Time seconds(float amount) {
  return Time(static_cast<long>(amount * 1e6f));
}
constexpr Time milliseconds(std::int32_t amount) {
  return Time(long{amount} * 1000);
}
constexpr Time microseconds(std::int64_t amount) {
  return Time(static_cast<long>(amount));
}
/// Returns at once, because a game that sleeps would keep its players waiting.
inline void sleep(Time /*duration*/) {}

/// Measures game time, like df::Clock.
class Clock {
 public:
  Clock();
  Time getElapsedTime() const;
  Time restart();

 private:
  long m_start;
};

}  // namespace sf

#include "physics/body/BodyFrames.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "physics/geometry/Index.h"
#include "physics/geometry/ShapeRaster.h"
#include "shared/replica/Limits.h"
#include "shared/replica/LookCodec.h"

namespace naiad::physics {

namespace {

/// Maximum distance of a drawing's cells from its middle, in rows or columns.
constexpr std::int32_t kFarthest = 96;
/// Offset of the tested points from the middles of cells, right and down, so that none lies on an edge.
constexpr double kHair = 1.0 / 1024;
/// A shape that is thinner than this, in cells, may miss the middles of cells, so it is drawn as a line.
constexpr double kThin = 1.1;
constexpr double kTurn = 6.283185307179586;
/// Maximum weight of all frames of a turn. Heavier sequences do not get an id in snapshots (AppearanceIds).
constexpr std::size_t kMaxWeight = 4096;

/// A cell of a drawing. Cells are ordered by rows, in the order in which they are written.
struct Cell {
  std::int32_t row;
  std::int32_t column;
  friend bool operator==(const Cell&, const Cell&) = default;
  friend bool operator<(const Cell& a, const Cell& b) {
    return a.row != b.row ? a.row < b.row : a.column < b.column;
  }
};
using Picture = std::map<Cell, char32_t>;

std::int32_t rounded(double x) {
  return static_cast<std::int32_t>(std::clamp(std::floor(x + 0.5), -1e6, 1e6));
}

class Drawing {
 public:
  Drawing(std::span<const ConvexShape> shapes, Rotation rotation, double aspect, const FrameStyle& style)
      : m_aspect(aspect), m_style(style), m_rotation(rotation), m_shapes(shapes.size()) {
    align(shapes);
    for (std::size_t i = 0; i < shapes.size(); ++i) turn(shapes[i], rotation, m_shapes[i]);
  }

  Appearance draw() {
    if (m_style.how == df::BodyDrawing::SPRITE) {
      sprite();
    } else if (m_style.how != df::BodyDrawing::NONE) {
      cover();
      m_style.how == df::BodyDrawing::FILL ? fill() : outline();
    }
    Appearance glyphs;
    constexpr std::int32_t kUnit = 1 << kGlyphUnitBits;
    for (const auto& [cell, ch] : m_picture)
      glyphs.push_back({rounded((cell.column + m_half.x) * kUnit), rounded((cell.row + m_half.y) * kUnit), ch,
                        m_style.color});
    return glyphs;
  }

 private:
  // Moves the cells by half a cell if the body is an even number of cells wide or high, so that its left and
  // upper edge are borders of cells when it is not rotated, and it gets its true size.
  void align(std::span<const ConvexShape> shapes) {
    Vec2 lower = {-0.5, -0.5 * m_aspect};
    if (m_style.how == df::BodyDrawing::SPRITE) {
      std::size_t longest = 0;
      for (const std::u32string& row : m_style.rows) longest = std::max(longest, row.size());
      lower = {-0.5 * static_cast<double>(longest),
               -0.5 * static_cast<double>(m_style.rows.size()) * m_aspect};
    }
    for (const ConvexShape& shape : shapes) {
      if (m_style.how == df::BodyDrawing::SPRITE) break;
      for (std::int32_t i = 0; i < shape.count; ++i) {
        lower = {std::min(lower.x, shape.vertices[at(i)].x - shape.radius),
                 std::min(lower.y, shape.vertices[at(i)].y - shape.radius)};
      }
    }
    const auto half = [](double edge) {
      const double off = std::abs(edge - std::floor(edge + 0.5));  // distance from the nearest whole number
      return off < 0.25 ? 0.5 : 0.0;
    };
    m_half = {half(lower.x), half(lower.y / m_aspect)};
  }

  Vec2 middleOf(Cell cell) const {
    return {cell.column + m_half.x + kHair, (cell.row + m_half.y + kHair) * m_aspect};
  }
  /// Returns the body's place relative to the tested point of cell (0, 0).
  Vec2 place() const { return {-m_half.x - kHair, -(m_half.y + kHair) * m_aspect}; }
  bool covers(Cell cell) const { return m_covered.contains(cell); }

  void cover() {
    std::vector<CellSpan> spans;
    for (const RotatedShape& shape : m_shapes) {
      rasterise(shape, place(), m_aspect, spans, kFarthest);
      for (const CellSpan& span : spans) {
        for (std::int32_t column = span.first; column <= span.last; ++column)
          m_covered[{span.row, column}] = U'#';
      }
    }
  }

  void fill() {
    m_picture = m_covered;
    for (const RotatedShape& shape : m_shapes) coreLine(shape, true);
    if (m_picture.empty()) m_picture[{0, 0}] = U'#';
    for (auto& [cell, ch] : m_picture) ch = m_style.ch != 0 ? m_style.ch : U'#';
  }

  void outline() {
    for (const auto& [cell, unused] : m_covered) {
      const bool inner = covers({cell.row - 1, cell.column}) && covers({cell.row + 1, cell.column}) &&
                         covers({cell.row, cell.column - 1}) && covers({cell.row, cell.column + 1});
      if (!inner) m_picture[cell] = edgeAt(cell);
    }
    for (const RotatedShape& shape : m_shapes) coreLine(shape, false);
    if (m_style.spoke) {
      for (const RotatedShape& shape : m_shapes) {
        if (shape.count == 1 && m_covered.size() > 4) spoke(shape);
      }
    }
    if (m_picture.size() <= 1) {
      m_picture.clear();
      m_picture[{0, 0}] = m_shapes.size() == 1 && m_shapes[0].count > 1 ? U'#' : U'o';
    }
    if (m_style.ch == 0) return;
    for (auto& [cell, ch] : m_picture) ch = m_style.ch;
  }

  struct Nearest {
    double distance = 1e300;
    Vec2 along;  ///< direction of the edge at the nearest point
  };

  // Converts a distance in metric cells along this direction to character cells.
  double inCells(double distance, Vec2 direction) const {
    const double size = length(direction);
    return size > 0 ? distance *
                          std::sqrt(direction.x * direction.x +
                                    direction.y * direction.y / (m_aspect * m_aspect)) /
                          size
                    : 0;
  }

  // Returns the distance in cells from the point to edge `i` of the shape, and the edge's direction there.
  Nearest nearest(const RotatedShape& shape, std::int32_t i, Vec2 p) const {
    const Vec2 a = shape.vertices[at(i)];
    if (shape.count == 1)
      return {inCells(std::abs(length(p - a) - shape.radius), p - a), {a.y - p.y, p.x - a.x}};
    const Vec2 b = shape.vertices[at(following(i, shape.count))];
    const Vec2 along = b - a;
    const double part = std::clamp(dot(p - a, along) / lengthSquared(along), 0.0, 1.0);
    const Vec2 direction = p - (a + part * along);
    const Vec2 across = lengthSquared(direction) > 0 ? direction : Vec2{along.y, -along.x};
    const double distance = inCells(std::abs(length(direction) - shape.radius), across);
    const bool round = shape.radius > 0.5 && (part == 0 || part == 1);
    return {distance, round ? Vec2{-direction.y, direction.x} : along};
  }

  char32_t edgeAt(Cell cell) const {
    Nearest best, second;
    for (const RotatedShape& shape : m_shapes) {
      for (std::int32_t i = 0; i < shape.count; ++i) {
        const Nearest here = nearest(shape, i, middleOf(cell));
        if (here.distance < best.distance) {
          second = std::exchange(best, here);
        } else if (here.distance < second.distance) {
          second = here;
        }
      }
    }
    const char32_t ch = lineAlong(best.along, m_aspect);
    if (second.distance > 1) return ch;
    const char32_t other = lineAlong(second.along, m_aspect);
    const bool corner = (ch == U'-' && other == U'|') || (ch == U'|' && other == U'-');
    return corner && (!covers({cell.row - 1, cell.column}) || !covers({cell.row + 1, cell.column})) &&
                   (!covers({cell.row, cell.column - 1}) || !covers({cell.row, cell.column + 1}))
               ? U'+'
               : ch;
  }

  // Draws a thin shape as a line through its middle, and removes its other cells unless `gaps`.
  void coreLine(const RotatedShape& shape, bool gaps) {
    if (shape.count == 1) return;
    double width = 1e300;
    Vec2 normal;
    for (std::int32_t i = 0; i < shape.count; ++i) {
      const Vec2 out = shape.normals[at(i)];
      double most = 0;
      for (std::int32_t k = 0; k < shape.count; ++k)
        most = std::max(most, dot(out, shape.vertices[at(i)] - shape.vertices[at(k)]));
      if (most < width) {
        width = most;
        normal = out;
      }
    }
    // If cells are higher than wide, a flat shape may miss more of their middles.
    if (width + 2 * shape.radius > kThin * (1 + (m_aspect - 1) * std::abs(normal.y))) return;
    if (!gaps) removeCovered(shape);
    const Vec2 along = {-normal.y, normal.x};
    double from = 1e300, to = -1e300, least = 1e300, most = -1e300;
    for (std::int32_t i = 0; i < shape.count; ++i) {
      const Vec2 v = shape.vertices[at(i)];
      from = std::min(from, dot(along, v));
      to = std::max(to, dot(along, v));
      least = std::min(least, dot(normal, v));
      most = std::max(most, dot(normal, v));
    }
    const double cell = 1 + (m_aspect - 1) * std::abs(along.y);  // length of a cell along the line
    const double half = std::max(0.0, (to - from) / 2 + shape.radius - cell / 2);
    const Vec2 middle = (from + to) / 2 * along + (least + most) / 2 * normal;
    line(middle - half * along, middle + half * along);
  }

  void removeCovered(const RotatedShape& shape) {
    std::vector<CellSpan> spans;
    rasterise(shape, place(), m_aspect, spans, kFarthest);
    for (const CellSpan& span : spans) {
      for (std::int32_t column = span.first; column <= span.last; ++column)
        m_picture.erase({span.row, column});
    }
  }

  void spoke(const RotatedShape& shape) {
    const Vec2 centre = shape.vertices[0];
    const Vec2 out = m_rotation * Vec2{1, 0};
    const double cell = 1 + (m_aspect - 1) * std::abs(out.y);
    const double length = shape.radius - cell;
    if (length > 0) line(centre, centre + length * out);
  }

  void line(Vec2 from, Vec2 to) {
    const Vec2 a = {from.x, from.y / m_aspect}, b = {to.x, to.y / m_aspect};
    const char32_t ch = lineAlong(to - from, m_aspect);
    const std::int32_t steps = std::max(rounded(std::max(std::abs(b.x - a.x), std::abs(b.y - a.y))), 1);
    for (std::int32_t i = 0; i <= std::min(steps, 4 * kFarthest); ++i) {
      const double part = static_cast<double>(i) / steps;
      const Vec2 p = a + part * (b - a);
      const Cell cell = {rounded(p.y - m_half.y - kHair), rounded(p.x - m_half.x - kHair)};
      if (std::max(std::abs(cell.row), std::abs(cell.column)) <= kFarthest) m_picture[cell] = ch;
    }
  }

  void sprite() {
    const auto height = static_cast<std::int32_t>(m_style.rows.size());
    std::size_t longest = 0;
    for (const std::u32string& row : m_style.rows) longest = std::max(longest, row.size());
    const auto width = static_cast<std::int32_t>(longest);
    const double reach = std::sqrt(width * width + height * m_aspect * (height * m_aspect)) / 2 + 1;
    const std::int32_t rows = std::min(rounded(reach / m_aspect) + 1, kFarthest);
    const std::int32_t columns = std::min(rounded(reach) + 1, kFarthest);
    for (std::int32_t row = -rows; row <= rows; ++row) {
      for (std::int32_t column = -columns; column <= columns; ++column) {
        const Vec2 p = inverse(m_rotation) * middleOf({row, column});
        const double x = std::floor(p.x + width / 2.0), y = std::floor(p.y / m_aspect + height / 2.0);
        if (!(x >= 0 && x < width && y >= 0 && y < height)) continue;
        const std::u32string& from = m_style.rows[static_cast<std::size_t>(y)];
        const auto i = static_cast<std::size_t>(x);
        if (i < from.size() && from[i] != U' ') m_picture[{row, column}] = from[i];
      }
    }
  }

  double m_aspect;
  const FrameStyle& m_style;
  Rotation m_rotation;
  Vec2 m_half;  ///< middle of cell (0, 0) relative to the body's place, in cells
  std::vector<RotatedShape> m_shapes;
  Picture m_covered;
  Picture m_picture;
};

bool isSameAfter(const ConvexShape& shape, std::int32_t part) {
  const Rotation step = rotationBy(kTurn / part);
  const std::int32_t skip = shape.count / part;
  for (std::int32_t i = 0; i < shape.count; ++i) {
    const Vec2 off = step * shape.vertices[at(i)] - shape.vertices[at((i + skip) % shape.count)];
    if (length(off) > 1e-9 * (shape.reach + shape.radius)) return false;
  }
  return true;
}

std::vector<Appearance> drawFrames(std::span<const ConvexShape> shapes, double aspect,
                                   const FrameStyle& style, std::uint32_t count, std::uint32_t repeats) {
  std::vector<Appearance> frames;
  for (std::uint32_t i = 0; i < count; ++i) {
    const Rotation rotation = rotationBy(kTurn * i / (static_cast<double>(count) * repeats));
    frames.push_back(drawShapes(shapes, rotation, aspect, style));
  }
  return frames;
}

double reachOf(std::span<const ConvexShape> shapes, double aspect, const FrameStyle& style) {
  double reach = 0;
  for (const ConvexShape& shape : shapes) reach = std::max(reach, shape.reach + shape.radius);
  if (style.how != df::BodyDrawing::SPRITE) return reach;
  double width = 0;
  for (const std::u32string& row : style.rows) width = std::max(width, static_cast<double>(row.size()));
  const double height = static_cast<double>(style.rows.size()) * aspect;
  return std::sqrt(width * width + height * height) / 2;
}

}  // namespace

char32_t lineAlong(Vec2 direction, double aspect) {
  const double x = std::abs(direction.x), y = std::abs(direction.y) / aspect;
  constexpr double kFlat = 0.4142135623730951;  // tan 22.5°
  if (y <= kFlat * x) return U'-';
  if (x <= kFlat * y) return U'|';
  return (direction.x > 0) == (direction.y > 0) ? U'\\' : U'/';
}

Appearance drawShapes(std::span<const ConvexShape> shapes, Rotation rotation, double aspect,
                      const FrameStyle& style) {
  return Drawing(shapes, rotation, aspect, style).draw();
}

std::uint32_t symmetryOf(std::span<const ConvexShape> shapes) {
  if (shapes.size() != 1) return 1;
  const ConvexShape& shape = shapes[0];
  if (shape.count == 1) return shape.reach == 0 ? 0 : 1;
  for (std::int32_t part = shape.count; part > 1; --part) {
    if (shape.count % part == 0 && isSameAfter(shape, part)) return static_cast<std::uint32_t>(part);
  }
  return 1;
}

TurnFrames drawTurn(std::span<const ConvexShape> shapes, double aspect, const FrameStyle& style) {
  TurnFrames turn;
  const bool whole = style.how == df::BodyDrawing::SPRITE || style.spoke;
  const std::uint32_t symmetry = whole ? 1 : symmetryOf(shapes);
  turn.repeats = std::max(symmetry, 1u);
  const double steps = std::ceil(2 * kTurn * reachOf(shapes, aspect, style) / turn.repeats);
  auto count = static_cast<std::uint32_t>(std::clamp(steps, 2.0, static_cast<double>(kMaxFrames)));
  if (symmetry == 0 || style.how == df::BodyDrawing::NONE) count = 1;
  for (;; count = (count + 1) / 2) {
    turn.frames = Sequence(drawFrames(shapes, aspect, style, count, turn.repeats));
    const bool fits = turn.frames.weight() <= kMaxWeight && encodedBits(turn.frames) <= 8 * kMaxLookBytes;
    if (fits || count == 1) return turn;
  }
}

}  // namespace naiad::physics

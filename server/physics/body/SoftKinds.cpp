// Makes the nodes and springs of ropes, beams, cloths and blobs from the game's parameters.
#include <algorithm>
#include <cmath>

#include "physics/body/Metric.h"
#include "physics/body/PhysicsManager.h"
#include "physics/body/SoftObject.h"
#include "physics/geometry/Index.h"
#include "physics/soft/SoftBuild.h"

namespace df {

namespace {

using naiad::physics::at;
using naiad::physics::Metric;
using naiad::physics::Place;
using naiad::physics::Vec2;

constexpr double kMinMaterial = 1e-6, kMaxMaterial = 1e6;  // limits of mass and stiffness
constexpr double kUsualDrag = 0.02;                        // default drag per tick
constexpr double kUsualFriction = 0.5;

naiad::physics::SoftBody withUsual(naiad::physics::SoftBody body) {
  body.drag = kUsualDrag;
  body.friction = kUsualFriction;
  return body;
}

int countFor(double length, double each, int least, int most) {
  return static_cast<int>(
      std::clamp(std::ceil(length / each), static_cast<double>(least), static_cast<double>(most)));
}

struct Line {
  Place from;
  Vec2 displacement;
};

// Returns the line between two points. If they are equal, it is one cell long.
Line lineOf(Vector from, Vector to) {
  constexpr double kLongest = 1e5;  // maximum length in metric cells
  const Metric metric(PM.getAspect());
  Line line = {metric.placeAtCells(from), {}};
  line.displacement = metric.placeAtCells(to) - line.from;
  const double far = length(line.displacement);
  if (!(far > 1e-3)) line.displacement = {1, 0};
  if (far > kLongest) line.displacement = line.displacement * (kLongest / far);
  return line;
}

// Limits the stretch of threads, because the thread at a corner carries half of the cloth, even if there are
// many threads. Diagonals are not limited, so that the cloth drapes.
void tauten(naiad::physics::SoftBody& body, double limit) {
  for (naiad::physics::SoftStretch& s : body.stretches) {
    const Vec2 along = body.nodes[at(s.b)].offset - body.nodes[at(s.a)].offset;
    if (along.x == 0 || along.y == 0) s.limit = limit;
  }
}

}  // namespace

Rope::Rope(Vector from, Vector to, double mass, double stiffness, int links) {
  setType("Rope");
  const Line line = lineOf(checked("Rope: from", from), checked("Rope: to", to));
  mass = checked("Rope: mass", mass, kMinMaterial, kMaxMaterial, 1);
  stiffness = checked("Rope: stiffness", stiffness, kMinMaterial, kMaxMaterial, 20);
  links = static_cast<int>(checked("Rope: links", links, 0, 200, 0));
  if (links == 0) links = countFor(length(line.displacement), 1, 2, 100);
  naiad::physics::SoftBody body =
      naiad::physics::makeRope(line.from, line.displacement, links, mass, stiffness * mass);
  body.radius = std::min(body.radius, 0.25);
  make(withUsual(body));
}

// A cantilever under its own weight m g bends by m g L³ / 8 EI.
Beam::Beam(Vector from, Vector to, double mass, double stiffness, bool is_clamped, int elements) {
  setType("Beam");
  const Line line = lineOf(checked("Beam: from", from), checked("Beam: to", to));
  mass = checked("Beam: mass", mass, kMinMaterial, kMaxMaterial, 1);
  stiffness = checked("Beam: stiffness", stiffness, kMinMaterial, kMaxMaterial, 1);
  if (elements != 0) elements = static_cast<int>(checked("Beam: elements", elements, 2, 100, 0));
  const double whole = length(line.displacement);
  if (elements == 0) elements = countFor(whole, 1.5, 4, 32);
  constexpr double kTensile = 1000;  // factor over stiffness · mass: a beam bends, but hardly stretches
  naiad::physics::SoftBody body =
      naiad::physics::makeBeam(line.from, line.displacement, elements, stiffness * mass * whole * whole / 8,
                               kTensile * stiffness * mass, mass / whole, is_clamped);
  body.radius = std::min(body.radius, 0.25);
  make(withUsual(body));
}

// Divides the stiffness by the smaller number of threads, so that more threads do not make the cloth stiffer.
Cloth::Cloth(Vector corner, double width, double height, double mass, double stiffness, int columns,
             int rows) {
  setType("Cloth");
  const Metric metric(PM.getAspect());
  const Place place = metric.placeAtCells(checked("Cloth: corner", corner));
  width = checked("Cloth: width", width, 0.5, 1000, 10);
  height = checked("Cloth: height", height, 0.5, 1000, 5);
  mass = checked("Cloth: mass", mass, kMinMaterial, kMaxMaterial, 1);
  stiffness = checked("Cloth: stiffness", stiffness, kMinMaterial, kMaxMaterial, 5);
  const Vec2 across = metric.fromCells(Vector(width, 0)), down = metric.fromCells(Vector(0, height));
  constexpr double kMesh = 2.5;     // metric cells: 16 by 4 meshes cost half a millisecond per tick
                                    // (docs/physics/soft.md)
  constexpr int kMaxThreads = 128;  // in each direction: 16,384 nodes in all
  if (columns != 0) columns = static_cast<int>(checked("Cloth: columns", columns, 2, kMaxThreads, 0));
  if (rows != 0) rows = static_cast<int>(checked("Cloth: rows", rows, 2, kMaxThreads, 0));
  m_columns = columns != 0 ? columns : countFor(across.x, kMesh, 2, 24) + 1;
  m_rows = rows != 0 ? rows : countFor(down.y, kMesh, 2, 24) + 1;
  m_is_upright = m_rows > m_columns;  // makeCloth() numbers the nodes along its second side, the short one
  const double thread = stiffness * mass / std::min(m_columns, m_rows);
  const int longer = std::max(m_columns, m_rows) - 1, shorter = std::min(m_columns, m_rows) - 1;
  naiad::physics::SoftBody body =
      naiad::physics::makeCloth(place, m_is_upright ? down : across, m_is_upright ? across : down, longer,
                                shorter, mass, thread, thread / 4, 0);
  body.radius = std::min(body.radius, 0.25);
  if (columns != 0 || rows != 0) tauten(body, std::max(0.03, 0.15 / stiffness));
  make(withUsual(body));
}

int Cloth::getNode(int column, int row) const {
  if (column < 0 || column >= m_columns || row < 0 || row >= m_rows) return -1;
  return m_is_upright ? column + row * m_columns : row + column * m_rows;
}

// The deformation is mostly resisted by the tension of the skin, while the gas keeps its area.
Blob::Blob(Vector where, double radius, double mass, double stiffness) {
  setType("Blob");
  const Metric metric(PM.getAspect());
  const Place place = metric.placeAtCells(checked("Blob: where", where));
  radius = checked("Blob: radius", radius, 0.1, 1000, 2);
  mass = checked("Blob: mass", mass, kMinMaterial, kMaxMaterial, 1);
  stiffness = checked("Blob: stiffness", stiffness, kMinMaterial, kMaxMaterial, 1);
  const double load = stiffness * mass;
  constexpr double kGirth = 6.283185307179586;  // 2π
  constexpr double kBend = 0.02;                // bending stiffness of the skin, in load · radius²
  naiad::physics::SoftBody body =
      naiad::physics::makeBlob(place, radius, countFor(kGirth * radius, 1.5, 10, 32), mass, 0,
                               2 * load / radius, 2 * load, kBend * load * radius * radius);
  make(withUsual(body));
}

}  // namespace df

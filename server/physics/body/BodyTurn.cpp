// Functions of Body for its shape and rotation.
#include <algorithm>
#include <cmath>

#include "engine/world/World.h"
#include "engine/world/WorldStore.h"
#include "physics/body/Body.h"
#include "physics/body/BodyLimits.h"
#include "physics/body/BodyTable.h"
#include "physics/geometry/Mass.h"
#include "physics/geometry/ShapeQuery.h"

namespace df {

namespace {

using naiad::physics::BodyGeometry;
using naiad::physics::Mass;
using naiad::physics::Rotation;
using Part = naiad::physics::ConvexShape;  // df::Shape is the look of Objects without a sprite
using naiad::physics::ShapeStatus;
using naiad::physics::Vec2;

constexpr double kMaxAngle = 1e6;  // rad: up to this, a double still resolves 1e-10

}  // namespace

BodyGeometry& Body::form() const {
  return m_table->form(m_index);
}

// Sets the Object's box so that it encloses the shape, at any angle if the body may turn.
void Body::fitBox() {
  const BodyGeometry& its = form();
  if (its.shapes.empty()) return;
  Vec2 lower = {kMaxBodyNumber, kMaxBodyNumber}, upper = {-kMaxBodyNumber, -kMaxBodyNumber};
  for (const Part& shape : its.shapes) {
    naiad::physics::RotatedShape turned;
    turn(shape, its.rotation, turned);
    naiad::physics::Bounds bounds = boundsOf(turned);
    if (its.is_turning) {
      const double reach = shape.reach + shape.radius;
      bounds = {{-reach, -reach}, {reach, reach}};
    }
    lower = {std::min(lower.x, bounds.lower.x), std::min(lower.y, bounds.lower.y)};
    upper = {std::max(upper.x, bounds.upper.x), std::max(upper.y, bounds.upper.y)};
  }
  const Vector corner = m_table->metric.toCells(lower), size = m_table->metric.toCells(upper - lower);
  setBox(Box(corner, size.x(), size.y()));
}

int Body::setShapes(std::vector<Part> shapes) {
  const std::vector<double> densities(shapes.size(), 1);
  Mass mass = massOf(shapes, densities);
  if (!(mass.mass > 0 && mass.inertia > 0)) return -1;
  recentre(shapes, mass);
  BodyGeometry& its = form();
  its.shapes = std::move(shapes);
  its.reach = 0;
  for (const Part& shape : its.shapes) its.reach = std::max(its.reach, shape.reach + shape.radius);
  ++its.version;
  its.unit_inertia = mass.inertia / mass.mass;
  m_table->joints.markChanged();
  fitBox();
  return 0;
}

int Body::addShape(const Part& shape) {
  std::vector<Part> shapes = form().shapes;
  shapes.push_back(shape);
  return setShapes(std::move(shapes));
}

int Body::setBoxShape() {
  form().shapes.clear();
  form().reach = 0;
  ++form().version;
  m_table->joints.markChanged();
  return 0;
}

int Body::setBoxShape(double width, double height) {
  const Vec2 half = 0.5 * m_table->metric.fromCells({width, height});
  Part shape;
  const ShapeStatus status = makeBox(half.x, half.y, {}, {}, 0, shape);
  return status == ShapeStatus::kOk && setShapes({shape}) == 0 ? 0 : refuseAs("setBoxShape");
}

int Body::setCircle(double radius) {
  Part shape;
  const ShapeStatus status = naiad::physics::makeCircle(radius, {}, shape);
  return status == ShapeStatus::kOk && setShapes({shape}) == 0 ? 0 : refuseAs("setCircle");
}

namespace {

ShapeStatus polygonOf(const std::vector<Vector>& corners, const naiad::physics::Metric& metric, Part& shape) {
  std::vector<Vec2> points;
  points.reserve(corners.size());
  double area = 0;
  for (const Vector& corner : corners) points.push_back(metric.fromCells(corner));
  for (std::size_t i = 0; i < points.size(); ++i) {
    area += cross(points[i], points[i + 1 < points.size() ? i + 1 : 0]);
  }
  if (area < 0) std::reverse(points.begin(), points.end());
  return makePolygon(points, 0, shape);
}

}  // namespace

int Body::setPolygon(const std::vector<Vector>& corners) {
  Part shape;
  const ShapeStatus status = polygonOf(corners, m_table->metric, shape);
  return status == ShapeStatus::kOk && setShapes({shape}) == 0 ? 0 : refuseAs("setPolygon");
}

int Body::addCircle(double radius, Vector centre) {
  Part shape;
  const ShapeStatus status = naiad::physics::makeCircle(radius, m_table->metric.fromCells(centre), shape);
  return status == ShapeStatus::kOk && addShape(shape) == 0 ? 0 : refuseAs("addCircle");
}

int Body::addBoxShape(double width, double height, Vector centre, double angle) {
  if (!(std::abs(angle) <= kMaxAngle)) return refuseAs("addBoxShape");
  const Vec2 half = 0.5 * m_table->metric.fromCells({width, height});
  Part shape;
  const ShapeStatus status =
      makeBox(half.x, half.y, m_table->metric.fromCells(centre), naiad::physics::rotationBy(angle), 0, shape);
  return status == ShapeStatus::kOk && addShape(shape) == 0 ? 0 : refuseAs("addBoxShape");
}

int Body::addPolygon(const std::vector<Vector>& corners) {
  Part shape;
  const ShapeStatus status = polygonOf(corners, m_table->metric, shape);
  return status == ShapeStatus::kOk && addShape(shape) == 0 ? 0 : refuseAs("addPolygon");
}

const std::vector<Part>& Body::getShapes() const {
  return std::as_const(*m_table).form(m_index).shapes;
}

void Body::setTurning(bool turning) {
  form().is_turning = turning;
  m_table->joints.markChanged();
  fitBox();
}

bool Body::isTurning() const {
  return std::as_const(*m_table).form(m_index).is_turning;
}

int Body::setAngle(double angle) {
  if (!(std::abs(angle) <= kMaxAngle)) return refuseAs("setAngle");
  form().rotation = naiad::physics::rotationBy(angle);
  fitBox();
  return 0;
}

double Body::getAngle() const {
  return angleOf(std::as_const(*m_table).form(m_index).rotation);
}

int Body::setSpin(double spin) {
  if (!(std::abs(spin) <= kMaxSpin)) return refuseAs("setSpin");
  form().spin = spin;
  return 0;
}

double Body::getSpin() const {
  return std::as_const(*m_table).form(m_index).spin;
}

double Body::getInertia() const {
  const FixedBox box = toFixed(getBox()).value_or(FixedBox{});
  return row().mass * m_table->unitInertia(m_index, box);
}

int Body::applyTorque(double torque) {
  const double sum = form().torque + torque;
  if (!isUsable(torque) || !isUsable(sum)) return refuseAs("applyTorque");
  form().torque = sum;
  return 0;
}

int Body::applyImpulseAt(Vector impulse, Vector where) {
  if (!toFixed(where)) return refuseAs("applyImpulseAt");
  syncFromStore();
  const Vec2 arm = m_table->metric.placeAtCells(where) - row().place;
  const bool turns = isTurning() && !row().is_kinematic;
  const double inertia = getInertia();
  const double spin =
      getSpin() + (turns && inertia > 0 ? cross(arm, m_table->metric.fromCells(impulse)) / inertia : 0);
  if (!(std::abs(spin) <= kMaxSpin)) return refuseAs("applyImpulseAt");
  if (applyImpulse(impulse) != 0) return -1;
  if (turns) form().spin = spin;
  return 0;
}

}  // namespace df

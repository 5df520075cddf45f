#include "physics/body/SoftObject.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/world/ClassName.h"
#include "engine/world/World.h"
#include "engine/world/WorldLog.h"
#include "engine/world/WorldStore.h"
#include "physics/body/Body.h"
#include "physics/body/SoftDrawing.h"
#include "physics/body/SoftLayer.h"
#include "physics/body/SoftTable.h"
#include "physics/geometry/Index.h"
#include "shared/values/Canvas.h"

namespace df {

namespace {

using naiad::physics::at;
using naiad::physics::SoftAttachedNode;
using naiad::physics::SoftEntry;
using naiad::physics::SoftGrab;
using naiad::physics::SoftLayer;
using naiad::physics::Vec2;

constexpr double kMaxRatio = 1e6;  // limit of gravity scale, friction and drag
constexpr double kMaxForce = 1e9;  // limit of forces and impulses; that of the solver is 1e12 (kLargestSoft)

bool isUsableForce(Vector v) {
  return std::fabs(v.x()) <= kMaxForce && std::fabs(v.y()) <= kMaxForce;  // false for NaN
}

}  // namespace

SoftBody::SoftBody() : m_table(SoftLayer::of(*getWorld()).table()) {
  setType("SoftBody");
  getWorld()->store().set(key().slot, WorldStore::kBody, true);
  setSolidness(SPECTRAL);
  m_drawn = std::make_shared<naiad::physics::SoftDrawn>();
}

SoftBody::~SoftBody() {
  if (m_id >= 0) m_table->remove(m_id);
}

void SoftBody::make(const naiad::physics::SoftBody& body) {
  m_id = m_table->add(this, key(), body);
  if (m_id < 0) {
    refuseAs("make");
    return;
  }
  SoftLayer::publishNow(*getWorld(), *m_table, m_id);
}

double SoftBody::checked(const char* what, double value, double least, double most, double usual) const {
  if (value >= least && value <= most) return value;
  refuseAs(what);
  return usual;
}

Vector SoftBody::checked(const char* what, Vector position) const {
  constexpr double kFarthest = 1e9;  // maximum distance from the origin in cells
  if (std::fabs(position.x()) <= kFarthest && std::fabs(position.y()) <= kFarthest) return position;
  refuseAs(what);
  return {};
}

SoftEntry& SoftBody::entry() const {
  return m_table->entry(m_id);
}

const naiad::physics::SoftBody& SoftBody::body() const {
  return m_table->world().body(m_id);
}

int SoftBody::refuseAs(const char* what) const {
  const World* p_world = getWorld();
  return p_world != nullptr ? p_world->log().refuse(nameOf(*this), what) : -1;
}

void SoftBody::syncFromStore() const {
  const World* p_world = getWorld();
  if (m_id < 0 || p_world == nullptr) return;
  const WorldStore& store = p_world->store();
  m_table->syncFromStore(m_id, store.position(key().slot), store.velocity(key().slot));
}

template <class Change>
int SoftBody::change(Change change) {
  if (m_id < 0) return -1;
  syncFromStore();
  naiad::physics::SoftBody changed = body();
  change(changed);
  return m_table->set(m_id, changed) ? 0 : -1;
}

double SoftBody::getMass() const {
  return m_id < 0 ? 0 : entry().mass;
}

int SoftBody::setGravityScale(double scale) {
  if (m_id < 0 || !(std::fabs(scale) <= kMaxRatio)) return refuseAs("setGravityScale");
  entry().gravity_scale = scale;
  m_table->wake(m_id);
  return 0;
}

int SoftBody::setFriction(double friction) {
  if (!(friction >= 0 && friction <= kMaxRatio)) return refuseAs("setFriction");
  return change([friction](naiad::physics::SoftBody& body) { body.friction = friction; });
}

int SoftBody::setDrag(double drag) {
  if (!(drag >= 0 && drag <= kMaxRatio)) return refuseAs("setDrag");
  return change([drag](naiad::physics::SoftBody& body) { body.drag = drag; });
}

int SoftBody::applyImpulse(Vector impulse) {
  if (m_id < 0 || !isUsableForce(impulse)) return refuseAs("applyImpulse");
  syncFromStore();
  if (entry().is_frozen) return 0;
  const Vec2 velocity = entry().velocity + m_table->metric().fromCells(impulse) / entry().mass;
  if (!toFixed(m_table->metric().toCells(velocity), kMaxVelocityCells)) return refuseAs("applyImpulse");
  m_table->setVelocity(m_id, velocity);
  return 0;
}

int SoftBody::applyImpulse(int node, Vector impulse) {
  if (!hasNode(node) || !isUsableForce(impulse)) return refuseAs("applyImpulse");
  syncFromStore();
  if (!m_table->world().applyImpulse(m_id, node, m_table->metric().fromCells(impulse))) {
    return refuseAs("applyImpulse");
  }
  m_table->wake(m_id);
  return 0;
}

int SoftBody::applyForce(Vector force) {
  if (m_id < 0) return -1;
  const Vector sum = m_table->metric().toCells(entry().force) + force;
  if (!isUsableForce(force) || !isUsableForce(sum)) return refuseAs("applyForce");
  entry().force = m_table->metric().fromCells(sum);
  m_table->wake(m_id);
  return 0;
}

int SoftBody::applyForce(int node, Vector force) {
  if (!hasNode(node) || !isUsableForce(force)) return refuseAs("applyForce");
  std::vector<Vec2>& forces = entry().node_forces;
  const Vec2 before = forces.empty() ? Vec2{} : forces[at(node)];
  const Vec2 sum = before + m_table->metric().fromCells(force);
  if (!isUsableForce(m_table->metric().toCells(sum))) return refuseAs("applyForce");
  if (forces.empty()) forces.resize(at(getNodeCount()));
  forces[at(node)] = sum;
  m_table->wake(m_id);
  return 0;
}

int SoftBody::getNodeCount() const {
  return m_id < 0 ? 0 : static_cast<int>(body().nodes.size());
}

Vector SoftBody::getNodePosition(int node) const {
  if (!hasNode(node)) return {};
  syncFromStore();
  return m_table->metric().cellsOf(body().place + body().nodes[at(node)].offset);
}

Vector SoftBody::getNodeVelocity(int node) const {
  if (!hasNode(node)) return {};
  syncFromStore();
  return m_table->metric().toCells(body().nodes[at(node)].velocity);
}

int SoftBody::getNearestNode(Vector where) const {
  if (m_id < 0 || !toFixed(where)) return -1;
  syncFromStore();
  const Vec2 offset = m_table->metric().placeAtCells(where) - body().place;
  int nearest = 0;
  for (int node = 1; node < getNodeCount(); ++node) {
    const double away = lengthSquared(body().nodes[at(node)].offset - offset);
    if (away < lengthSquared(body().nodes[at(nearest)].offset - offset)) nearest = node;
  }
  return nearest;
}

int SoftBody::pin(int node, bool pinned) {
  if (!hasNode(node)) return refuseAs("pin");
  if (isPinned(node) == pinned) return 0;
  syncFromStore();
  return m_table->pin(m_id, node, pinned) ? 0 : -1;
}

bool SoftBody::isPinned(int node) const {
  return hasNode(node) && body().nodes[at(node)].is_pinned;
}

int SoftBody::attach(int node, Body* p_body) {
  const World* p_world = getWorld();
  if (!hasNode(node) || p_body == nullptr || p_world == nullptr || p_body->getWorld() != p_world) {
    return refuseAs("attach");
  }
  syncFromStore();
  detach(node);
  const naiad::physics::Metric& metric = m_table->metric();
  const Vec2 body_offset = metric.fromCells(p_body->getDisplacementFrom(metric.cellsOf(body().place)));
  const Vec2 offset = body().nodes[at(node)].offset - body_offset;
  const Vec2 anchor = inverse(naiad::physics::rotationBy(p_body->getAngle())) * offset;
  const auto obstacle = static_cast<int>(p_body->key().slot);
  const int attachment = m_table->world().attach({m_id, node, obstacle, anchor});
  if (attachment < 0) return refuseAs("attach");
  entry().attached_nodes.push_back({attachment, node, p_body->key()});
  m_table->wake(m_id);
  return 0;
}

int SoftBody::detach(int node) {
  if (!hasNode(node)) return -1;
  int result = -1;
  std::erase_if(entry().attached_nodes, [&](const SoftAttachedNode& attached) {
    if (attached.node != node) return false;
    m_table->world().detach(attached.attachment);
    result = 0;
    return true;
  });
  m_table->wake(m_id);
  return result;
}

int SoftBody::grab(Vector where, double strength) {
  const int node = getNearestNode(where);
  if (node < 0 || !(strength >= 0 && strength <= kMaxForce)) return refuseAs("grab");
  release();
  SoftGrab grab;
  grab.attachment = m_table->world().attach({m_id, node, SoftLayer::grabIdOf(m_id), {}});
  if (grab.attachment < 0) return refuseAs("grab");
  grab.place = body().place + body().nodes[at(node)].offset;
  grab.velocity = body().nodes[at(node)].velocity;
  grab.target = grab.place;
  grab.strength = strength;
  entry().grab = grab;
  m_table->wake(m_id);
  return 0;
}

int SoftBody::dragTo(Vector target) {
  if (!isGrabbed() || !toFixed(target)) return -1;
  entry().grab.target = m_table->metric().placeAtCells(target);
  m_table->wake(m_id);
  return 0;
}

void SoftBody::release() {
  if (!isGrabbed()) return;
  m_table->world().detach(entry().grab.attachment);
  entry().grab = {};
}

bool SoftBody::isGrabbed() const {
  return m_id >= 0 && entry().grab.attachment >= 0;
}

bool SoftBody::isFrozen() const {
  syncFromStore();
  return m_id >= 0 && entry().is_frozen;
}

bool SoftBody::isAsleep() const {
  syncFromStore();
  return m_id >= 0 && entry().is_asleep;
}

int SoftBody::setDrawing(BodyDrawing drawing, char32_t ch, Color color) {
  const bool known =
      drawing == BodyDrawing::NONE || drawing == BodyDrawing::OUTLINE || drawing == BodyDrawing::FILL;
  if (!known || (ch != 0 && !isDrawable(ch)) || color < BLACK || color > WHITE) return refuseAs("setDrawing");
  *m_drawn = {};
  m_drawn->drawing = drawing;
  m_drawn->ch = ch;
  m_drawn->color = color;
  return 0;
}

int SoftBody::draw() {
  if (m_id < 0) return -1;
  syncFromStore();
  naiad::physics::redraw(*m_drawn, body(), m_table->metric());
  return naiad::physics::put(*m_drawn);
}

}  // namespace df

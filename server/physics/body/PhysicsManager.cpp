#include "physics/body/PhysicsManager.h"

#include <cmath>

#include "engine/world/World.h"
#include "engine/world/WorldLog.h"
#include "physics/body/BodyLayer.h"
#include "physics/body/BodyLimits.h"

namespace df {

namespace {

using naiad::physics::BodyTable;
using naiad::physics::IntegratorOptions;
using naiad::physics::Metric;

BodyTable& table() {
  return *naiad::physics::BodyLayer::of(World::current()).table();
}

bool isTolerance(double value) {
  return value > 0 && value <= 1;
}

bool areUsable(const IntegratorOptions& o) {
  return isTolerance(o.relative) && isTolerance(o.absolute) && isTolerance(o.stiff_relative) &&
         isTolerance(o.stiff_absolute) && o.max_evaluations >= 1 && o.max_steps >= 1 &&
         o.max_evaluations <= 10'000'000 && o.max_steps <= 10'000'000;
}

}  // namespace

PhysicsManager& PhysicsManager::getInstance() {
  static PhysicsManager* p_instance = new PhysicsManager;  // never destroyed, like all managers
  return *p_instance;
}

int PhysicsManager::refuseAs(const char* what) const {
  return World::current().log().refuse(getType(), what);
}

int PhysicsManager::setGravity(Vector gravity) {
  if (!isUsable(gravity)) return refuseAs("setGravity");
  table().settings.gravity = table().metric.fromCells(gravity);
  return 0;
}

Vector PhysicsManager::getGravity() const {
  return table().metric.toCells(table().settings.gravity);
}

int PhysicsManager::setAspect(double aspect) {
  const bool good = aspect >= Metric::kMinAspect && aspect <= Metric::kMaxAspect;
  if (!good || !table().inOrder().empty() || table().soft_bodies > 0) return refuseAs("setAspect");
  const Vector gravity = getGravity();
  table().metric = Metric(aspect);
  table().settings.gravity = table().metric.fromCells(gravity);
  return 0;
}

double PhysicsManager::getAspect() const {
  return table().metric.aspect();
}

int PhysicsManager::setIntegrator(const IntegratorOptions& options) {
  if (!areUsable(options)) return refuseAs("setIntegrator");
  table().settings.integrator = options;
  return 0;
}

const IntegratorOptions& PhysicsManager::getIntegrator() const {
  return table().settings.integrator;
}

int PhysicsManager::setObstacleFriction(double friction) {
  if (!isUsableSize(friction)) return refuseAs("setObstacleFriction");
  table().settings.obstacle_friction = friction;
  return 0;
}

double PhysicsManager::getObstacleFriction() const {
  return table().settings.obstacle_friction;
}

int PhysicsManager::setObstacleRestitution(double restitution) {
  if (!(restitution >= 0 && restitution <= 1)) return refuseAs("setObstacleRestitution");
  table().settings.obstacle_restitution = restitution;
  return 0;
}

double PhysicsManager::getObstacleRestitution() const {
  return table().settings.obstacle_restitution;
}

int PhysicsManager::setAccuracy(Accuracy accuracy) {
  if (accuracy != ACCURACY_DEFAULT && accuracy != ACCURACY_FAST) return refuseAs("setAccuracy");
  table().settings.is_fast = accuracy == ACCURACY_FAST;
  return 0;
}

Accuracy PhysicsManager::getAccuracy() const {
  return table().settings.is_fast ? ACCURACY_FAST : ACCURACY_DEFAULT;
}

void PhysicsManager::setSleeping(bool may_sleep) {
  table().settings.may_sleep = may_sleep;
}

bool PhysicsManager::isSleeping() const {
  return table().settings.may_sleep;
}

int PhysicsManager::getBodyCount() const {
  return static_cast<int>(table().inOrder().size());
}

std::uint64_t PhysicsManager::getQuarantineCount() const {
  return table().counters.quarantined;
}

std::uint64_t PhysicsManager::getLimitCount() const {
  return table().counters.limited;
}

}  // namespace df

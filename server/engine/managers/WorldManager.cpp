#include "engine/managers/WorldManager.h"

#include "engine/world/FreeSpaceSearch.h"
#include "engine/world/Geometry.h"
#include "engine/world/InputQueue.h"
#include "engine/world/Mover.h"
#include "engine/world/ObjectRegistry.h"
#include "engine/world/Started.h"
#include "engine/world/Views.h"
#include "engine/world/World.h"
#include "engine/world/WorldExtras.h"
#include "engine/world/WorldLog.h"
#include "engine/world/WorldStore.h"

namespace df {

namespace {

template <class Wanted>
ObjectList pickByBox(Wanted wanted) {
  return World::current().objects().pick(
      [&](const Object& o) { return o.isActive() && wanted(getWorldBox(&o)); });
}

/// Returns the player whose view is used: the one whose input is being handled; null: the world's own view.
Player* viewer(const World& world) {
  return world.views().player(world.input().player());
}

}  // namespace

WorldManager::WorldManager() : Manager("WorldManager", kWorldStarted) {}

WorldManager& WorldManager::getInstance() {
  static WorldManager* p_instance = new WorldManager;  // never destroyed: static Objects may still call it
  return *p_instance;
}

void WorldManager::shutDown() {
  World::current().shutDown();
}

int WorldManager::insertObject(Object* p_o) {
  return World::current().objects().insertObject(p_o);
}

int WorldManager::removeObject(Object* p_o) {
  return World::current().objects().removeObject(p_o);
}

int WorldManager::markForDelete(Object* p_o) {
  return World::current().objects().markForDelete(p_o);
}

int WorldManager::markForDelete(const ObjectList& obj_list) {
  int result = 0;
  for (int i = 0; i < obj_list.getCount(); ++i) {
    if (markForDelete(obj_list[i]) != 0) result = -1;
  }
  return result;
}

ObjectList WorldManager::objectsAtPosition(Vector where) const {
  return pickByBox([&](const Box& box) { return boxContainsPosition(box, where); });
}

ObjectList WorldManager::objectsInBox(Box box) const {
  return pickByBox([&](const Box& other) { return boxIntersectsBox(box, other); });
}

ObjectList WorldManager::objectsOnLine(Line line) const {
  return pickByBox([&](const Box& box) { return lineIntersectsBox(line, box); });
}

ObjectList WorldManager::objectsInCircle(Circle circle) const {
  return pickByBox([&](const Box& box) { return circleIntersectsBox(circle, box); });
}

SceneGraph& WorldManager::getSceneGraph() const {
  static auto* p_graph = new SceneGraph;
  return *p_graph;
}

Object* WorldManager::getViewFollowing() const {
  const World& world = World::current();
  return world.store().find(world.views().followed(viewer(world)));
}

void WorldManager::setViewSlack(Vector new_slack) {
  World::current().extras().view_slack = new_slack;
}

Vector WorldManager::getViewSlack() const {
  return World::current().extras().view_slack;
}

ObjectList WorldManager::getAllObjects(bool inactive) const {
  return World::current().objects().getAllObjects(inactive);
}

ObjectList WorldManager::objectsOfType(const std::string& type) const {
  return World::current().objects().objectsOfType(type);
}

ObjectList WorldManager::solidObjects() const {
  return World::current().objects().solidObjects();
}

Object* WorldManager::objectWithId(int id) const {
  return World::current().objects().objectWithId(id);
}

ObjectList WorldManager::objectsSeenAt(Vector cell) const {
  return World::current().input().objectsSeenAt(cell);
}

void WorldManager::setLagCompensated(bool lag_compensated) {
  World::current().input().setLagCompensated(lag_compensated);
}

bool WorldManager::isLagCompensated() const {
  return World::current().input().isLagCompensated();
}

void WorldManager::setRunsEmpty(bool runs_empty) {
  World::current().extras().settings.runs_empty = runs_empty;
}

bool WorldManager::getRunsEmpty() const {
  const WorldExtras* p_extras = World::current().findExtras();
  return p_extras != nullptr && p_extras->settings.runs_empty;
}

ObjectList WorldManager::getCollisions(const Object* p_o, Vector where) const {
  return World::current().objects().getCollisions(p_o, where);
}

WorldManager::Collisions WorldManager::isCollision(const Object* p_o, Vector where) const {
  return Collisions(getCollisions(p_o, where));
}

Contact WorldManager::firstContact(const Object* p_o, Vector where) const {
  return World::current().objects().firstContact(p_o, where);
}

std::optional<Vector> WorldManager::findFree(Box box, Vector near) const {
  World& world = World::current();
  const auto place = toFixed(box);
  const auto position = toFixed(near);
  if (!place || !position) {
    world.log().refuse("WorldManager", "findFree");
    return std::nullopt;
  }
  FreeSpaceSearch room(world.store(), world.views().boundary(), translate(*place, *position));
  const std::optional<FixedVector> offset = room.nearest();
  if (!offset) return std::nullopt;
  return Vector::fromFixed(*position + *offset);
}

void WorldManager::setSweptCollisions(bool swept) {
  World::current().store().setAllSwept(swept);
}

bool WorldManager::getSweptCollisions() const {
  return World::current().store().isAllSwept();
}

int WorldManager::moveObject(Object* p_o, Vector where) {
  return World::current().mover().moveObject(p_o, where);
}

void WorldManager::update() {
  World::current().update();
}

void WorldManager::draw() {
  World::current().draw();
}

int WorldManager::setBoundary(Box new_boundary) {
  return World::current().views().setBoundary(new_boundary);
}

Box WorldManager::getBoundary() const {
  return fromFixed(World::current().views().boundary());
}

Box WorldManager::getView() const {
  return World::current().getView();
}

int WorldManager::setView(Box new_view) {
  const World& world = World::current();
  const auto corner = toFixed(new_view.getCorner());
  if (!corner) return world.log().refuse("WorldManager", "setView");
  world.views().setCorner(viewer(world), *corner);
  return 0;
}

int WorldManager::setViewPosition(Vector view_pos) {
  const World& world = World::current();
  const auto position = toFixed(view_pos);
  if (!position) return world.log().refuse("WorldManager", "setViewPosition");
  world.views().centre(viewer(world), *position);
  return 0;
}

int WorldManager::setViewFollowing(Object* p_new_view_following) {
  const World& world = World::current();
  return world.views().follow(viewer(world), p_new_view_following);
}

std::vector<Player*> WorldManager::getPlayers() const {
  return World::current().views().getPlayers();
}

Player* WorldManager::getPlayer(std::uint32_t id) const {
  return World::current().views().player(id);
}

int WorldManager::randomInt(int n) {
  return World::current().randomInt(n);
}

}  // namespace df

#include "engine/managers/WorldManager.h"

#include "engine/world/Geometry.h"
#include "engine/world/Started.h"
#include "engine/world/Views.h"
#include "engine/world/World.h"
#include "engine/world/WorldExtras.h"

namespace df {

namespace {

template <class Wanted>
ObjectList pickByBox(Wanted wanted) {
  const ObjectList all = World::current().getAllObjects();
  ObjectList list;
  for (int i = 0; i < all.getCount(); ++i) {
    if (wanted(getWorldBox(all[i]))) list.insert(all[i]);
  }
  return list;
}

}  // namespace

WorldManager& WorldManager::getInstance() {
  static WorldManager* p_instance = new WorldManager;  // never destroyed: static Objects may still call it
  return *p_instance;
}

int WorldManager::startUp() {
  World::current().setStarted(kWorldStarted, true);
  return 0;
}

void WorldManager::shutDown() {
  World::current().shutDown();
}

bool WorldManager::isStarted() const {
  return World::current().isStarted(kWorldStarted);
}

int WorldManager::insertObject(Object* p_o) {
  return World::current().insertObject(p_o);
}

int WorldManager::removeObject(Object* p_o) {
  return World::current().removeObject(p_o);
}

int WorldManager::markForDelete(Object* p_o) {
  return World::current().markForDelete(p_o);
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
  return World::current().getViewFollowing();
}

void WorldManager::setViewSlack(Vector new_slack) {
  World::current().extras().view_slack = new_slack;
}

Vector WorldManager::getViewSlack() const {
  return World::current().extras().view_slack;
}

ObjectList WorldManager::getAllObjects(bool inactive) const {
  return World::current().getAllObjects(inactive);
}

ObjectList WorldManager::objectsOfType(const std::string& type) const {
  return World::current().objectsOfType(type);
}

ObjectList WorldManager::solidObjects() const {
  return World::current().solidObjects();
}

Object* WorldManager::objectWithId(int id) const {
  return World::current().objectWithId(id);
}

ObjectList WorldManager::objectsSeenAt(Vector cell) const {
  return World::current().objectsSeenAt(cell);
}

void WorldManager::setLookingBack(bool looking_back) {
  World::current().setLookingBack(looking_back);
}

bool WorldManager::isLookingBack() const {
  return World::current().isLookingBack();
}

void WorldManager::setRunsEmpty(bool runs_empty) {
  World::current().extras().settings.runs_empty = runs_empty;
}

bool WorldManager::getRunsEmpty() const {
  const WorldExtras* p_extras = World::current().findExtras();
  return p_extras != nullptr && p_extras->settings.runs_empty;
}

ObjectList WorldManager::getCollisions(const Object* p_o, Vector where) const {
  return World::current().getCollisions(p_o, where);
}

WorldManager::Collisions WorldManager::isCollision(const Object* p_o, Vector where) const {
  return Collisions(getCollisions(p_o, where));
}

Contact WorldManager::firstContact(const Object* p_o, Vector where) const {
  return World::current().firstContact(p_o, where);
}

std::optional<Vector> WorldManager::findFree(Box box, Vector near) const {
  return World::current().findFree(box, near);
}

void WorldManager::setSweptCollisions(bool swept) {
  World::current().setSweptCollisions(swept);
}

bool WorldManager::getSweptCollisions() const {
  return World::current().getSweptCollisions();
}

int WorldManager::moveObject(Object* p_o, Vector where) {
  return World::current().moveObject(p_o, where);
}

void WorldManager::update() {
  World::current().update();
}

void WorldManager::draw() {
  World::current().draw();
}

int WorldManager::setBoundary(Box new_boundary) {
  return World::current().setBoundary(new_boundary);
}

Box WorldManager::getBoundary() const {
  return World::current().getBoundary();
}

Box WorldManager::getView() const {
  return World::current().getView();
}

int WorldManager::setView(Box new_view) {
  return World::current().setView(new_view);
}

int WorldManager::setViewPosition(Vector view_pos) {
  return World::current().setViewPosition(view_pos);
}

int WorldManager::setViewFollowing(Object* p_new_view_following) {
  return World::current().setViewFollowing(p_new_view_following);
}

std::vector<Player*> WorldManager::getPlayers() const {
  return World::current().getPlayers();
}

Player* WorldManager::getPlayer(std::uint32_t id) const {
  return World::current().getPlayer(id);
}

int WorldManager::randomInt(int n) {
  return World::current().randomInt(n);
}

}  // namespace df

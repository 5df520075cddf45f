#include "Course.h"

#include <string>
#include <utility>

#include "engine/managers/WorldManager.h"
#include "engine/world/EventCollision.h"
#include "engine/world/Object.h"
#include "engine/world/WorldLog.h"

namespace bench {

/// Notes whom it has met.
class Runner : public df::Object {
 public:
  int eventHandler(const df::Event* p_e) override {
    if (p_e->getType() != df::COLLISION_EVENT) return 0;
    const auto* p_collision = static_cast<const df::EventCollision*>(p_e);
    if (m_p_met == nullptr) m_p_met = p_collision->getObject2();
    return 1;
  }

  const df::Object* takeMet() { return std::exchange(m_p_met, nullptr); }

 private:
  const df::Object* m_p_met = nullptr;
};

namespace {

df::FixedVector exactly(df::Vector v) {
  return df::toFixed(v).value_or(df::FixedVector{});
}

}  // namespace

Course::Course(const Field& field) : m_scope(m_world) {
  m_world.log().setSink([](const std::string& /*line*/) {});
  WM.setBoundary(df::Box(df::Vector(-1e5, -1e5), 1e6, 1e6));
  for (const df::FixedBox& box : field.obstacles) {
    auto* p_obstacle = new df::Object;
    if (m_first_id == 0) m_first_id = p_obstacle->getId();
    const df::FixedVector middle = {box.corner.x + box.size.x / 2, box.corner.y + box.size.y / 2};
    p_obstacle->setPosition(df::Vector::fromFixed(middle));
  }
  m_p_runner = new Runner;
  m_p_runner->setSwept();
}

Course::~Course() {
  m_world.shutDown();
}

void Course::place(const Cast& cast) {
  m_p_runner->setPosition(df::Vector::fromFixed(cast.from));
}

Answer Course::ask(const Cast& cast) {
  place(cast);
  const df::Contact contact = WM.firstContact(m_p_runner, df::Vector::fromFixed(cast.to));
  return {numberOf(contact.p_object), contact.time, exactly(contact.position)};
}

Answer Course::move(const Cast& cast) {
  place(cast);
  WM.moveObject(m_p_runner, df::Vector::fromFixed(cast.to));
  return {numberOf(m_p_runner->takeMet()), 0, exactly(m_p_runner->getPosition())};
}

bool Course::isBlockedAtEnd(const Cast& cast) {
  place(cast);
  return WM.isCollision(m_p_runner, df::Vector::fromFixed(cast.to));
}

std::uint32_t Course::numberOf(const df::Object* p_object) const {
  return p_object == nullptr ? kNobody : static_cast<std::uint32_t>(p_object->getId() - m_first_id);
}

}  // namespace bench

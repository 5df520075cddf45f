#include "EngineDriver.h"

#include "EventCollision.h"
#include "EventOut.h"
#include "EventStep.h"
#include "WorldManager.h"

namespace oracle {

using df::Vector;

static FixedVector fixed(Vector v) {
  return *df::toFixed(v);
}

/// An Object whose handler is the script. The handler may destroy it, so nothing of it is used afterwards.
class EngineDriver::Scripted : public df::Object {
 public:
  Scripted(EngineDriver& driver, int number) : m_driver(driver), m_number(number) {
    registerInterest(df::STEP_EVENT);
  }
  ~Scripted() override {
    m_driver.m_objects[static_cast<std::size_t>(m_number)] = nullptr;
    m_driver.m_script.onDestroyed(m_number);
  }

  int eventHandler(const df::Event* p_e) override {
    Script& script = m_driver.m_script;
    if (const auto* p_c = dynamic_cast<const df::EventCollision*>(p_e)) {
      script.onCollision(m_number, number(p_c->getObject1()), number(p_c->getObject2()),
                         fixed(p_c->getPosition()));
    } else if (p_e->getType() == df::OUT_EVENT) {
      script.onOut(m_number);
    } else {
      script.onStep(m_number);
    }
    return 1;
  }

  static int number(const df::Object* p_o) { return static_cast<const Scripted*>(p_o)->m_number; }

 private:
  EngineDriver& m_driver;
  int m_number;
};

EngineDriver::EngineDriver(const RandomWorld& world) : m_scope(m_world), m_script(world, *this) {
  m_world.setLogSink([](const std::string&) {});
  WM.setBoundary(df::fromFixed(world.boundary));
  m_script.begin();
}

EngineDriver::~EngineDriver() {
  for (const Scripted* p_o : m_objects) delete p_o;
}

void EngineDriver::create(int id, const Spec& spec) {
  m_objects.push_back(nullptr);
  auto* p_o = new Scripted(*this, id);
  m_objects.back() = p_o;
  p_o->setPosition(Vector::fromFixed(spec.position));
  p_o->setVelocity(Vector::fromFixed(spec.velocity));
  p_o->setAcceleration(Vector::fromFixed(spec.acceleration));
  p_o->setBox(df::fromFixed(spec.box));
  p_o->setSolidness(spec.solidness);
  p_o->setNoSoft(spec.no_soft);
  p_o->setActive(spec.active);
}

void EngineDriver::markForDelete(int id) {
  WM.markForDelete(object(id));
}
void EngineDriver::deleteByHand(int id) {
  delete object(id);
}
void EngineDriver::remove(int id) {
  WM.removeObject(object(id));
}
void EngineDriver::insert(int id) {
  WM.insertObject(object(id));
  object(id)->registerInterest(df::STEP_EVENT);
}
int EngineDriver::moveObject(int id, FixedVector where) {
  return WM.moveObject(object(id), Vector::fromFixed(where));
}
void EngineDriver::setPosition(int id, FixedVector position) {
  object(id)->setPosition(Vector::fromFixed(position));
}
void EngineDriver::setVelocity(int id, FixedVector velocity) {
  object(id)->setVelocity(Vector::fromFixed(velocity));
}
void EngineDriver::setAcceleration(int id, FixedVector acceleration) {
  object(id)->setAcceleration(Vector::fromFixed(acceleration));
}
void EngineDriver::setSolidness(int id, Solidness solidness) {
  object(id)->setSolidness(solidness);
}
void EngineDriver::setBox(int id, FixedBox box) {
  object(id)->setBox(df::fromFixed(box));
}
void EngineDriver::setNoSoft(int id, bool no_soft) {
  object(id)->setNoSoft(no_soft);
}
void EngineDriver::setActive(int id, bool active) {
  object(id)->setActive(active);
}

FixedVector EngineDriver::getPosition(int id) const {
  return fixed(object(id)->getPosition());
}
FixedVector EngineDriver::getVelocity(int id) const {
  return fixed(object(id)->getVelocity());
}
Solidness EngineDriver::getSolidness(int id) const {
  return object(id)->getSolidness();
}

void EngineDriver::tick() {
  m_script.beginTick();
  m_world.tick();
}

std::vector<Snapshot> EngineDriver::snapshot() const {
  std::vector<Snapshot> result;
  const df::ObjectList all = WM.getAllObjects(true);
  for (int i = 0; i < all.getCount(); ++i) {
    const df::Object* p_o = all[i];
    result.push_back({Scripted::number(p_o), fixed(p_o->getPosition()), fixed(p_o->getVelocity()),
                      *df::toFixed(p_o->getBox()), p_o->getSolidness(), p_o->getNoSoft(), p_o->isActive()});
  }
  return result;
}

}  // namespace oracle

#include "EngineDriver.h"

#include "engine/events/EventOut.h"
#include "engine/events/EventStep.h"
#include "engine/world/EventCollision.h"
#include "engine/world/WorldLog.h"

namespace oracle {

using df::Vector;

static FixedVector fixed(Vector v) {
  return *df::toFixed(v);
}

/// An Object without a handler.
class EngineDriver::Numbered : public df::Object {
 public:
  Numbered(EngineDriver& driver, int number) : m_driver(driver), m_number(number) {
    registerInterest(df::STEP_EVENT);
  }
  ~Numbered() override {
    m_driver.m_objects[static_cast<std::size_t>(m_number)] = nullptr;
    m_driver.m_script.onDestroyed(m_number);
  }

  static int number(const df::Object* p_o) { return static_cast<const Numbered*>(p_o)->m_number; }

 protected:
  EngineDriver& m_driver;
  int m_number;
};

/// An Object whose handler calls the script. The script may delete the Object, so do not use it afterwards.
class EngineDriver::Scripted : public Numbered {
 public:
  using Numbered::Numbered;

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
};

EngineDriver::EngineDriver(const RandomWorld& world) : m_scope(m_world), m_script(world, *this) {
  m_world.log().setSink([](const std::string&) {});
  WM.setBoundary(df::fromFixed(world.boundary));
  m_script.begin();
}

EngineDriver::~EngineDriver() {
  for (const df::Object* p_o : m_objects) delete p_o;
}

void EngineDriver::create(int id, const Spec& spec) {
  m_objects.push_back(nullptr);
  df::Object* p_o = spec.temper == Temper::DEAF ? new Numbered(*this, id) : new Scripted(*this, id);
  m_objects.back() = p_o;
  p_o->setPosition(Vector::fromFixed(spec.position));
  p_o->setVelocity(Vector::fromFixed(spec.velocity));
  p_o->setAcceleration(Vector::fromFixed(spec.acceleration));
  p_o->setBox(df::fromFixed(spec.box));
  p_o->setSolidness(spec.solidness);
  p_o->setNoSoft(spec.no_soft);
  p_o->setActive(spec.active);
  setOptions(id, spec.options);
  if (!spec.mask.empty()) setMask(id, spec.mask);
}

void EngineDriver::insert(int id) {
  WM.insertObject(object(id));
  object(id)->registerInterest(df::STEP_EVENT);
}

void EngineDriver::setOptions(int id, Options options) {
  df::Object* p_o = object(id);
  p_o->setSwept(options.swept);
  p_o->setPrecise(options.precise);
  p_o->setRestContacts(options.rest_contacts);
  p_o->setMayMoveOut(options.may_move_out);
}
void EngineDriver::setMask(int id, const Mask& mask) {
  std::vector<std::string> rows = mask;
  for (std::string& row : rows) {  // multi-byte characters, as in UTF-8
    const std::size_t set = row.find('#');
    if (set != std::string::npos) row.replace(set, 1, "█");
  }
  object(id)->setMask(rows);
}

Meeting EngineDriver::firstContact(int id, FixedVector where) {
  const df::Contact contact = WM.firstContact(object(id), Vector::fromFixed(where));
  return {contact.p_object != nullptr ? Numbered::number(contact.p_object) : -1, contact.time,
          fixed(contact.position)};
}
std::optional<FixedVector> EngineDriver::findFree(FixedBox box, FixedVector near) {
  const auto found = WM.findFree(df::fromFixed(box), Vector::fromFixed(near));
  return found ? std::optional(fixed(*found)) : std::nullopt;
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
    const Options options{p_o->isSwept(), p_o->isPrecise(), p_o->hasRestContacts(), p_o->getMayMoveOut()};
    result.push_back({{fixed(p_o->getPosition()), fixed(p_o->getVelocity()), *df::toFixed(p_o->getBox()),
                       p_o->getSolidness(), p_o->getNoSoft(), p_o->isActive(), options},
                      Numbered::number(p_o)});
  }
  return result;
}

}  // namespace oracle

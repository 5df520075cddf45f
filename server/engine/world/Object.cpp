#include "engine/world/Object.h"

#include <string_view>
#include <utility>

#include "engine/collision/Mask.h"
#include "engine/world/ClassName.h"
#include "engine/world/Interests.h"
#include "engine/world/ObjectExtras.h"
#include "engine/world/World.h"
#include "engine/world/WorldStore.h"

namespace df {

namespace {

/// The constant that was meant by a name that lacks the engine's "df-"; null for all others.
const char* engineEventFor(std::string_view name) {
  if (name.starts_with("df-") || name.size() > 9) return nullptr;
  for (const auto& [word, constant] :
       {std::pair{"step", "STEP_EVENT"}, std::pair{"keyboard", "KEYBOARD_EVENT"},
        std::pair{"mouse", "MSE_EVENT"}, std::pair{"collision", "COLLISION_EVENT"},
        std::pair{"out", "OUT_EVENT"}}) {
    if (name == word) return constant;
  }
  return nullptr;
}

}  // namespace

ObjectKey Object::key() const {
  return m_p_store->key(m_slot);
}

// Null for a deleted Object (DelayedFree.h): its setters must not reach the world's lists.
World* Object::getWorld() const {
  return m_p_store->object(m_slot) == this ? m_p_store->world() : nullptr;
}

int Object::refuse(const char* what) const {
  if (World* p_world = getWorld()) p_world->refuse(nameOf(*this), what);
  return -1;
}

void Object::setType(std::string new_type) {
  m_p_profile->type = std::move(new_type);
}

int Object::getId() const {
  if (m_p_extras != nullptr && m_p_extras->id) return *m_p_extras->id;
  return static_cast<int>(m_p_store->order(m_slot));
}

void Object::setId(int new_id) {
  extras().id = new_id;
}

Object::MaxId::operator int() const {
  return static_cast<int>(World::current().store().lastOrder());
}

int Object::setAltitude(int new_altitude) {
  if (new_altitude < 0 || new_altitude > MAX_ALTITUDE) return refuse("setAltitude");
  m_p_store->setAltitude(m_slot, new_altitude);
  return 0;
}

int Object::getAltitude() const {
  return m_p_store->altitude(m_slot);
}

int Object::setBox(Box new_box) {
  const auto box = toFixed(new_box);
  if (!box) return refuse("setBox");
  m_p_store->setBox(m_slot, *box);
  return 0;
}

Box Object::getBox() const {
  return fromFixed(m_p_store->box(m_slot));
}

int Object::setSolidness(Solidness new_solid) {
  if (new_solid != HARD && new_solid != SOFT && new_solid != SPECTRAL) return refuse("setSolidness");
  m_p_store->setSolidness(m_slot, new_solid);
  return 0;
}

Solidness Object::getSolidness() const {
  return m_p_store->solidness(m_slot);
}

bool Object::isSolid() const {
  return getSolidness() != SPECTRAL;
}

void Object::setNoSoft(bool new_no_soft) {
  m_p_store->set(m_slot, WorldStore::kNoSoft, new_no_soft);
}

bool Object::getNoSoft() const {
  return m_p_store->has(m_slot, WorldStore::kNoSoft);
}

void Object::setSwept(bool swept) {
  m_p_store->set(m_slot, WorldStore::kSwept, swept);
}

bool Object::isSwept() const {
  return m_p_store->has(m_slot, WorldStore::kSwept);
}

void Object::setPrecise(bool precise) {
  m_p_store->set(m_slot, WorldStore::kPrecise, precise);
}

bool Object::isPrecise() const {
  return m_p_store->has(m_slot, WorldStore::kPrecise);
}

int Object::setMask(const std::vector<std::string>& rows) {
  if (rows.empty()) {
    m_p_store->setMask(m_slot, std::nullopt);
    return 0;
  }
  auto mask = Mask::fromRows(rows);
  if (!mask) return refuse("setMask");
  m_p_store->setMask(m_slot, std::move(mask));
  return 0;
}

void Object::setRestContacts(bool rest_contacts) {
  m_p_store->set(m_slot, WorldStore::kRestContacts, rest_contacts);
}

bool Object::hasRestContacts() const {
  return m_p_store->has(m_slot, WorldStore::kRestContacts);
}

void Object::setMayMoveOut(bool may_move_out) {
  m_p_store->set(m_slot, WorldStore::kMayMoveOut, may_move_out);
}

bool Object::getMayMoveOut() const {
  return m_p_store->has(m_slot, WorldStore::kMayMoveOut);
}

int Object::setActive(bool active) {
  m_p_store->set(m_slot, WorldStore::kActive, active);
  return 0;
}

bool Object::isActive() const {
  return m_p_store->has(m_slot, WorldStore::kActive);
}

int Object::setVisible(bool visible) {
  m_p_store->set(m_slot, WorldStore::kVisible, visible);
  return 0;
}

bool Object::isVisible() const {
  return m_p_store->has(m_slot, WorldStore::kVisible);
}

int Object::registerInterest(const std::string& event_type) {
  World* p_world = getWorld();
  if (p_world == nullptr) return -1;
  if (const char* p_meant = engineEventFor(event_type)) {
    p_world->logOnce("registerInterest(\"" + event_type +
                     "\"): the engine sends no such event; it sends df::" + p_meant);
  }
  return p_world->interests().add(*this, event_type);
}

int Object::unregisterInterest(const std::string& event_type) {
  World* p_world = getWorld();
  if (p_world == nullptr) return -1;
  const int result = p_world->interests().remove(*this, event_type);
  return p_world->compat() ? 0 : result;
}

int Object::eventHandler(const Event* /*p_e*/) {
  return 0;
}

void Object::setStaticLook(bool static_look) {
  m_p_store->set(m_slot, WorldStore::kStaticLook, static_look);
  if (World* p_world = getWorld()) p_world->forgetLook(m_slot);
}

bool Object::hasStaticLook() const {
  return m_p_store->has(m_slot, WorldStore::kStaticLook);
}

}  // namespace df

#include "engine/world/Object.h"

#include <atomic>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <new>
#include <string_view>
#include <utility>

#include "engine/collision/Mask.h"
#include "engine/world/ClassName.h"
#include "engine/world/DelayedFree.h"
#include "engine/world/Interests.h"
#include "engine/world/ObjectExtras.h"
#include "engine/world/World.h"
#include "engine/world/WorldLog.h"
#include "engine/world/WorldStore.h"

namespace df {

namespace {

thread_local PendingBlocks t_pending;

// Returns the address of the function that implements this Object's eventHandler(), to find out whether its
// class overrides it. Uses the Itanium C++ ABI, which GCC and Clang follow: an Object begins with the address
// of its vtable, and on x86-64 a pointer to a virtual member function begins with 1 + the function's offset
// there. Returns null on other platforms.
const void* handlerOf(const Object& object) {
#if defined(__x86_64__) && defined(__GXX_ABI_VERSION)
  int (Object::*const p_member)(const Event*) = &Object::eventHandler;
  std::ptrdiff_t offset = 0;
  std::memcpy(&offset, &p_member, sizeof offset);
  const std::byte* p_table = nullptr;
  std::memcpy(&p_table, static_cast<const void*>(&object), sizeof p_table);
  const void* p_function = nullptr;
  std::memcpy(&p_function, p_table + offset - 1, sizeof p_function);
  return p_function;
#else
  (void)object;
  return nullptr;
#endif
}

const void* g_p_base_handler = nullptr;

// An Object begins on a cache line of its own, so that the members that every event uses share that line.
constexpr std::align_val_t kLine{64};

// The box of an Object without a sprite in the published engine. It is smaller than a cell, so Objects in
// neighbouring cells do not touch.
const FixedBox kCompatBox{{-kFixedOne / 2, -kFixedOne / 2}, {*toFixed(0.99), *toFixed(0.99)}};
const FixedVector kCompatPlace{kFixedOne, kFixedOne};

// Clears the memory in compat, because games of the published engine rely on memory that happens to be zero.
void* cleared(void* p, std::size_t size) {
  return World::current().compat() ? std::memset(p, 0, size) : p;
}

/// Returns the name of the constant that a game meant by an event name without "df-"; null for other names.
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

bool sameBits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

bool isFiniteFloat(double x) {
  return std::isfinite(static_cast<float>(x));
}

}  // namespace

// Construction and destruction.

void* Object::operator new(std::size_t size) {
  void* p = cleared(::operator new(size, kLine), size);
  t_pending.push(p, size);
  return p;
}

void* Object::operator new(std::size_t size, const std::nothrow_t& nothrow) noexcept {
  void* p = ::operator new(size, kLine, nothrow);
  if (p != nullptr) t_pending.push(cleared(p, size), size);
  return p;
}

void* Object::operator new(std::size_t size, std::align_val_t align) {
  void* p = cleared(::operator new(size, align), size);
  t_pending.push(p, size);
  return p;
}

void Object::operator delete(void* p) noexcept {
  operator delete(p, kLine);
}

void Object::operator delete(void* p, std::align_val_t align) noexcept {
  t_pending.cancel(p);
  if (!World::current().compat()) {
    ::operator delete(p, align);
    return;
  }
  // Never destroyed, because static Objects may delete others after the thread's own variables are gone.
  thread_local auto* t_p_freed = new (std::nothrow) DelayedFree;
  if (t_p_freed != nullptr) {
    t_p_freed->free(p, align);
  } else {
    ::operator delete(p, align);
  }
}

Object::Object() : m_p_store(nullptr), m_slot(0), m_p_profile(nullptr) {
  World& world = World::current();
  m_p_store = &world.store();
  m_slot = m_p_store->allocateSlot(this, t_pending.claim(this));
  m_p_profile = &m_p_store->profile(m_slot);
  if (world.compat()) {
    m_p_store->setBox(m_slot, kCompatBox);
    m_p_store->setPosition(m_slot, kCompatPlace);
    m_p_profile->type = kUndefinedType;
  }
  // The derived class has not been constructed yet, so handlerOf() returns the handler of Object itself.
  if (g_p_base_handler == nullptr) g_p_base_handler = handlerOf(*this);
  m_p_store->enter(m_slot);
}

Object::~Object() {
  if (m_p_extras != nullptr) dropExtras();
  leaveWorld();
  m_p_store->freeSlot(m_slot);
  // Calls on the deleted Object (DelayedFree.h) must find no extras: the compiler must not drop this store.
  m_p_extras.reset();
  std::atomic_signal_fence(std::memory_order_seq_cst);
}

void Object::leaveWorld() {
  World* p_world = getWorld();
  if (p_world == nullptr) return;
  p_world->interests().removeAll(*m_p_profile);
  m_p_store->leave(m_slot);
}

bool Object::hasNoEventHandler() const {
  return g_p_base_handler != nullptr && handlerOf(*this) == g_p_base_handler;
}

Object::Object(const Object& other) : Object() {
  leaveWorld();
  copyAttributes(other);
}

Object& Object::operator=(const Object& other) {
  if (this != &other) copyAttributes(other);
  return *this;
}

void Object::copyAttributes(const Object& other) {
  const WorldStore& from = *other.m_p_store;
  WorldStore& to = *m_p_store;
  const WorldStore::Slot source = other.m_slot;
  to.setPosition(m_slot, from.position(source));
  to.setBox(m_slot, from.box(source));
  to.setAltitude(m_slot, from.altitude(source));
  to.setSolidness(m_slot, from.solidness(source));
  for (const WorldStore::Flag flag :
       {WorldStore::kActive, WorldStore::kVisible, WorldStore::kNoSoft, WorldStore::kStaticLook,
        WorldStore::kSwept, WorldStore::kPrecise, WorldStore::kRestContacts, WorldStore::kMayMoveOut,
        WorldStore::kOnView}) {
    to.set(m_slot, flag, from.has(source, flag));
  }
  to.setVelocity(m_slot, from.velocity(source));
  to.setAcceleration(m_slot, from.acceleration(source));
  to.setDerived(m_slot, from.has(source, WorldStore::kDerive));
  to.setFrames(m_slot, from.frames(source));
  // Copies all attributes but the interests, which belong to the Object that registered them.
  const ObjectProfile& profile = *other.m_p_profile;
  m_p_profile->type = profile.type;
  m_p_profile->speed = profile.speed;
  m_p_profile->direction = profile.direction;
  m_p_profile->direction_is_velocity = profile.direction_is_velocity;
  if (other.m_p_extras == nullptr && m_p_extras == nullptr) return;
  const ObjectExtras plain;
  const ObjectExtras& theirs = other.m_p_extras != nullptr ? *other.m_p_extras : plain;
  extras().animation = theirs.animation;
  extras().shape = theirs.shape;
  extras().is_centered = theirs.is_centered;
  extras().avoids_collisions = theirs.avoids_collisions;
  animate();
}

// Identity, world and collisions.

ObjectKey Object::key() const {
  return m_p_store->key(m_slot);
}

// Returns null for a deleted Object (DelayedFree.h), because its setters must not reach the world's lists.
World* Object::getWorld() const {
  return m_p_store->object(m_slot) == this ? m_p_store->world() : nullptr;
}

int Object::refuse(const char* what) const {
  World* p_world = getWorld();
  return p_world != nullptr ? p_world->log().refuse(nameOf(*this), what) : -1;
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
    p_world->log().writeOnce("registerInterest(\"" + event_type +
                             "\"): the engine sends no such event; it sends df::" + p_meant);
  }
  return p_world->interests().add(key(), *m_p_profile, event_type);
}

int Object::unregisterInterest(const std::string& event_type) {
  World* p_world = getWorld();
  if (p_world == nullptr) return -1;
  const int result = p_world->interests().remove(key(), *m_p_profile, event_type);
  return p_world->compat() ? 0 : result;
}

int Object::eventHandler(const Event* /*p_e*/) {
  return 0;
}

// Motion.

int Object::setPosition(Vector new_pos) {
  const auto position = toFixed(new_pos);
  if (!position) return refuse("setPosition");
  m_p_store->setPosition(m_slot, *position);
  return 0;
}

Vector Object::getPosition() const {
  return Vector::fromFixed(m_p_store->position(m_slot));
}

void Object::deriveKinematics() const {
  ObjectProfile& profile = *m_p_profile;
  const bool follow = m_p_store->has(m_slot, WorldStore::kDerive);
  if (!follow && !profile.direction_is_velocity) return;
  if (follow) profile.direction = getVelocity();
  m_p_store->setDerived(m_slot, false);
  profile.direction_is_velocity = false;
  profile.speed = std::sqrt(profile.direction.x() * profile.direction.x() +
                            profile.direction.y() * profile.direction.y());
  profile.direction.normalize();
}

int Object::applyVelocity(double speed, Vector direction) {
  if (!isFiniteFloat(speed) || !isFiniteFloat(direction.x()) || !isFiniteFloat(direction.y())) return -1;
  const auto velocity = toFixed(Vector(direction.x() * speed, direction.y() * speed), kMaxVelocityCells);
  if (!velocity) return -1;
  m_p_profile->speed = speed;
  m_p_profile->direction = direction;
  m_p_profile->direction_is_velocity = false;
  m_p_store->setVelocity(m_slot, *velocity);
  return 0;
}

int Object::setSpeed(double speed) {
  deriveKinematics();
  return applyVelocity(speed, m_p_profile->direction) == 0 ? 0 : refuse("setSpeed");
}

float Object::getSpeed() const {
  deriveKinematics();
  return static_cast<float>(m_p_profile->speed);
}

int Object::setDirection(Vector new_direction) {
  deriveKinematics();
  return applyVelocity(m_p_profile->speed, new_direction) == 0 ? 0 : refuse("setDirection");
}

Vector Object::getDirection() const {
  deriveKinematics();
  return m_p_profile->direction;
}

// Rounds the vector itself, not the product of its length and direction, so that getVelocity() returns the
// value that was set.
int Object::setVelocity(Vector new_velocity) {
  const auto velocity = toFixed(new_velocity, kMaxVelocityCells);
  if (!velocity) return refuse("setVelocity");
  // Speed and direction follow from the velocity if that holds the vector exactly (it cannot hold -0).
  const Vector derived = Vector::fromFixed(*velocity);
  const bool is_derived = sameBits(derived.x(), new_velocity.x()) && sameBits(derived.y(), new_velocity.y());
  m_p_store->setDerived(m_slot, is_derived);
  if (!is_derived) {
    m_p_profile->direction = new_velocity;
    m_p_profile->direction_is_velocity = true;
  }
  m_p_store->setVelocity(m_slot, *velocity);
  return 0;
}

Vector Object::getVelocity() const {
  return Vector::fromFixed(m_p_store->velocity(m_slot));
}

int Object::setAcceleration(Vector new_acceleration) {
  const auto acceleration = toFixed(new_acceleration, kMaxVelocityCells);
  if (!acceleration) return refuse("setAcceleration");
  m_p_store->setAcceleration(m_slot, *acceleration);
  return 0;
}

Vector Object::getAcceleration() const {
  return Vector::fromFixed(m_p_store->acceleration(m_slot));
}

Vector Object::predictPosition() const {
  return Vector::fromFixed(m_p_store->position(m_slot) + m_p_store->velocity(m_slot));
}

}  // namespace df

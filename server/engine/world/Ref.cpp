#include "engine/world/Ref.h"

#include <utility>

#include "engine/world/Object.h"
#include "engine/world/World.h"
#include "engine/world/WorldStore.h"

namespace df {

RefBase::RefBase(const Object* p_o) {
  World* p_world = p_o != nullptr ? p_o->getWorld() : nullptr;
  if (p_world == nullptr) return;
  m_p_store = &p_world->store();
  m_p_store->retain();
  m_key = p_o->key();
}

RefBase::RefBase(const RefBase& other) : m_p_store(other.m_p_store), m_key(other.m_key) {
  if (m_p_store != nullptr) m_p_store->retain();
}

RefBase::RefBase(RefBase&& other) noexcept
    : m_p_store(std::exchange(other.m_p_store, nullptr)), m_key(std::exchange(other.m_key, {})) {}

RefBase& RefBase::operator=(RefBase other) noexcept {
  std::swap(m_p_store, other.m_p_store);
  std::swap(m_key, other.m_key);
  return *this;
}

RefBase::~RefBase() {
  if (m_p_store != nullptr) m_p_store->release();
}

bool RefBase::isInWorld() const {
  return m_p_store != nullptr && m_p_store->isCurrent(m_key) &&
         m_p_store->has(m_key.slot, WorldStore::kInWorld);
}

}  // namespace df

#include "engine/world/ObjectList.h"

#include <algorithm>
#include <utility>

#include "engine/world/Object.h"
#include "engine/world/WorldStore.h"

namespace df {

ObjectList::ObjectList(const ObjectList& other)
    : m_p_store(other.m_p_store), m_count(other.m_count), m_few(other.m_few), m_many(other.m_many) {
  if (m_p_store != nullptr) m_p_store->retain();
}

ObjectList::ObjectList(ObjectList&& other) noexcept
    : m_p_store(std::exchange(other.m_p_store, nullptr)),
      m_count(std::exchange(other.m_count, 0)),
      m_few(other.m_few),
      m_many(std::move(other.m_many)) {
  other.m_many.clear();
}

ObjectList& ObjectList::operator=(ObjectList other) noexcept {
  std::swap(m_p_store, other.m_p_store);
  std::swap(m_count, other.m_count);
  std::swap(m_few, other.m_few);
  std::swap(m_many, other.m_many);
  return *this;
}

ObjectList::~ObjectList() {
  if (m_p_store != nullptr) m_p_store->release();
}

void ObjectList::append(WorldStore* p_store, ObjectKey key) {
  if (m_p_store == nullptr) {
    m_p_store = p_store;
    m_p_store->retain();
  }
  if (m_count < kInline) {
    m_few[m_count] = key;
  } else {
    if (m_count == kInline) m_many.assign(m_few.begin(), m_few.end());
    m_many.push_back(key);
  }
  ++m_count;
}

int ObjectList::insert(Object* p_o) {
  if (p_o == nullptr) return -1;
  if (m_p_store != nullptr && m_p_store != p_o->m_p_store) return -1;
  append(p_o->m_p_store, p_o->key());
  return 0;
}

int ObjectList::remove(const Object* p_o) {
  if (p_o == nullptr || p_o->m_p_store != m_p_store) return -1;
  ObjectKey* p_begin = keys();
  ObjectKey* p_end = p_begin + m_count;
  ObjectKey* p_found = std::find(p_begin, p_end, p_o->key());
  if (p_found == p_end) return -1;
  std::copy(p_found + 1, p_end, p_found);
  --m_count;
  if (m_count == kInline) std::copy_n(m_many.begin(), kInline, m_few.begin());
  if (m_count >= kInline) m_many.resize(m_count == kInline ? 0 : m_count);
  return 0;
}

void ObjectList::clear() {
  if (m_p_store != nullptr) m_p_store->release();
  m_p_store = nullptr;
  m_count = 0;
  m_many.clear();
}

Object* ObjectList::operator[](int index) const {
  if (index < 0 || index >= m_count) return nullptr;
  return m_p_store->find(keys()[index]);
}

bool operator==(const ObjectList& a, const ObjectList& b) {
  return a.m_count == b.m_count && (a.m_p_store == b.m_p_store || a.m_count == 0) &&
         std::equal(a.keys(), a.keys() + a.m_count, b.keys());
}

ObjectList& ObjectList::operator+=(const ObjectList& other) {
  if (m_p_store != nullptr && other.m_p_store != m_p_store) return *this;
  const int count = other.m_count;  // `other` may be this list
  for (int i = 0; i < count; ++i) append(other.m_p_store, other.keys()[i]);
  return *this;
}

}  // namespace df

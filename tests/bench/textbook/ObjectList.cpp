#include <cstdlib>
#include <cstring>

#include "Book.h"

namespace textbook {

ObjectList::ObjectList() {
  m_count = 0;
  m_max_count = 0;
  m_p_obj = nullptr;
}

ObjectList::ObjectList(const ObjectList& other) : ObjectList() {
  for (int i = 0; i < other.m_count; i++) insert(other.m_p_obj[i]);
}

ObjectList::~ObjectList() {
  free(m_p_obj);
}

int ObjectList::insert(Object* p_o) {
  if (m_count == m_max_count) {
    const int new_max = m_max_count == 0 ? 8 : 2 * m_max_count;
    auto** p_temp = static_cast<Object**>(realloc(m_p_obj, sizeof(Object*) * new_max));
    if (p_temp == nullptr) return -1;
    m_p_obj = p_temp;
    m_max_count = new_max;
  }
  m_p_obj[m_count] = p_o;
  m_count++;
  return 0;
}

int ObjectList::remove(Object* p_o) {
  for (int i = 0; i < m_count; i++) {
    if (m_p_obj[i] == p_o) {
      memmove(&m_p_obj[i], &m_p_obj[i + 1], sizeof(Object*) * (m_count - i - 1));
      m_count--;
      return 0;
    }
  }
  return -1;
}

void ObjectList::clear() {
  m_count = 0;
}

int ObjectList::getCount() const {
  return m_count;
}

bool ObjectList::isEmpty() const {
  return m_count == 0;
}

Object* ObjectList::operator[](int index) const {
  return m_p_obj[index];
}

}  // namespace textbook

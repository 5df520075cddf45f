// Listing 4.39 of the Dragonfly book, with the optional growing array in place of MAX_OBJECTS entries.
#pragma once

namespace textbook {

class Object;

class ObjectList {
 private:
  int m_count;       // Count of objects in list.
  int m_max_count;   // Size of array.
  Object** m_p_obj;  // Array of pointers to objects.

 public:
  ObjectList();
  ObjectList(const ObjectList& other);
  ObjectList& operator=(const ObjectList& other);
  ~ObjectList();

  // Insert object pointer in list. Return 0 if ok, else -1.
  int insert(Object* p_o);
  // Remove object pointer from list. Return 0 if found, else -1.
  int remove(Object* p_o);
  void clear();
  int getCount() const;
  bool isEmpty() const;
  Object* operator[](int index) const;
};

}  // namespace textbook

// The registered interests: for each type of event, the Objects in the order in which they registered.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <unordered_map>
#include <vector>

#include "engine/collision/ObjectKey.h"

namespace df {

class WorldStore;
struct ObjectProfile;

class Interests {
 public:
  explicit Interests(const WorldStore& store) : m_store(store) {}

  /// Registers an interest. Returns 0, or -1 if the Object is not in the world.
  int add(ObjectKey key, ObjectProfile& profile, const std::string& type);
  /// Removes an interest. Returns 0, or -1 if it was not registered.
  int remove(ObjectKey key, ObjectProfile& profile, const std::string& type);
  /// Removes all interests of an Object that leaves the world.
  void removeAll(ObjectProfile& profile);

  /// Calls visit(key) for the Objects that were registered for the type when the call began, in that order.
  /// Objects may register and leave during the call. The key of one that has left finds no Object.
  template <class Visit>
  void visit(const std::string& type, Visit visit) {
    const auto it = m_numbers.find(type);
    if (it == m_numbers.end()) return;
    Table& table = m_tables[it->second];
    const std::size_t count = table.entries.size();
    ++table.walks;
    for (std::size_t i = 0; i < count; ++i) visit(table.entries[i]);
    --table.walks;
    compact(table);
  }

 private:
  struct Table {
    std::vector<ObjectKey> entries;
    std::size_t gone = 0;  // number of entries of Objects that unregistered or left
    int walks = 0;         // visits in progress, during which no entry moves
  };

  void compact(Table& table);

  const WorldStore& m_store;
  std::unordered_map<std::string, std::uint32_t> m_numbers;
  std::deque<Table> m_tables;  // by number; a deque, because handlers may add tables during visit()
};

}  // namespace df

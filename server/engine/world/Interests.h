// The registered interests: for each type of event, the Objects in the order they registered.
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <unordered_map>
#include <vector>

#include "engine/events/Event.h"
#include "engine/world/WorldView.h"

namespace df {

class Object;
class World;

class Interests {
 public:
  explicit Interests(World& world) : m_world(world) {}

  int add(Object& object, const std::string& type);
  int remove(Object& object, const std::string& type);
  /// The Object leaves the world and gets no events any more.
  void dropAll(Object& object);
  /// The Objects that a send reaches.
  enum Audience { kAll, kWhilePaused };
  /// Deliver to all that were registered when the call began and still are at their turn; or only to those
  /// that get events while the game is paused.
  int send(const Event& event, Audience audience = kAll);

 private:
  struct Table {
    std::vector<ObjectKey> entries;
    std::size_t gone = 0;  // entries of Objects that unregistered or left
    int walks = 0;         // sends under way, during which no entry moves
  };

  static bool hearsWhilePaused(const Object* p_object);
  void tidy(Table& table);

  World& m_world;
  std::unordered_map<std::string, std::uint32_t> m_numbers;
  std::deque<Table> m_tables;  // by number; a deque, because handlers may add tables during a send
};

}  // namespace df

#include "engine/world/StateHash.h"

#include "engine/world/Capture.h"
#include "engine/world/Object.h"
#include "engine/world/Views.h"
#include "engine/world/World.h"
#include "engine/world/WorldStore.h"
#include "shared/values/FastHash.h"

namespace df {

namespace {

using naiad::FastHash;

void addNumber(FastHash& hash, std::int64_t number) {
  hash.word(static_cast<std::uint64_t>(number));
}

void addVector(FastHash& hash, FixedVector vector) {
  addNumber(hash, vector.x);
  addNumber(hash, vector.y);
}

void addKey(FastHash& hash, ObjectKey key) {
  hash.word(std::uint64_t{key.slot} << 32 | key.generation);
}

void addObject(FastHash& hash, const WorldStore& store, WorldStore::Slot s) {
  addKey(hash, store.key(s));
  hash.word(store.order(s));
  addVector(hash, store.position(s));
  addVector(hash, store.velocity(s));
  addVector(hash, store.acceleration(s));
  addVector(hash, store.box(s).corner);
  addVector(hash, store.box(s).size);
  // Includes only flags that hosts see. Other flags may depend on whether the world is watched.
  const bool active = store.has(s, WorldStore::kActive);
  const bool visible = store.has(s, WorldStore::kVisible);
  hash.word(static_cast<std::uint64_t>(store.solidness(s)) |
            static_cast<std::uint64_t>(store.altitude(s)) << 8 | std::uint64_t{active} << 16 |
            std::uint64_t{visible} << 17);
  hash.bytes(store.object(s)->getType());
}

void addPlayer(FastHash& hash, const PlayerFacts& player) {
  hash.word(player.id);
  addNumber(hash, player.score);
  addKey(hash, player.followed);
  addVector(hash, player.view_corner);
  for (const PlayerText& text : player.texts) {
    hash.word(text.id);
    addNumber(hash, text.x);
    addNumber(hash, text.y);
    hash.bytes(text.text);
  }
}

void addPicture(FastHash& hash, const WorldView& view) {
  for (const DrawCommand& command : view.commands) {
    addVector(hash, command.position);
    hash.word(std::uint64_t{command.ch} << 8 | static_cast<std::uint64_t>(command.color));
  }
}

}  // namespace

std::uint64_t hashState(const World& world) {
  FastHash hash;
  addNumber(hash, world.getStepCount());
  hash.word(world.isGameOver() ? 1 : 0);
  const WorldStore& store = world.store();
  const WorldStore::Walk walk(store);
  for (std::size_t i = 0; i < walk.size(); ++i) {
    if (walk[i] != WorldStore::kNoSlot) addObject(hash, store, walk[i]);
  }
  for (const auto& [id, p_player] : world.views().players()) addPlayer(hash, p_player->facts());
  addPicture(hash, world.picture().view());
  return hash.value();
}

}  // namespace df

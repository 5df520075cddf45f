// What a client sends while it plays: what arrived, and what its player did. The same bytes on both channels.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "shared/replica/Acks.h"
#include "shared/values/Keyboard.h"

namespace naiad {

/// One key or mouse action. Ids count up from 1 in a session; the server applies each once, in order.
struct Input {
  std::uint32_t id = 0;
  std::uint32_t tick = 0;      ///< of a key: the one that should apply it; of the mouse: the one drawn
  std::uint32_t snapshot = 0;  ///< the newest snapshot applied then
  bool is_mouse = false;
  std::uint8_t action = 0;  ///< df::EventKeyboardAction or df::EventMouseAction
  std::uint8_t key = 0;     ///< df::Keyboard::Key
  std::uint8_t button = 0;  ///< df::Mouse::Button + 1; 0 is none
  std::uint16_t x = 0;      ///< cell of the player's view
  std::uint16_t y = 0;
  friend bool operator==(const Input&, const Input&) = default;
};

struct ClientUpdate {
  AckWindow acks;                         ///< newest 0: nothing arrived yet
  std::optional<std::uint64_t> checksum;  ///< of the replica that has just what `acks` says
  bool wants_reset = false;               ///< the world is beyond repair: send all of it again
  std::vector<Input> inputs;              ///< those that no snapshot has acknowledged, with ids in a row
};

/// Inputs in one update, at most.
inline constexpr std::size_t kMaxUpdateInputs = 48;
/// Bytes of an update, at most.
inline constexpr std::size_t kMaxUpdate = 1024;

/// Encode; of too many inputs the first ones are taken.
std::string writeUpdate(const ClientUpdate& update);

/// Numbers of which the update carries the low bits only are restored near these.
struct UpdateContext {
  std::uint32_t snapshot = 0;  ///< newest sent
  std::uint32_t tick = 0;      ///< newest published
  std::uint32_t input = 0;     ///< newest received
};
/// Decode; nothing if any byte is malformed or any number out of its range.
std::optional<ClientUpdate> readUpdate(std::string_view bytes, const UpdateContext& context);

}  // namespace naiad

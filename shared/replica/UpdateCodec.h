// The message that a client sends while it plays: the snapshots that arrived, and the player's inputs. Its
// bytes are equal on both channels.
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
  std::uint32_t tick = 0;      ///< key: the tick that should apply it; mouse: the tick that was drawn
  std::uint32_t snapshot = 0;  ///< newest snapshot applied when the input was made
  bool is_mouse = false;
  std::uint8_t action = 0;  ///< df::EventKeyboardAction or df::EventMouseAction
  std::uint8_t key = 0;     ///< df::Keyboard::Key
  std::uint8_t button = 0;  ///< df::Mouse::Button + 1; 0: no button
  std::uint16_t x = 0;      ///< cell of the player's view
  std::uint16_t y = 0;
  friend bool operator==(const Input&, const Input&) = default;
};

struct ClientUpdate {
  AckWindow acks;                         ///< newest 0: nothing arrived yet
  std::optional<std::uint64_t> checksum;  ///< checksum of the replica with exactly the snapshots in `acks`
  bool needs_reset = false;   ///< true if the replica is unusable: the server must send the whole world again
  std::vector<Input> inputs;  ///< unacknowledged inputs, with consecutive ids
};

/// Maximum number of inputs in one update.
inline constexpr std::size_t kMaxUpdateInputs = 48;
/// Maximum bytes of an update.
inline constexpr std::size_t kMaxUpdate = 1024;

/// Encodes an update with its first kMaxUpdateInputs inputs.
std::string writeUpdate(const ClientUpdate& update);

/// The newest known numbers. The update has only the low bits of its numbers, which are restored from these.
struct UpdateContext {
  std::uint32_t snapshot = 0;  ///< newest sent snapshot
  std::uint32_t tick = 0;      ///< newest published tick
  std::uint32_t input = 0;     ///< newest received input
};
/// Decodes an update; nullopt if it is malformed, longer than kMaxUpdate, or a number is out of its range.
std::optional<ClientUpdate> readUpdate(std::string_view bytes, const UpdateContext& context);

}  // namespace naiad

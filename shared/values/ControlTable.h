// The table of a player's keys and their effects on the player's Object. A game declares it (Controls.h), the
// server applies it to the Object, and the client applies it in advance to its own copy. Both call the
// functions in Steering.h.
//
// Plain data. Lengths are in fixed point (cells · 2^32), times in ticks.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "Fixed.h"
#include "Keyboard.h"

namespace df {

inline constexpr std::size_t kMaxControlRows = 32;
/// Number of groups of rows that share a wait.
inline constexpr std::size_t kControlGroups = 8;
/// Maximum of `wait` and `patience`, in ticks.
inline constexpr std::uint16_t kMaxControlTicks = 9000;
/// Maximum length of a step in cells, and maximum velocity of an axis in cells per tick.
inline constexpr Fixed kMaxControlReach = fromCells(1024);

/// The effect of a row on the Object.
enum class ControlEffect : std::uint8_t {
  kStep,      ///< one moveObject() by `value`, immediately
  kVelocity,  ///< sets the velocity `value` on the row's axes
  kDrive,     ///< sets the velocity while the key is down; then the Object rests
};

/// The effect of one key.
struct ControlRow {
  Keyboard::Key key = Keyboard::SPACE;
  EventKeyboardAction action = KEY_PRESSED;  ///< the key's action; kDrive: KEY_PRESSED, meaning all three
  ControlEffect effect = ControlEffect::kStep;
  bool x = true;  ///< true if the row affects the x axis (kStep: always both)
  bool y = true;
  FixedVector value;       ///< kStep: distance in cells; else velocity in cells per tick; 0 on other axes
  std::uint16_t wait = 0;  ///< minimum ticks from one effect of the group's rows to the next; 0: none
  std::uint8_t group = 0;

  friend bool operator==(const ControlRow& a, const ControlRow& b) {
    return a.key == b.key && a.action == b.action && a.effect == b.effect && a.x == b.x && a.y == b.y &&
           a.value == b.value && a.wait == b.wait && a.group == b.group;
  }
  friend bool operator!=(const ControlRow& a, const ControlRow& b) { return !(a == b); }
};

struct ControlTable {
  std::vector<ControlRow> rows;
  bool bounded = false;
  FixedBox bounds;             ///< positions, edges included, that keys cannot leave if bounded
  bool whole_cells = false;    ///< a drive ends on the next whole cell, not where the Object is
  std::uint16_t patience = 0;  ///< drives end after this many ticks without a key; 0: never

  friend bool operator==(const ControlTable& a, const ControlTable& b) {
    return a.rows == b.rows && a.bounded == b.bounded && a.bounds == b.bounds &&
           a.whole_cells == b.whole_cells && a.patience == b.patience;
  }
  friend bool operator!=(const ControlTable& a, const ControlTable& b) { return !(a == b); }
};

/// True if every number of the table is in its range, and the fields of each row fit together.
bool isValid(const ControlTable& table);

/// The state of an axis that keys drive.
struct ControlAxis {
  Fixed target_velocity = 0;  ///< velocity that the newest key asks for; 0: no key does
  bool is_released = false;   ///< its key was released: the target_velocity ends with the next tick

  friend bool operator==(const ControlAxis& a, const ControlAxis& b) {
    return a.target_velocity == b.target_velocity && a.is_released == b.is_released;
  }
  friend bool operator!=(const ControlAxis& a, const ControlAxis& b) { return !(a == b); }
};

/// The state of a table between ticks.
struct ControlState {
  bool steering = false;  ///< keys have effects; otherwise they are only recorded
  ControlAxis x;
  ControlAxis y;
  std::uint16_t silence = 0;  ///< ticks since a key was pressed or held, if `patience` is set
  std::array<std::uint16_t, kControlGroups> wait{};  ///< ticks until the group may act again

  friend bool operator==(const ControlState& a, const ControlState& b) {
    return a.steering == b.steering && a.x == b.x && a.y == b.y && a.silence == b.silence && a.wait == b.wait;
  }
  friend bool operator!=(const ControlState& a, const ControlState& b) { return !(a == b); }
};

}  // namespace df

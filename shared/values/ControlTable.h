// How a player's keys move their Object, as data: what a game declares (Controls.h), the server runs on the
// Object, and the client runs ahead of the server's answer on its own copy. Steering.h has the one function
// that both run.
//
// Plain data, lengths in fixed point (cells · 2^32), times in ticks.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "Fixed.h"
#include "Keyboard.h"

namespace df {

inline constexpr std::size_t kMaxControlRows = 32;
/// Groups of rows that wait for each other.
inline constexpr std::size_t kControlGroups = 8;
/// Longest wait between two effects, and longest patience with a silent keyboard, in ticks.
inline constexpr std::uint16_t kMaxControlTicks = 9000;
/// Farthest step, and fastest velocity of an axis, in cells.
inline constexpr Fixed kMaxControlReach = fromCells(1024);

/// What a row does to the Object.
enum class ControlEffect : std::uint8_t {
  kStep,      ///< one moveObject() by `value`, at once
  kVelocity,  ///< from now on this velocity, on the axes that the row names
  kDrive,     ///< this velocity, on those axes, while the key is down; then to rest
};

/// What one key does.
struct ControlRow {
  Keyboard::Key key = Keyboard::SPACE;
  EventKeyboardAction action = KEY_PRESSED;  ///< kDrive: KEY_PRESSED, and stands for all three
  ControlEffect effect = ControlEffect::kStep;
  bool x = true;  ///< the row names the x axis (a step: always both)
  bool y = true;
  FixedVector value;       ///< of a step: how far; else the velocity in cells per tick; 0 on unnamed axes
  std::uint16_t wait = 0;  ///< ticks from one effect to the next of any row of the group; 0 and 1: no wait
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
  FixedBox bounds;             ///< if bounded: positions, edges included, that no key leads out of
  bool whole_cells = false;    ///< what is driven comes to rest on the next whole cell, not where it is
  std::uint16_t patience = 0;  ///< all drives are let go after so many ticks without a key; 0: never

  friend bool operator==(const ControlTable& a, const ControlTable& b) {
    return a.rows == b.rows && a.bounded == b.bounded && a.bounds == b.bounds &&
           a.whole_cells == b.whole_cells && a.patience == b.patience;
  }
  friend bool operator!=(const ControlTable& a, const ControlTable& b) { return !(a == b); }
};

/// Is every number of the table within its range?
bool isValid(const ControlTable& table);

/// One axis that keys drive.
struct ControlLever {
  Fixed pull = 0;       ///< the velocity that the key pulled last asks for; 0: none does
  bool let_go = false;  ///< its key went up: the pull ends with the next tick

  friend bool operator==(const ControlLever& a, const ControlLever& b) {
    return a.pull == b.pull && a.let_go == b.let_go;
  }
  friend bool operator!=(const ControlLever& a, const ControlLever& b) { return !(a == b); }
};

/// What the table has to remember from tick to tick.
struct ControlState {
  bool steering = false;  ///< keys have effects; otherwise they are only remembered
  ControlLever x;
  ControlLever y;
  std::uint16_t silence = 0;                         ///< ticks since the last key, if there is a patience
  std::array<std::uint16_t, kControlGroups> wait{};  ///< ticks until the group may act again

  friend bool operator==(const ControlState& a, const ControlState& b) {
    return a.steering == b.steering && a.x == b.x && a.y == b.y && a.silence == b.silence && a.wait == b.wait;
  }
  friend bool operator!=(const ControlState& a, const ControlState& b) { return !(a == b); }
};

}  // namespace df

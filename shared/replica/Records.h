// The records that the world replicates by. PROTOCOL.md ("Records") gives the bytes.
//
// Every record is absolute (it says what is, never what changed), holds at its snapshot's tick and is
// applied idempotently: for each object and each group the receiver keeps the newest snapshot number it
// applied and ignores older ones. So loss, duplication and reordering are harmless.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "Look.h"
#include "Motion.h"
#include "Solidness.h"

namespace naiad {

/// The groups in which an object's state is replicated; each has its own newest number.
enum Group : std::uint8_t {
  kLife = 1,    ///< born or dead
  kMotion = 2,  ///< where it is and how it moves
  kLook = 4,    ///< what it looks like
  kBody = 8,    ///< its box and solidness
};
inline constexpr std::uint8_t kAllGroups = kLife | kMotion | kLook | kBody;
inline constexpr int kGroupCount = 4;

/// Box, solidness and no-soft: what prediction needs to know.
struct Body {
  df::FixedBox box;
  df::Solidness solidness = df::HARD;
  bool no_soft = false;
  friend bool operator==(const Body&, const Body&) = default;
};

/// The replicated state of one object. With kLife among the groups it is a birth and carries all groups.
struct ObjectState {
  std::uint64_t order = 0;  ///< creation order: drawn later among equal altitudes
  Motion motion;
  Look look;
  Body body;
  friend bool operator==(const ObjectState&, const ObjectState&) = default;
};

struct ObjectRecord {
  std::uint32_t slot = 0;
  std::uint32_t generation = 0;
  std::uint8_t groups = 0;  ///< which parts of `state` are meant; 0: the object is dead
  ObjectState state;
};

/// The world that views are clamped in and the size of the view.
struct WorldRecord {
  df::FixedBox boundary;
  std::int32_t view_width = 80;
  std::int32_t view_height = 24;
  friend bool operator==(const WorldRecord&, const WorldRecord&) = default;
};

/// Where this client's view is, and whom it follows (generation 0: nobody).
struct ViewRecord {
  df::FixedVector corner;
  std::uint32_t slot = 0;
  std::uint32_t generation = 0;
  friend bool operator==(const ViewRecord&, const ViewRecord&) = default;
};

/// A text this player alone sees, in view cells. Empty: gone.
struct TextRecord {
  std::uint32_t id = 0;
  std::int32_t x = 0;
  std::int32_t y = 0;
  df::Color color = df::COLOR_DEFAULT;
  std::string text;  ///< UTF-8
  friend bool operator==(const TextRecord&, const TextRecord&) = default;
};

/// The decoded records of one snapshot.
struct Records {
  std::vector<WorldRecord> worlds;  ///< at most one is sent
  std::vector<ViewRecord> views;    ///< at most one is sent
  std::vector<TextRecord> texts;
  std::vector<ObjectRecord> objects;
};

}  // namespace naiad

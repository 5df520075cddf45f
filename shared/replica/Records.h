// The records that the world replicates by. PROTOCOL.md ("Records") gives the bits.
//
// Every record is absolute (it says what is, never what changed), holds at its snapshot's tick and is
// applied idempotently: for each object and each group the receiver keeps the newest snapshot number it
// applied and ignores older ones. So loss, duplication and reordering are harmless.
//
// Objects are named by ids that are the client's own: small, and given to another object only when the
// client has confirmed the death of the one before.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "shared/replica/ControlCodec.h"
#include "shared/replica/Look.h"
#include "shared/replica/Motion.h"
#include "shared/values/Solidness.h"

namespace naiad {

/// The groups in which an object's state is replicated; each has its own newest number.
enum Group : std::uint8_t {
  kLife = 1,    ///< born or dead
  kMotion = 2,  ///< where it is and how it moves
  kLook = 4,    ///< what it looks like
  kBody = 8,    ///< its box and solidness
};
inline constexpr std::uint8_t kAllGroups = kLife | kMotion | kLook | kBody;
inline constexpr std::uint8_t kDeath = 0;  ///< the groups of a record of an object that is dead
inline constexpr int kGroupCount = 4;

/// Box, solidness and no-soft: what prediction needs to know. The default is a single hard character. What is
/// on the view is spectral, and its position is counted from the view's corner, wherever that is.
struct Body {
  df::FixedBox box{{-df::kFixedOne / 2, -df::kFixedOne / 2}, {df::kFixedOne, df::kFixedOne}};
  df::Solidness solidness = df::HARD;
  bool no_soft = false;
  bool on_view = false;
  friend bool operator==(const Body&, const Body&) = default;
};

/// The replicated state of one object. With kLife among the groups it is a birth and carries all groups.
struct ObjectState {
  std::uint64_t order = 0;  ///< creation order: drawn later among equal altitudes; below 2^48
  Motion motion;
  Look look;
  Body body;
  friend bool operator==(const ObjectState&, const ObjectState&) = default;
};

struct ObjectRecord {
  std::uint32_t id = 0;
  std::uint8_t generation = 0;  ///< of a birth: 1, 2, 3, 1 … for one object after the other under this id
  std::uint8_t groups = 0;      ///< which parts of `state` are meant; kDeath: the object is dead
  ObjectState state;
};

/// The world that views are clamped in, the size of the view, and what is behind all characters.
struct WorldRecord {
  df::FixedBox boundary;
  std::int32_t view_width = 80;
  std::int32_t view_height = 24;
  df::Color background = df::BLACK;
  friend bool operator==(const WorldRecord&, const WorldRecord&) = default;
};

/// Where this client's view is, and which object it follows.
struct ViewRecord {
  df::FixedVector corner;
  bool follows = false;         ///< else `id` and `generation` are 0
  std::uint32_t id = 0;         ///< of the followed object
  std::uint8_t generation = 0;  ///< as in its birth
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

/// What positions and orders are counted from, so that near ones are short. A snapshot names the origin it
/// uses by slot; the sender names only what the client has confirmed.
struct Origin {
  CellPosition corner;      ///< upper left corner of the window
  std::int32_t x_bits = 0;  ///< the window is 2^x_bits cells wide, 0 … 15
  std::int32_t y_bits = 0;
  std::uint64_t order = 0;  ///< below 2^48
  friend bool operator==(const Origin&, const Origin&) = default;
};
inline constexpr std::uint32_t kOriginSlots = 3;  ///< slots 1 … 3; slot 0 is Origin{} for ever
struct OriginRecord {
  std::uint32_t slot = 1;
  Origin origin;
  friend bool operator==(const OriginRecord&, const OriginRecord&) = default;
};

/// A sequence that later looks may name by `id`; it came with a look of the same snapshot.
struct SequenceRecord {
  std::uint32_t id = 0;
  Sequence sequence;
  friend bool operator==(const SequenceRecord&, const SequenceRecord&) = default;
};

/// The decoded records of one snapshot.
struct Records {
  std::vector<WorldRecord> worlds;  ///< at most one is sent
  std::vector<ViewRecord> views;    ///< at most one is sent
  std::vector<OriginRecord> origins;
  std::vector<TextRecord> texts;
  std::vector<df::ControlTable> tables;  ///< the player's own controls; at most one is sent
  std::vector<ControlRecord> controls;   ///< and what they steer; at most one is sent
  std::vector<SequenceRecord> sequences;
  std::vector<ObjectRecord> objects;  ///< by ascending id
};

}  // namespace naiad

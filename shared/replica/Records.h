// The records that replicate the world. PROTOCOL.md ("Records") describes their bits.
//
// Every record is absolute: it gives a state, not a change, and holds at its snapshot's tick. The receiver
// keeps, for each object and each group, the newest snapshot number that it applied, and ignores older
// records. So loss, duplication and reordering are harmless.
//
// Each client has its own ids for objects. They are small, and an id is reused only after the client has
// confirmed the death of its object.
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
  kMotion = 2,  ///< position and movement
  kLook = 4,    ///< look
  kBody = 8,    ///< box and solidness
};
inline constexpr std::uint8_t kAllGroups = kLife | kMotion | kLook | kBody;
inline constexpr std::uint8_t kDeath = 0;  ///< value of `groups` if the object is dead
inline constexpr int kGroupCount = 4;

/// Box, solidness and no-soft, which prediction needs. The default is a single hard character. Objects on the
/// view are spectral, and their positions are relative to the view's corner.
struct Body {
  df::FixedBox box{{-df::kFixedOne / 2, -df::kFixedOne / 2}, {df::kFixedOne, df::kFixedOne}};
  df::Solidness solidness = df::HARD;
  bool no_soft = false;
  bool on_view = false;
  friend bool operator==(const Body&, const Body&) = default;
};

/// The replicated state of an object. A record with kLife is a birth and has all groups.
struct ObjectState {
  std::uint64_t order = 0;  ///< creation order, which decides the drawing order at equal altitude; below 2^48
  Motion motion;
  Look look;
  Body body;
  friend bool operator==(const ObjectState&, const ObjectState&) = default;
};

struct ObjectRecord {
  std::uint32_t id = 0;
  std::uint8_t generation = 0;  ///< set in a birth: 1, 2, 3, 1 … for successive objects
  std::uint8_t groups = 0;      ///< valid parts of `state`; kDeath: the object is dead
  ObjectState state;
};

/// The boundary of views, the size of the view, and the colour behind all characters.
struct WorldRecord {
  df::FixedBox boundary;
  std::int32_t view_width = 80;
  std::int32_t view_height = 24;
  df::Color background = df::BLACK;
  friend bool operator==(const WorldRecord&, const WorldRecord&) = default;
};

/// The position of this client's view, and the object that it follows.
struct ViewRecord {
  df::FixedVector corner;
  bool follows = false;         ///< false: `id` and `generation` are 0
  std::uint32_t id = 0;         ///< the followed object
  std::uint8_t generation = 0;  ///< generation of the followed object, as in its birth
  friend bool operator==(const ViewRecord&, const ViewRecord&) = default;
};

/// A text that only this player sees, in view cells. An empty text removes it.
struct TextRecord {
  std::uint32_t id = 0;
  std::int32_t x = 0;
  std::int32_t y = 0;
  df::Color color = df::COLOR_DEFAULT;
  std::string text;  ///< UTF-8
  friend bool operator==(const TextRecord&, const TextRecord&) = default;
};

/// Positions and orders are encoded relative to an origin, so that near ones are short. A snapshot gives the
/// slot of its origin; the sender uses only slots that the client has confirmed.
struct Origin {
  CellPosition corner;      ///< upper left corner of the window
  std::int32_t x_bits = 0;  ///< the window is 2^x_bits cells wide, 0 … 15
  std::int32_t y_bits = 0;
  std::uint64_t order = 0;  ///< below 2^48
  friend bool operator==(const Origin&, const Origin&) = default;
};
inline constexpr std::uint32_t kOriginSlots = 3;  ///< slots 1 … 3; slot 0 is always Origin{}
struct OriginRecord {
  std::uint32_t slot = 1;
  Origin origin;
  friend bool operator==(const OriginRecord&, const OriginRecord&) = default;
};

/// A sequence that later looks may refer to by `id`. Its first look is in the snapshot that defines it.
struct SequenceRecord {
  std::uint32_t id = 0;
  Sequence sequence;
  friend bool operator==(const SequenceRecord&, const SequenceRecord&) = default;
};

struct Records {
  std::vector<WorldRecord> worlds;  ///< at most one is sent
  std::vector<ViewRecord> views;    ///< at most one is sent
  std::vector<OriginRecord> origins;
  std::vector<TextRecord> texts;
  std::vector<df::ControlTable> tables;  ///< the player's control table; at most one is sent
  std::vector<ControlRecord> controls;   ///< the state of the steered object; at most one is sent
  std::vector<SequenceRecord> sequences;
  std::vector<ObjectRecord> objects;  ///< objects by ascending id
};

}  // namespace naiad

// The state of a world's Objects that every tick uses: arrays by slot, behind handles with generations.
//
// An Object owns one slot from construction to destruction. In between it may be "in the world". Entering the
// world puts it last in the creation order. Leaving it, or being destroyed, ends its generation, so that old
// handles find no Object. A freed slot is not reused for some time, so that clients know of the deletion
// before another Object has the slot.
//
// All changes of an Object's state go through the setters here, which keep the grid of solid boxes and the
// list of changes up to date. Arguments must be in range; Object checks the arguments of games.
//
// The world, each Object, each list and each Ref hold a reference to the store, so it may outlive the world.
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "engine/collision/Grid.h"
#include "engine/collision/Mask.h"
#include "engine/collision/MoverStats.h"
#include "engine/world/ObjectProfile.h"
#include "engine/world/WorldView.h"
#include "shared/values/Fixed.h"
#include "shared/values/Solidness.h"

namespace df {

class Object;
class World;

/// The flags of an Object in its world's store.
struct ObjectFlags {
  /// False in an engine built without the options beyond the book: their setters then have no effect.
#if defined(NAIAD_WITHOUT_LAYERS)
  static constexpr bool kLayers = false;
#else
  static constexpr bool kLayers = true;
#endif
  enum Flag : std::uint32_t {
    kInWorld = 1 << 0,
    kActive = 1 << 1,
    kVisible = 1 << 2,
    kNoSoft = 1 << 3,
    kHeap = 1 << 4,        ///< made with `new`: the world deletes it
    kMarked = 1 << 5,      ///< marked to be deleted after update
    kLookCached = 1 << 6,  ///< the static look has been drawn and is repeated
    kDirty = 1 << 7,       ///< the Object is in the list of changes (m_dirty)
    kReported = 1 << 8,    ///< the host knows the Object's state
    kDerive = 1 << 9,      ///< speed and direction are derived from the velocity
    kStaticLook = 1 << 10,
    kNeverDraws = 1 << 11,      ///< the dynamic type is Object itself
    kClassified = 1 << 12,      ///< kNeverDraws and kNoEventHandler are known
    kFollowed = 1 << 13,        ///< a view follows the Object
    kNoEventHandler = 1 << 14,  ///< the class does not override eventHandler()
    kSwept = 1 << 15,
    kPrecise = 1 << 16,
    kRestContacts = 1 << 17,
    kMayMoveOut = 1 << 18,
    kBody = 1 << 19,     ///< moved by a layer, not by the book's rules
    kPainted = 1 << 24,  ///< has a sprite or a shape, which Object::draw() shows
    kOnView = 1 << 25,   ///< a view object: drawn wherever its position is
    kFrames = 1 << 28,   ///< has frames (setFrames())
  };
};

/// Properties of Objects that update() tests, with one bit for each entry of the creation order: entry i has
/// bit i % 64 of word i / 64, so that 64 Objects are tested at a time.
struct UpdateMasks {
  using Words = std::vector<std::uint64_t>;

  Words turns;        ///< moves in update(): active, no body, with velocity, acceleration or contacts at rest
  Words fliers;       ///< turns of SPECTRAL Objects that only add their velocity
  Words walkers;      ///< turns of solid Objects that use only the book's test, at the end of a move
  Words consecutive;  ///< the entry's slot follows the slot of the entry before it
  Words blocked;      ///< the last move in update() did not happen
  Words handlers;     ///< solid, active, and the class overrides eventHandler(): gets collision events
  Words hards;        ///< active and HARD
  Words softs;        ///< active and SOFT

  static bool get(const Words& words, std::size_t i) { return (words[i / 64] >> (i % 64) & 1) != 0; }
  static void set(Words& words, std::size_t i, bool on) {
    const std::uint64_t bit = std::uint64_t{1} << (i % 64);
    std::uint64_t& word = words[i / 64];
    word = on ? word | bit : word & ~bit;
  }
  /// Makes room for entry i, the last one.
  void grow(std::size_t i) {
    if (i % 64 != 0) return;
    for (Words* p_words : {&turns, &fliers, &walkers, &consecutive, &blocked, &handlers, &hards, &softs})
      p_words->resize(i / 64 + 1);
  }
  /// Clears the bits of entry i, now a gap. Its bit in `consecutive` stays; it means nothing without a turn.
  void clear(std::size_t i) {
    for (Words* p_words : {&turns, &fliers, &walkers, &blocked, &handlers, &hards, &softs})
      set(*p_words, i, false);
  }
};

/// Returns the mask of the sprite's present frame, if the frame is drawn where the Object's box is; else
/// null. Defined in Object's files, because the store does not include Object.h.
const Mask* spriteMaskOf(const Object& object);

class WorldStore : public ObjectFlags {
 public:
  using Slot = std::uint32_t;
  static constexpr Slot kNoSlot = UINT32_MAX;
  /// Number of updates before a freed slot is reused: two seconds, longer than any playable round trip.
  static constexpr std::uint64_t kSlotReuseDelay = 64;

  explicit WorldStore(World* p_world) : m_p_world(p_world) {}
  WorldStore(const WorldStore&) = delete;
  WorldStore& operator=(const WorldStore&) = delete;
  void retain() { ++m_references; }
  void release() {
    assert(m_references > 0);
    if (--m_references == 0) delete this;
  }
  /// Returns the world; null once it has been destroyed.
  World* world() const { return m_p_world; }
  void detachWorld() { m_p_world = nullptr; }

  // Slots.

  /// Allocates a slot with an Object's default state, not in the world yet.
  Slot allocateSlot(Object* p_o, bool heap);
  /// Frees the slot of a destroyed Object, which must have left the world. The slot is not reused for
  /// kSlotReuseDelay updates.
  void freeSlot(Slot s);
  /// Counts an update. Call once in each.
  void age() { ++m_updates; }
  /// Adds the slot to the world, last in creation order.
  void enter(Slot s);
  /// Returns the Objects that have entered since the last call.
  std::vector<ObjectKey> popNewObjects() { return std::exchange(m_new_objects, {}); }
  /// Removes the slot from the world.
  void leave(Slot s);

  // Reading.

  ObjectKey key(Slot s) const { return {s, m_cards[s].generation}; }
  bool isCurrent(ObjectKey k) const {
    return k.slot < m_cards.size() && m_cards[k.slot].generation == k.generation;
  }
  /// Like isCurrent(), without the bounds check. `k` must have been current in this store at some time.
  bool isCurrentUnchecked(ObjectKey k) const { return m_cards[k.slot].generation == k.generation; }
  Object* find(ObjectKey k) const { return isCurrent(k) ? m_cards[k.slot].p_object : nullptr; }
  Object* object(Slot s) const { return m_cards[s].p_object; }
  /// The reference stays valid until the slot is freed.
  ObjectProfile& profile(Slot s) { return m_profiles[s]; }
  FixedVector position(Slot s) const { return m_positions[s]; }
  /// Prefetches the slot's position and card.
  void prefetch(Slot s) const {
    __builtin_prefetch(&m_positions[s]);
    __builtin_prefetch(&m_cards[s]);
  }
  FixedVector velocity(Slot s) const { return m_velocities[s]; }
  FixedVector acceleration(Slot s) const { return m_accelerations[s]; }
  FixedBox box(Slot s) const { return m_boxes[s]; }
  FixedBox worldBox(Slot s, FixedVector at) const { return translate(m_boxes[s], at); }
  Solidness solidness(Slot s) const { return m_cards[s].solidness; }
  /// Returns the Object's mask or, if it has none, the mask of its sprite's frame; null: the whole box.
  const Mask* mask(Slot s) const {
    const auto it = m_masks.find(s);
    if (it != m_masks.end()) return &it->second;
    return has(s, kPainted) ? spriteMask(s) : nullptr;
  }
  /// Returns the frames and their selector; null if the Object has no frames.
  const std::shared_ptr<const naiad::Look>& frames(Slot s) const;
  int altitude(Slot s) const { return m_cards[s].altitude; }
  std::uint64_t order(Slot s) const { return m_cards[s].order; }
  /// Returns the highest place in the creation order so far; 0 if no Object has entered.
  std::uint64_t lastOrder() const { return m_next_order - 1; }
  std::uint32_t flags(Slot s) const { return m_cards[s].flags; }
  bool has(Slot s, Flag flag) const { return (m_cards[s].flags & flag) != 0; }
  bool collides(Slot s) const {
    return (m_cards[s].flags & (kInWorld | kActive)) == (kInWorld | kActive) &&
           m_cards[s].solidness != SPECTRAL;
  }
  /// True if the Object's last move in update() did not happen.
  bool isBlocked(Slot s) const { return UpdateMasks::get(m_bits.blocked, m_cards[s].index); }
  /// True if the Object gets events: it is in the world, active, and its class overrides eventHandler().
  bool handlesEvents(Slot s) const {
    return (m_cards[s].flags & (kInWorld | kActive | kNoEventHandler)) == (kInWorld | kActive);
  }
  int countInWorld() const { return m_in_world; }

  // Changing.

  void setPosition(Slot s, FixedVector position);
  void setVelocity(Slot s, FixedVector velocity);
  void setAcceleration(Slot s, FixedVector acceleration);
  void setBox(Slot s, FixedBox box);
  /// True if there ever was a box that does not contain its Object's position. If false, an Object whose
  /// position is inside an area has a part of its box there, too.
  bool hasBoxesOffPosition() const { return m_boxes_off; }
  void setSolidness(Slot s, Solidness solidness);
  /// True if any Object was SOFT since the world was made.
  bool hasHadSoft() const { return m_has_had_soft; }
  void setAltitude(Slot s, int altitude);
  /// Sets the mask; nullopt: the whole box.
  void setMask(Slot s, std::optional<Mask> mask);
  /// Sets the frames; null: none.
  void setFrames(Slot s, std::shared_ptr<const naiad::Look> p_look);
  /// Ends an Object's turn in update(): sets its velocity, and whether its move was blocked.
  void settle(Slot s, FixedVector velocity, bool blocked) {
    if (velocity != m_velocities[s] || blocked != isBlocked(s)) settleChanged(s, velocity, blocked);
  }
  /// Sets kDerive, which is not a change for hosts.
  void setDerived(Slot s, bool on) {
    const std::uint32_t others = m_cards[s].flags & ~static_cast<std::uint32_t>(kDerive);
    m_cards[s].flags = others | (on ? kDerive : 0u);
  }
  /// Sets a flag. Flags that hosts see (active, visible, no-soft) are reported as changes.
  void set(Slot s, Flag flag, bool on);

  /// True if this is a valid position, or a valid velocity.
  static bool isPosition(FixedVector p) { return within(p, kMaxCells); }
  static bool isVelocity(FixedVector v) { return within(v, kMaxVelocityCells); }

  // Walking.

  /// The creation order at the time of the constructor: entries [0, size()), which can be read while Objects
  /// enter and leave. Those that enter are appended behind size(); one that leaves becomes a gap, kNoSlot.
  class Walk {
   public:
    explicit Walk(const WorldStore& store) : m_store(store), m_size(store.m_order_list.size()) {
      ++store.m_walks;
    }
    ~Walk() { --m_store.m_walks; }
    Walk(const Walk&) = delete;
    Walk& operator=(const Walk&) = delete;
    std::size_t size() const { return m_size; }
    Slot operator[](std::size_t i) const { return m_store.m_order_list[i]; }

   private:
    const WorldStore& m_store;
    std::size_t m_size;
  };

  /// Returns entry i of the creation order; kNoSlot for a gap.
  Slot entry(std::size_t i) const { return m_order_list[i]; }
  const UpdateMasks& updateMasks() const { return m_bits; }
  /// Sets whether the moves of all Objects are swept, or only those of Objects with kSwept.
  void setAllSwept(bool all_swept);
  bool isAllSwept() const { return m_all_swept; }

  // The options beyond the book; false in an engine built without them (kLayers).

  bool isSwept(Slot s) const { return kLayers && (m_all_swept || has(s, kSwept)); }
  bool testsAtRest(Slot s) const { return kLayers && has(s, kRestContacts); }
  bool mayMoveOut(Slot s) const { return kLayers && has(s, kMayMoveOut); }
  /// True if any Object is precise.
  bool hasPrecise() const { return kLayers && m_precise > 0; }

  /// Moves up to `count` fliers (UpdateMasks) in consecutive slots from `first` on by their velocities. Stops
  /// at the first that would leave `boundary`. Returns how many were moved.
  std::size_t fly(Slot first, std::size_t count, const FixedBox& boundary);
  /// Takes the turns of walkers, entry 64 * word + i of the creation order for each bit i of `walkers`,
  /// lowest first. Stops at a walker that would leave `boundary`, or touch Objects, unless these are many and
  /// touchingTarget() could decide the move without listing them. Returns the bits from this walker on; 0 if
  /// none stopped. `met` lists the Objects that the walker would touch, in order; none if it would leave.
  std::uint64_t walk(std::size_t word, std::uint64_t walkers, const FixedBox& boundary,
                     std::vector<ObjectKey>& met);

  /// Removes the gaps from the order, if they are many and no Walk exists. leave() calls this; call it when a
  /// Walk has ended.
  void closeGaps();

  /// Appends the solid Objects whose boxes touch `box`, except `self`, to `out` in creation order.
  void touching(const FixedBox& box, Slot self, std::vector<ObjectKey>& out) const;
  /// Like touching(), for the target of a move; returns nullopt. But if there are many such Objects, neither
  /// the mover nor any of them has a handler, no Object is precise and the mover has no kMayMoveOut, lists
  /// none and returns whether the move happens.
  std::optional<bool> touchingTarget(Slot mover, const FixedBox& target, std::vector<ObjectKey>& out) const;
  const Grid& grid() const { return m_grid; }
  /// Returns the counters of moves so far.
  MoverStats& moverStats() { return m_grid.moverStats(); }

  // Changes, for hosts.

  /// Starts or stops recording changes, beginning with all Objects, and filling the WorldView in every tick.
  /// In an unwatched world, only the drawn characters are recorded.
  void setWatched(bool watched);
  bool isWatched() const { return m_watched; }
  /// Moves the changes since the last call into `view`.
  void report(WorldView& view);
  ObjectFacts facts(Slot s) const;

 private:
  struct Freed {
    Slot slot;
    std::uint64_t since;  ///< m_updates when it was freed
  };

  // The state that a collision reads of the other Object, in half a cache line.
  struct alignas(32) Card {
    Object* p_object = nullptr;
    std::uint64_t order = 0;  ///< place in creation order, never reused
    std::uint32_t generation = 1;
    std::uint32_t flags = 0;
    std::uint32_t index = 0;  ///< index in m_order_list
    Solidness solidness : 8 = HARD;
    std::uint8_t altitude = 0;
  };
  static_assert(sizeof(Card) == 32);

  ~WorldStore() { assert(m_p_world == nullptr); }  // the world has a reference until it is destroyed
  static bool within(FixedVector v, double cells) {
    const auto limit = static_cast<Fixed>(cells * static_cast<double>(kFixedOne));
    return v.x >= -limit && v.x <= limit && v.y >= -limit && v.y <= limit;
  }
  void touch(Slot s) {
    if (m_watched) flagChanged(s);
  }
  void flagChanged(Slot s);
  void settleChanged(Slot s, FixedVector velocity, bool blocked);
  void file(Slot s);
  void classify(Slot s);
  const Mask* spriteMask(Slot s) const;
  static void mark(UpdateMasks::Words& row, int& count, std::size_t index, bool on);
  void markSolid(Slot s);
  void unmark(std::size_t index);
  std::size_t crowdThreshold() const;
  bool isAnyAt(const UpdateMasks::Words& row, const FixedBox& box, Slot self) const;
  bool isBlockedAt(const FixedBox& target, Slot mover, std::span<const Slot> some) const;
  std::optional<bool> moveWithoutHandlers(Slot mover, const FixedBox& target,
                                          std::span<const Slot> some) const;
  void list(std::span<const Slot> found, std::vector<ObjectKey>& out) const;
  void listMany(std::span<const Slot> found, std::vector<ObjectKey>& out) const;

  World* m_p_world;
  std::uint32_t m_references = 1;

  std::vector<FixedVector> m_positions;
  std::vector<FixedVector> m_velocities;
  std::vector<FixedVector> m_accelerations;
  std::vector<FixedBox> m_boxes;
  std::vector<Card> m_cards;
  std::deque<ObjectProfile> m_profiles;

  Grid m_grid{m_positions, m_boxes};  // all boxes that collide
  std::deque<Freed> m_free;           // slots to reuse, longest free first
  std::uint64_t m_updates = 0;
  std::vector<Slot> m_order_list;  // slots in the world by creation order, with gaps
  UpdateMasks m_bits;
  std::size_t m_gaps = 0;
  mutable int m_walks = 0;  // number of Walks; while there are any, gaps stay
  int m_in_world = 0;
  std::uint64_t m_next_order = 1;
  std::vector<ObjectKey> m_new_objects;

  bool m_watched = false;
  std::vector<Slot> m_dirty;
  std::vector<ObjectKey> m_vanished;
  std::unordered_map<Slot, Mask> m_masks;  // masks set by setMask(); few Objects have one
  std::unordered_map<Slot, std::shared_ptr<const naiad::Look>> m_frames;
  bool m_all_swept = false;
  bool m_boxes_off = false;  // see hasBoxesOffPosition()
  int m_precise = 0;         // number of precise Objects
  int m_handlers = 0;        // numbers of bits set in UpdateMasks::handlers, hards and softs
  int m_hards = 0;
  int m_softs = 0;
  mutable std::vector<Slot> m_candidates;  // scratch of touching()
  bool m_has_had_soft = false;
};

}  // namespace df

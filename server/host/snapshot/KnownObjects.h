// The objects that one client knows, and the groups of each that are pending for it.
//
// An object that becomes interesting gets the lowest free id of this client. Its whole birth is pending until
// a birth was acknowledged; after that, only changed groups are. When it vanishes or loses interest, its
// death is pending; its id is free again once the client has acknowledged the death. A group that a snapshot
// carries is no longer pending. If that snapshot is lost, the group is pending again, in its newest state.
#pragma once

#include <array>
#include <cstdint>
#include <queue>
#include <vector>

#include "host/snapshot/Publisher.h"
#include "host/snapshot/SlotMap.h"

namespace naiad {

class KnownObjects {
 public:
  enum class Life : std::uint8_t { kFree, kBorn, kAlive, kDying };
  /// The data that every tick reads. It is small, because it is not cached at the client's next tick.
  struct Known {
    std::uint32_t slot = 0;
    std::uint32_t generation = 0;  ///< generation of the object in the world's slot
    std::uint32_t birth = 0;       ///< number of objects that have had this id
    Life life = Life::kFree;
    std::uint8_t pending = 0;         ///< pending groups; if `life` is kDying, kLife means the death
    std::uint8_t unconfirmed = 0;     ///< groups whose newest content is not known to have arrived
    bool queued = false;              ///< true if the id is in pendingIds()
    std::uint32_t pending_since = 0;  ///< tick since which groups are pending
  };
  /// The part of one object that a snapshot carried.
  struct Sent {
    std::uint32_t id = 0;
    std::uint32_t birth = 0;
    std::uint8_t groups = 0;  ///< groups that were sent; kDeath for a death
  };
  static constexpr std::uint32_t kNone = SlotMap::kNone;
  /// Generation of the id, as births carry it. Never 0, because elsewhere 0 means that there is no object.
  static std::uint8_t generationOf(const Known& known) {
    return static_cast<std::uint8_t>(known.birth % 3 + 1);
  }

  /// Returns the id of the object in `slot` if its state is kBorn or kAlive; otherwise kNone.
  std::uint32_t find(std::uint32_t slot) const { return m_ids.find(slot); }
  const Known& at(std::uint32_t id) const { return m_known[id]; }
  /// Prefetch the memory that find(slot) or at(id) reads.
  void prefetchSlot(std::uint32_t slot) const { m_ids.prefetch(slot); }
  void prefetch(std::uint32_t id) const { __builtin_prefetch(&m_known[id], 1); }
  std::size_t idCount() const { return m_known.size(); }
  std::size_t aliveCount() const { return m_alive; }

  /// Adds an object unknown to the client; its birth is pending. Returns its id; kNone if none is free.
  std::uint32_t addObject(std::uint32_t slot, std::uint32_t generation, std::uint32_t tick);
  /// Call when groups of a known object have changed.
  void addPending(std::uint32_t id, std::uint8_t groups, std::uint32_t tick);
  /// Call when the object is gone or of no interest. Its death is pending, unless no birth was ever sent.
  void removeObject(std::uint32_t id, std::uint32_t tick);
  /// Makes everything pending again that was sent and is unconfirmed.
  void requeueUnconfirmed(std::uint32_t tick);

  /// Returns the ids with pending groups, unordered, and until trimPending() some ids without any.
  const std::vector<std::uint32_t>& pendingIds() const { return m_pending_ids; }
  /// Returns the groups to write for an id: kDeath, kAllGroups for a birth, or the pending ones.
  std::uint8_t groupsToSend(std::uint32_t id) const;
  /// Call after the groups of groupsToSend() were written into `snapshot` of `tick`. Unless they are a death,
  /// their contents are those of `state`, but with `motion` (as of `tick`) as the motion.
  Sent markSent(std::uint32_t id, std::uint32_t snapshot, const ObjectState& state, const Motion& motion,
                std::uint32_t tick);
  void trimPending();

  void confirmArrival(const Sent& sent, std::uint32_t snapshot);
  /// Call when the snapshot was lost. Returns whether anything is pending again because of it.
  bool requeueLost(const Sent& sent, std::uint32_t snapshot, std::uint32_t tick);

  /// Returns the checksum of the client's replica after it has received everything sent.
  std::uint64_t checksum() const { return m_checksum; }

  /// Calls `visit(id, known)` for all objects in the states kBorn and kAlive.
  template <class Visit>
  void forEachAlive(Visit visit) const {
    for (std::uint32_t id = 0; id < m_known.size(); ++id) {
      if (m_known[id].life == Life::kBorn || m_known[id].life == Life::kAlive) visit(id, m_known[id]);
    }
  }

 private:
  /// Known, and a record of the groups that were sent, in one cache line. Snapshot numbers are stored as
  /// brief(), which suffices because at most InFlightSnapshots::kMaxSnapshots are in flight.
  struct alignas(64) KnownObject : Known {
    std::array<std::uint16_t, kGroupCount> sent{};  ///< newest snapshot that carried the group; 0: none
    std::array<std::uint8_t, kGroupCount>
        since_first{};  ///< number of snapshots from the first one with this content to `sent`
    std::array<std::uint64_t, kGroupCount> sums{};  ///< checksums of the groups' contents
  };
  static_assert(sizeof(KnownObject) == 64);
  static constexpr std::uint32_t kBriefs = 0xFFFF;
  static std::uint16_t brief(std::uint32_t snapshot) {
    return static_cast<std::uint16_t>(snapshot % kBriefs + 1);
  }
  /// Number of snapshots from `a` to `b`.
  static std::uint32_t before(std::uint16_t a, std::uint16_t b) { return (b + kBriefs - a) % kBriefs; }

  void queueId(std::uint32_t id, std::uint32_t tick);
  void releaseId(std::uint32_t id);
  void recordSum(KnownObject& entry, std::size_t group, std::uint32_t snapshot, std::uint64_t sum);

  std::vector<KnownObject> m_known;  ///< indexed by id
  SlotMap m_ids;
  std::priority_queue<std::uint32_t, std::vector<std::uint32_t>, std::greater<>> m_free;
  std::vector<std::uint32_t> m_pending_ids;
  std::size_t m_alive = 0;
  std::uint64_t m_checksum = 0;
};

}  // namespace naiad

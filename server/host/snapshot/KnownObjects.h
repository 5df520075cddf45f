// The objects that one client knows, and the groups of each that are pending for it.
//
// An object that becomes interesting gets the lowest free id of this client. It is pending as a whole birth
// until a birth was acknowledged; after that, only the groups that change are. When it vanishes or loses
// interest, its death is pending, and the id is free again when the client has acknowledged the death. A
// group that a snapshot carries is not pending any more. If that snapshot turns out to be lost, the group is
// pending again, in its newest state.
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
  /// What every tick reads. It is small, since it has left the cache by the client's next turn.
  struct Known {
    std::uint32_t slot = 0;
    std::uint32_t generation = 0;  ///< of the world's slot
    std::uint32_t birth = 0;       ///< how many objects have had this id
    Life life = Life::kFree;
    std::uint8_t pending = 0;  ///< groups; when dying, kLife is the death
    std::uint8_t unconfirmed =
        0;                ///< groups whose newest content no arrived snapshot carried, as far as known
    bool queued = false;  ///< among pendingIds()
    std::uint32_t pending_since = 0;  ///< tick
  };
  /// One object's part of a snapshot.
  struct Sent {
    std::uint32_t id = 0;
    std::uint32_t birth = 0;
    std::uint8_t groups = 0;  ///< kDeath: the death
  };
  static constexpr std::uint32_t kNone = SlotMap::kNone;
  /// As births carry it: never 0, which elsewhere means no object.
  static std::uint8_t generationOf(const Known& known) {
    return static_cast<std::uint8_t>(known.birth % 3 + 1);
  }

  /// The id of the object in `slot`, whose birth was sent or is pending; kNone if there is none.
  std::uint32_t find(std::uint32_t slot) const { return m_ids.find(slot); }
  const Known& at(std::uint32_t id) const { return m_known[id]; }
  /// Have the memory of find(slot) fetched, or of what is known of `id`. Both change nothing.
  void prefetchSlot(std::uint32_t slot) const { m_ids.prefetch(slot); }
  void prefetch(std::uint32_t id) const { __builtin_prefetch(&m_known[id], 1); }
  std::size_t idCount() const { return m_known.size(); }
  std::size_t aliveCount() const { return m_alive; }

  /// Add an object that the client does not know; its birth is pending. Its id; kNone if no id is left.
  std::uint32_t addObject(std::uint32_t slot, std::uint32_t generation, std::uint32_t tick);
  /// Groups of a known object have changed.
  void addPending(std::uint32_t id, std::uint8_t groups, std::uint32_t tick);
  /// The object is gone or of no interest: its death is pending, unless no birth was ever sent.
  void removeObject(std::uint32_t id, std::uint32_t tick);
  /// All that was sent and is unconfirmed is pending again.
  void requeueUnconfirmed(std::uint32_t tick);

  /// The ids with pending groups, in no order; also some without, until trimPending().
  const std::vector<std::uint32_t>& pendingIds() const { return m_pending_ids; }
  /// The groups to write for an id: kDeath, kAllGroups or some.
  std::uint8_t groupsToSend(std::uint32_t id) const;
  /// groupsToSend() were written into `snapshot`, of `tick`: these of `state`, with `motion` as it is at
  /// `tick`. Neither is read for a death.
  Sent markSent(std::uint32_t id, std::uint32_t snapshot, const ObjectState& state, const Motion& motion,
                std::uint32_t tick);
  void trimPending();

  void confirmArrival(const Sent& sent, std::uint32_t snapshot);
  /// The snapshot was lost. Returns whether anything is pending again because of it.
  bool requeueLost(const Sent& sent, std::uint32_t snapshot, std::uint32_t tick);

  /// The checksum of a client that has received everything that was sent.
  std::uint64_t checksum() const { return m_checksum; }

  /// Call `visit(id, known)` for all that are born or alive.
  template <class Visit>
  void forEachAlive(Visit visit) const {
    for (std::uint32_t id = 0; id < m_known.size(); ++id) {
      if (m_known[id].life == Life::kBorn || m_known[id].life == Life::kAlive) visit(id, m_known[id]);
    }
  }

 private:
  /// With what was sent of it, in one line of the cache. Snapshots have brief() numbers here, which suffice:
  /// at most some hundred are in flight.
  struct alignas(64) Entry : Known {
    std::array<std::uint16_t, kGroupCount> sent{};        ///< newest that carried the group; 0: none
    std::array<std::uint8_t, kGroupCount> since_first{};  ///< from the first that carried the same content
    std::array<std::uint64_t, kGroupCount> sums{};        ///< of the content, for the checksum
  };
  static_assert(sizeof(Entry) == 64);
  static constexpr std::uint32_t kBriefs = 0xFFFF;
  static std::uint16_t brief(std::uint32_t snapshot) {
    return static_cast<std::uint16_t>(snapshot % kBriefs + 1);
  }
  /// By how many snapshots `a` comes before `b`.
  static std::uint32_t before(std::uint16_t a, std::uint16_t b) { return (b + kBriefs - a) % kBriefs; }

  void queueId(std::uint32_t id, std::uint32_t tick);
  void releaseId(std::uint32_t id);
  void recordSum(Entry& entry, std::size_t group, std::uint32_t snapshot, std::uint64_t sum);

  std::vector<Entry> m_known;  ///< by id
  SlotMap m_ids;
  std::priority_queue<std::uint32_t, std::vector<std::uint32_t>, std::greater<>> m_free;
  std::vector<std::uint32_t> m_pending_ids;
  std::size_t m_alive = 0;
  std::uint64_t m_checksum = 0;
};

}  // namespace naiad

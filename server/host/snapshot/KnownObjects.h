// What one client knows of the objects, and what of each it still has to be told.
//
// An object that becomes interesting gets the lowest free id of this client and is owed as a whole birth
// until a birth was acknowledged; after that only the groups that change. When it vanishes or loses interest,
// its death is owed, and the id is free again when the client has acknowledged it. Writing a group into a
// snapshot pays the debt until that snapshot turns out to be lost; then the group is owed again, in its
// newest state.
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
  /// What is looked at in every tick; a client's are cold by then, so that they are small counts.
  struct Known {
    std::uint32_t slot = 0;
    std::uint32_t generation = 0;  ///< of the world's slot
    std::uint32_t birth = 0;       ///< the how-manieth object under this id
    Life life = Life::kFree;
    std::uint8_t owed = 0;  ///< groups; when dying, kLife is the death
    std::uint8_t unconfirmed =
        0;  ///< groups of which no snapshot that carried what was sent last is known to have arrived
    bool queued = false;      ///< among owing()
    std::uint32_t since = 0;  ///< the tick from which on it has owed something
  };
  /// One object's part of a snapshot.
  struct Sent {
    std::uint32_t id = 0;
    std::uint32_t birth = 0;
    std::uint8_t groups = 0;  ///< kDeath: the death
  };
  static constexpr std::uint32_t kNobody = SlotMap::kNone;
  /// As births carry it: never 0, which elsewhere means nobody.
  static std::uint8_t generationOf(const Known& known) {
    return static_cast<std::uint8_t>(known.birth % 3 + 1);
  }

  /// The id under which the client knows, or is about to be told of, the object in `slot`; kNobody if none.
  std::uint32_t find(std::uint32_t slot) const { return m_ids.find(slot); }
  const Known& at(std::uint32_t id) const { return m_known[id]; }
  std::size_t idCount() const { return m_known.size(); }
  std::size_t aliveCount() const { return m_alive; }

  /// Owe the birth of an object that the client does not know. Its id; kNobody if there is none left.
  std::uint32_t learn(std::uint32_t slot, std::uint32_t generation, std::uint32_t tick);
  /// Owe groups of a known one.
  void owe(std::uint32_t id, std::uint8_t groups, std::uint32_t tick);
  /// Owe its death, or nothing if the client never heard of it.
  void forget(std::uint32_t id, std::uint32_t tick);
  /// Owe again all that was sent and is unconfirmed.
  void oweUnconfirmed(std::uint32_t tick);

  /// The ids that owe something, in no order.
  const std::vector<std::uint32_t>& owing() const { return m_owing; }
  /// The groups to write for an id: kDeath, kAllGroups or some.
  std::uint8_t due(std::uint32_t id) const;
  /// They were written into `snapshot`, of `tick`. `state`: what was written (not looked at for a death).
  Sent paid(std::uint32_t id, std::uint32_t snapshot, const ObjectState& state, std::uint32_t tick);
  /// Take those that were paid off the list.
  void sweepOwing();

  void arrived(const Sent& sent, std::uint32_t snapshot);
  /// How many objects owe something again because of it.
  bool lost(const Sent& sent, std::uint32_t snapshot, std::uint32_t tick);

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
  /// And what was sent of it; both in a line of the cache. Snapshots are told apart by their brief() numbers:
  /// in flight are at most some hundred.
  struct alignas(64) Told : Known {
    std::array<std::uint16_t, kGroupCount> sent{};        ///< newest that carried the group; 0: none
    std::array<std::uint8_t, kGroupCount> since_first{};  ///< from the first that carried it as that one did
    std::array<std::uint64_t, kGroupCount> sums{};        ///< of what it carried
  };
  static constexpr std::uint32_t kBriefs = 0xFFFF;
  static std::uint16_t brief(std::uint32_t snapshot) {
    return static_cast<std::uint16_t>(snapshot % kBriefs + 1);
  }
  /// How many snapshots before `b` was `a`?
  static std::uint32_t before(std::uint16_t a, std::uint16_t b) { return (b + kBriefs - a) % kBriefs; }

  void enqueue(std::uint32_t id, std::uint32_t tick);
  void release(std::uint32_t id);
  static_assert(sizeof(Told) == 64);
  void carry(Told& told, std::size_t group, std::uint32_t snapshot, std::uint64_t sum);

  std::vector<Told> m_known;  ///< by id
  SlotMap m_ids;
  std::priority_queue<std::uint32_t, std::vector<std::uint32_t>, std::greater<>> m_free;
  std::vector<std::uint32_t> m_owing;
  std::size_t m_alive = 0;
  std::uint64_t m_checksum = 0;
};

}  // namespace naiad

// What one client still has to be told, and the snapshots that tell it.
//
// The sender owes a client groups of records. Writing a group into a snapshot pays the debt until that
// snapshot turns out to be lost (a gap in the acknowledgements); then the group is owed again, in its newest
// state. An object is owed as a whole birth until a birth was acknowledged, and a slot is not used again for
// a client before it acknowledged the death of the last object in it. Nothing here knows the channel.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "Acks.h"
#include "Publisher.h"
#include "RecordCodec.h"

namespace naiad {

class SnapshotSender {
 public:
  struct Snapshot {
    std::uint32_t number = 0;
    std::uint32_t tick = 0;
    std::string records;
  };

  /// `record_limit`: largest records part of a snapshot, in bytes.
  explicit SnapshotSender(std::size_t record_limit = kMaxSnapshotRecords) : m_record_limit(record_limit) {}

  /// Note one published tick. To be called after every Publisher::update while the client is connected;
  /// the first call owes the client the whole world.
  void note(const Publisher& publisher);

  /// Set what this player sees beside the objects; what differs from before is owed.
  void setPlayer(const df::PlayerFacts& player);

  /// Write what is owed at the publisher's tick, oldest debts first: as many snapshots as it takes, at most
  /// `most`, and none beyond kMaxInFlight unacknowledged. Where nothing is owed or that window is full: one
  /// snapshot every kKeepAlive ticks, else none.
  std::vector<Snapshot> build(const Publisher& publisher, std::size_t most = 64);

  /// The client acknowledged. A number more than kReorder behind the newest one that it never mentions is
  /// taken for lost.
  void acknowledge(const AckWindow& acks);

  /// Something was owed at the last build() that could not be sent, because too much is unacknowledged.
  bool isThrottled() const { return m_throttled; }
  /// Nothing is owed and nothing unacknowledged.
  bool isSettled() const;
  /// Records sent again because a snapshot was lost.
  std::uint64_t resentCount() const { return m_resent; }

  static constexpr std::uint32_t kKeepAlive = 5;
  static constexpr int kReorder = 3;
  /// Snapshots unacknowledged at most; the oldest beyond that is taken for lost.
  static constexpr std::size_t kMaxInFlight = 64;

 private:
  enum class Life : std::uint8_t { kUnknown, kBorn, kAlive, kDying };
  struct Slot {
    std::uint32_t generation = 0;  ///< the object the client was told about
    Life life = Life::kUnknown;
    std::uint8_t owed = 0;                          ///< groups; when dying, kLife is the death
    bool queued = false;                            ///< in m_queue
    std::array<std::uint32_t, kGroupCount> sent{};  ///< newest snapshot that carried the group
  };
  /// Anything that is not an object: owed or sent as a whole.
  struct Single {
    bool owed = false;
    std::uint32_t sent = 0;
  };
  struct SentObject {
    std::uint32_t slot;
    std::uint32_t generation;
    std::uint8_t groups;  ///< 0: the death
  };
  struct InFlight {
    std::uint32_t number = 0;
    std::vector<SentObject> objects;
  };

  Slot& slotAt(std::uint32_t slot);
  void owe(std::uint32_t slot, std::uint8_t groups);
  void follow(std::uint32_t slot, const Publisher::Model* model, std::uint8_t groups);
  const Motion* followedMotion(const Publisher& publisher);
  void checkView(const Publisher& publisher);
  bool payObject(std::uint32_t slot, const Publisher& publisher, RecordWriter& out);
  bool paySingles(const Publisher& publisher, RecordWriter& out);
  bool isOwing() const;
  bool hasRoom(const RecordWriter& out, const RecordWriter& more) const;
  void arrived(const InFlight& snapshot);
  void lost(const InFlight& snapshot);
  Single& single(std::size_t i);
  bool carriesSingle(std::uint32_t number) const;

  std::size_t m_record_limit;
  std::vector<Slot> m_slots;
  Slot m_loose;
  std::deque<std::uint32_t> m_queue;  ///< slots that owe something, oldest debt first
  std::deque<InFlight> m_flight;
  std::uint32_t m_next_number = 1;
  std::uint32_t m_last_tick = 0;  ///< of the last snapshot built
  bool m_began = false;
  bool m_throttled = false;
  std::vector<std::uint32_t> m_freed;  ///< slots whose death was acknowledged since the last build

  Single m_world_debt;
  WorldRecord m_world;
  Single m_view_debt;
  ViewRecord m_view;              ///< as last sent
  std::uint32_t m_view_tick = 0;  ///< the tick at which m_view holds
  df::PlayerFacts m_player;
  std::array<Single, kMaxTexts> m_text_debt;
  std::array<df::PlayerText, kMaxTexts> m_texts;
  std::uint64_t m_resent = 0;
};

}  // namespace naiad

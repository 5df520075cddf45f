// What one client still has to be told, and the snapshots that tell it.
//
// A client is told of what it can see: objects in its view, those that are about to enter it, and whom the
// view follows. KnownObjects keeps what is owed of each, Singles what is owed of all that is no object; this
// class decides whom the client knows, writes what is owed into snapshots, most urgent first, and learns from
// acknowledgements what arrived. Nothing here knows the channel, except that a snapshot may be too large for
// a datagram.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "host/snapshot/AppearanceNames.h"
#include "host/snapshot/ClientViewport.h"
#include "host/snapshot/Flight.h"
#include "host/snapshot/Interest.h"
#include "host/snapshot/KnownObjects.h"
#include "host/snapshot/LossEstimator.h"
#include "host/snapshot/PerClientState.h"
#include "host/snapshot/Publisher.h"
#include "host/snapshot/RedundantResend.h"
#include "shared/replica/Acks.h"
#include "shared/replica/SnapshotCodec.h"

namespace naiad {

/// When records that were not acknowledged are sent again.
enum class Resend {
  kEveryTick,  ///< with every snapshot, until they are
  kOnGap,      ///< when later snapshots are acknowledged and theirs is not
  kAhead,      ///< as kOnGap; what matters most is also repeated before it is known, if the line loses
};

class SnapshotSender {
 public:
  struct Packet {
    std::uint32_t number = 0;
    std::uint32_t tick = 0;
    bool large = false;  ///< exceeds the datagram's limit: for the stream
    std::string bytes;
  };
  /// Those of a tick. Their memory is used again when they were cleared.
  class Packets {
   public:
    Packet& add() {
      if (m_count == m_all.size()) m_all.emplace_back();
      Packet& packet = m_all[m_count++];
      packet.large = false;
      return packet;
    }
    void removeLast() { --m_count; }
    void clear() { m_count = 0; }
    std::size_t size() const { return m_count; }
    bool empty() const { return m_count == 0; }
    const Packet* begin() const { return m_all.data(); }
    const Packet* end() const { return m_all.data() + m_count; }
    const Packet& back() const { return m_all[m_count - 1]; }

   private:
    std::vector<Packet> m_all;  ///< the first m_count are in use
    std::size_t m_count = 0;
  };
  /// What may be sent in a tick.
  struct Room {
    std::size_t packets = 64;                  ///< at most so many
    std::size_t bytes = kMaxDatagramSnapshot;  ///< of each
    bool large = true;  ///< one that exceeds `bytes` may be among them, up to kMaxSnapshot
  };

  explicit SnapshotSender(Resend resend = Resend::kAhead) : m_resend(resend) {}

  /// Note one published tick and what this player sees of it. To be called after every Publisher::update
  /// while the client is connected; the first call owes the client all it sees.
  void note(const Publisher& publisher, const df::PlayerFacts& player);
  /// The newest input that the game has had, and in which tick. To be called before the build() of that tick.
  void noteInput(std::uint32_t id, std::uint32_t tick) { m_per_client.noteInput(id, tick); }
  /// The client's terminal, in cells; 0: unknown.
  void setTerminal(std::uint32_t columns, std::uint32_t rows) { m_shown.setTerminal(columns, rows); }
  /// How many ticks from now on an object may enter the view before the next one is due.
  void setLookAhead(std::uint32_t ticks) { m_look_ahead = ticks; }

  /// Write what is owed at the publisher's tick, most urgent first, and none beyond kMaxInFlight
  /// unacknowledged. Where nothing is owed or that window is full: one snapshot every kKeepAlive ticks, else
  /// none.
  void build(const Publisher& publisher, Room room, Packets& packets);
  std::vector<Packet> build(const Publisher& publisher, Room room = Room{64, kMaxDatagramSnapshot, true}) {
    Packets packets;
    build(publisher, room, packets);
    return {packets.begin(), packets.end()};
  }

  /// A snapshot at the publisher's tick that carries nothing, to find out whether datagrams pass. Its loss
  /// says nothing of the line.
  Packet probe(const Publisher& publisher);

  /// The client acknowledged. A number that it leaves out is taken for lost, at once or with some patience
  /// (LossEstimator).
  void acknowledge(const AckWindow& acks);
  /// This one, just built, is large and goes on a stream: it is late rather than lost.
  void wentByStream(std::uint32_t number);
  /// One that is large has not been acknowledged yet. What overtakes it would show a world without it.
  bool awaitsLarge() const;
  /// What was sent on the stream is gone with it.
  void loseLarge();

  /// Is this the checksum of a client that has received what `acks` says? Nothing if too little is known of
  /// that moment to compare. To be called after acknowledge().
  std::optional<bool> isRight(const AckWindow& acks, std::uint64_t checksum) const;
  /// Start anew: the client forgets the world and is owed all of it.
  void reset();

  /// Something was owed at the last build() that could not be sent.
  bool isThrottled() const { return m_throttled; }
  /// Nothing is owed and nothing unacknowledged.
  bool isSettled() const;
  /// Share of the last snapshots that were lost, 0 … 1, smoothed.
  double loss() const { return m_line.loss(); }
  /// Objects sent again because a snapshot was lost.
  std::uint64_t resentCount() const { return m_resent; }
  std::size_t knownCount() const { return m_known.aliveCount(); }
  const KnownObjects& known() const { return m_known; }
  std::uint32_t newestNumber() const { return m_next_number - 1; }
  /// Of the world, as the client knows it: counts resets, modulo 4.
  std::uint8_t epoch() const { return m_epoch; }

  static constexpr std::uint32_t kKeepAlive = 5;
  /// Snapshots unacknowledged at most; the oldest beyond that is taken for lost.
  static constexpr std::size_t kMaxInFlight = 64;

 private:
  /// The client's state after a snapshot, for isRight().
  struct Moment {
    std::uint32_t number = 0;
    std::uint64_t checksum = 0;
    enum : std::uint8_t {
      kUnknown,
      kNotMissed,
      kRepaired
    } fate = kUnknown;  ///< of the snapshot, if it was lost
  };
  static constexpr std::size_t kMaxMoments = 128;

  struct Desk;
  static Desk& desk();

  SnapshotSender(Resend resend, std::uint32_t look_ahead, std::uint8_t epoch)
      : m_resend(resend), m_epoch(epoch), m_look_ahead(look_ahead) {}
  bool isOwn(const KnownObjects::Known& known) const;
  bool isOwing() const { return m_per_client.isOwing() || !m_known.owing().empty(); }
  double urgency(std::uint32_t id, const Publisher& publisher) const;
  std::size_t mostBits(std::uint32_t id, const Publisher& publisher) const;
  void makeQueue(const Publisher& publisher, const Room& room);
  bool repeatsAhead() const;
  bool write(const Publisher& publisher, const Room& room, Packet& packet);
  void writeObjects(const Publisher& publisher, const Room& room, Packet& packet);
  void finish(Packet& packet);
  void forgetOldest();
  void takeBack();
  static bool isTooLarge(std::size_t bits, std::size_t bytes);
  std::size_t encode(std::uint32_t id, const Publisher& publisher, const Publisher::Model* model,
                     LookForm& form);
  void pay(std::uint32_t id, const Publisher::Model* model, LookForm form);
  void considerAhead(std::uint32_t id, std::size_t bits, const Publisher& publisher);
  void arrived(const Flight::Snapshot& snapshot);
  void lost(const Flight::Snapshot& snapshot);
  Moment& momentOf(std::uint32_t number) { return m_moments[number % kMaxMoments]; }

  Resend m_resend;
  Desk* m_p_desk = nullptr;  ///< only while a snapshot is written
  KnownObjects m_known;
  PerClientState m_per_client;
  AppearanceNames m_names;
  Flight m_flight;
  std::array<Moment, kMaxMoments> m_moments;  ///< by number, modulo their number
  ClientViewport m_shown;
  Interest m_interest;
  std::uint32_t m_next_number = 1;
  std::uint32_t m_last_tick = 0;  ///< of the last snapshot built
  std::uint32_t m_tick = 0;
  std::uint32_t m_clean_from = 1;  ///< from this snapshot on all that was lost before has been sent again
  bool m_repairing = false;
  bool m_began = false;
  bool m_throttled = false;
  std::uint8_t m_epoch = 0;
  std::uint32_t m_look_ahead = 4;
  LossEstimator m_line;
  std::array<std::uint32_t, 16> m_missing{};  ///< the last ones taken for lost, by number
  RedundantResend m_ahead;
  std::uint64_t m_resent = 0;
};

}  // namespace naiad

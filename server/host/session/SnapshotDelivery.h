// Sends one client's snapshots: by datagram where datagrams pass, else on the streams.
//
// Acknowledgements, checksums and requests for a reset arrive on the same transports.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "host/net/SealedChannel.h"
#include "host/session/Counters.h"
#include "host/session/PictureAudit.h"
#include "host/session/StreamPair.h"
#include "host/session/TransportSelector.h"
#include "host/snapshot/LagCompensator.h"
#include "host/snapshot/SnapshotSender.h"

namespace naiad {

class SnapshotDelivery {
 public:
  using Time = std::chrono::steady_clock::time_point;

  static constexpr std::chrono::seconds kResetEvery{2};
  /// A client sends a checksum once a second; a few may come at once after a stall.
  static constexpr std::chrono::milliseconds kChecksumEvery{250};
  /// A larger snapshot goes on the first stream only. A world sent twice would be too much for a slow line,
  /// while the changes that gathered during a wait should not cause another wait.
  static constexpr std::size_t kMaxOnSecond = std::size_t{4} * 1024;

  SnapshotDelivery(Counters& counters, Time now) : m_counters(counters), m_transport(now) {}

  /// Null: on the streams only.
  void setDatagrams(std::unique_ptr<SealedChannel> datagrams) { m_datagrams = std::move(datagrams); }
  SealedChannel* datagrams() { return m_datagrams.get(); }

  /// Note a published tick, and send what is pending unless the client is still busy with earlier bytes.
  void sendTick(const Publisher& publisher, const df::PlayerFacts& player, StreamPair& streams, Time now);
  /// The newest input that the world has had, and in which tick.
  void noteInput(std::uint32_t id, std::uint32_t tick) { m_sender.noteInput(id, tick); }
  void setTerminal(std::uint32_t columns, std::uint32_t rows) { m_sender.setTerminal(columns, rows); }

  /// Audit the client's pictures (PictureAudit.h), or do no longer.
  void setAudit(bool audit);
  /// Null without an audit.
  PictureAudit* audit() { return m_audit.get(); }

  void acknowledge(const AckWindow& acks, bool by_datagram, Time now);
  /// Reset the client's world if it is not what was sent.
  void compareChecksum(const AckWindow& acks, std::uint64_t checksum, Time now);
  /// Send the client's world again, but not more often than a line can carry.
  void requestReset(Time now);

  /// The client forgets what it knows: everything is pending.
  void reset();
  /// What was sent on the first stream is lost with it.
  void loseStream();
  /// The client is on another stream: find out again whether datagrams pass.
  void renewTransport(Time now) { m_transport.renew(now); }
  /// Another process of the client, which knows nothing of this one's transport. The world that it is sent
  /// counts as a reset.
  void restart(Time now);

  /// The last snapshot was to go on a stream and could not, because of earlier bytes.
  bool isHeldUp() const { return m_held_up; }
  bool usesDatagrams(Time now) const { return m_datagrams != nullptr && m_transport.isOpen(now); }
  /// The newest published tick.
  std::uint32_t tick() const { return m_tick; }
  /// The tick of a snapshot; none if it is not remembered.
  std::optional<std::uint32_t> tickOf(std::uint32_t snapshot) const { return m_ticks.tickOf(snapshot); }
  /// Ticks at whose end the client was not up to date, since it or its line was busy with earlier bytes.
  std::uint64_t skippedTicks() const { return m_skipped_ticks; }
  const TransportSelector& transport() const { return m_transport; }
  const SnapshotSender& sender() const { return m_sender; }

 private:
  void settleAcks();
  void sendDatagrams(const Publisher& publisher, StreamPair& streams, Time now);
  void sendOnStreams(const Publisher& publisher, StreamPair& streams, Time now);
  void sendProbe(const Publisher& publisher, Time now);
  void noteSent(const SnapshotSender::Packet& packet, bool as_datagram, Time now);
  void count(const SnapshotSender::Packet& packet);
  void countDatagram(const SnapshotSender::Packet& packet);
  void skipTick();

  Counters& m_counters;
  std::unique_ptr<SealedChannel> m_datagrams;
  std::uint32_t m_tick = 0;
  std::optional<AckWindow> m_acks;  ///< received, and not settled yet
  std::uint64_t m_skipped_ticks = 0;
  SnapshotSender m_sender{Resend::kAhead};
  std::unique_ptr<PictureAudit> m_audit;
  TransportSelector m_transport;
  SnapshotTicks m_ticks;
  bool m_held_up = false;
  std::optional<Time> m_last_reset;
  std::optional<Time> m_last_checksum;
};

}  // namespace naiad

#include "host/net/RelayedStream.h"

#include <utility>

#include "shared/net/stream/Framing.h"

namespace naiad {

namespace {

/// Maximum bytes in transit to the network thread, in addition to the channel's own queue there.
constexpr std::size_t kMaxInTransit = TcpOptions{}.send_cap;

}  // namespace

RelayedDatagrams::RelayedDatagrams(NetworkThread& network, NetworkThread::NetworkSideDatagrams& end,
                                   Epoch epoch)
    : m_network(network), m_end(end), m_epoch(epoch) {
  m_network.m_datagram_slots[m_end.slot] = {m_end.id, this};
}

RelayedDatagrams::~RelayedDatagrams() {
  m_network.m_datagram_slots[m_end.slot] = {};
  m_network.m_free_slots.push_back(m_end.slot);
  m_network.postCommand({.kind = NetworkThread::Command::kDropDatagrams, .datagrams = &m_end});
}

void RelayedDatagrams::start(std::function<void(std::string_view)> on_packet) {
  m_on_packet = std::move(on_packet);
}

void RelayedDatagrams::send(std::string_view packet) {
  if (m_network.isCommandMailboxFull()) {
    ++m_network.m_out_dropped;
    return;
  }
  m_network.postCommand({.kind = NetworkThread::Command::kSendDatagram, .datagrams = &m_end}, packet);
}

std::optional<std::size_t> RelayedDatagrams::payloadBudget() const {
  const std::int32_t payload_budget = m_end.payload_budget.load(std::memory_order_relaxed);
  return payload_budget < 0 ? std::nullopt : std::optional(static_cast<std::size_t>(payload_budget));
}

// Assumes that the epoch is in use from now on, although the stream may just have ended. If it has, the next
// epoch skips a number, which both ends accept (SealedLink::startEpoch).
bool RelayedDatagrams::renew(const ReliableChannel& stream, Epoch epoch) {
  if (epoch <= m_epoch || !m_network.renewDatagrams(m_end, stream, epoch)) return false;
  m_epoch = epoch;
  return true;
}

RelayedStream::RelayedStream(NetworkThread& network, NetworkThread::NetworkSideStream& end)
    : m_network(network), m_end(end) {
  m_network.m_relayed_streams.emplace(m_end.id, this);
}

RelayedStream::~RelayedStream() {
  m_network.m_relayed_streams.erase(m_end.id);
  m_network.postCommand({.kind = NetworkThread::Command::kDropStream, .stream = &m_end});
}

void RelayedStream::start(Callbacks callbacks) {
  m_callbacks = std::make_shared<Callbacks>(std::move(callbacks));
}

void RelayedStream::send(std::string_view frame) {
  if (m_closed) return;
  if (inTransit() + frame.size() > kMaxInTransit || m_network.isCommandMailboxFull()) {
    ++m_network.m_clogged;
    m_closed = true;
    return m_network.postCommand({.kind = NetworkThread::Command::kCut, .stream = &m_end});
  }
  m_bytes_passed += kFrameHeaderSize + frame.size();
  m_idle = false;
  m_network.postCommand({.kind = NetworkThread::Command::kSendFrame, .stream = &m_end}, frame);
}

std::size_t RelayedStream::unsentBytes() const {
  if (m_idle) return 0;
  // This order matters: bytes taken over in between are counted twice, not missed.
  const std::size_t in_transit = inTransit();
  const std::size_t unsent = in_transit + m_end.unsent;
  m_idle = unsent == 0;
  return unsent;
}

void RelayedStream::close() {
  if (std::exchange(m_closed, true)) return;
  m_network.postCommand({.kind = NetworkThread::Command::kClose, .stream = &m_end});
}

void RelayedStream::setReceiveLimit(std::size_t bytes) {
  m_network.postCommand({.kind = NetworkThread::Command::kReceiveLimit, .stream = &m_end, .number = bytes});
}

void RelayedStream::deliver(std::string_view frame) {
  const auto callbacks = m_callbacks;  // the callee may destroy this
  if (!m_closed && callbacks && callbacks->on_frame) callbacks->on_frame(frame);
}

void RelayedStream::reportEnd(CloseReason reason) {
  m_closed = true;
  const auto callbacks = std::move(m_callbacks);
  if (callbacks && callbacks->on_closed) callbacks->on_closed(reason);
}

}  // namespace naiad

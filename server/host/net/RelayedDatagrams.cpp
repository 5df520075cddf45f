#include "host/net/RelayedDatagrams.h"

#include <utility>

namespace naiad {

RelayedDatagrams::RelayedDatagrams(NetworkThread& network, NetworkThread::DatagramsEnd& end, Epoch epoch)
    : m_network(network), m_end(end), m_epoch(epoch) {
  m_network.m_near_datagrams[m_end.place] = {m_end.id, this};
}

RelayedDatagrams::~RelayedDatagrams() {
  m_network.m_near_datagrams[m_end.place] = {};
  m_network.m_free_places.push_back(m_end.place);
  m_network.giveOrder({.kind = NetworkThread::Order::kDropDatagrams, .datagrams = &m_end});
}

void RelayedDatagrams::start(std::function<void(std::string_view)> on_packet) {
  m_on_packet = std::move(on_packet);
}

void RelayedDatagrams::send(std::string_view packet) {
  if (m_network.isFull()) {
    ++m_network.m_out_dropped;
    return;
  }
  m_network.giveOrder({.kind = NetworkThread::Order::kSendDatagram, .datagrams = &m_end}, packet);
}

std::optional<std::size_t> RelayedDatagrams::room() const {
  const std::int32_t room = m_end.room.load(std::memory_order_relaxed);
  return room < 0 ? std::nullopt : std::optional(static_cast<std::size_t>(room));
}

// The epoch is taken to be in use although the stream may just have ended: the next one is higher then, which
// both ends accept (SealedLink::startEpoch).
bool RelayedDatagrams::renew(const ReliableChannel& stream, Epoch epoch) {
  if (epoch <= m_epoch || !m_network.renewDatagrams(m_end, stream, epoch)) return false;
  m_epoch = epoch;
  return true;
}

}  // namespace naiad

#include "client/session/ServerLink.h"

#include <utility>

#include "naiad.pb.h"
#include "shared/net/base/Limits.h"
#include "shared/net/stream/Framing.h"

namespace naiad {

ServerLink::ServerLink(std::unique_ptr<ReliableChannel> channel, const SessionOptions& options,
                       SessionCounters& counters)
    : m_options(options), m_counters(counters), m_channel(std::move(channel)) {
  m_channel->setReceiveLimit(kMaxServerFrame);
  send(helloOf(options));
}

void ServerLink::takeStream(ServerLink& other) {
  m_second.close();
  m_channel = std::move(other.m_channel);
}

void ServerLink::dropStream() {
  m_second.close();
  m_channel.reset();
}

void ServerLink::closeStreams() {
  m_second.close();
  if (m_channel != nullptr) m_channel->close();
}

void ServerLink::send(const wire::ClientMessage& message) {
  sendFrame(message.SerializeAsString());
}

void ServerLink::sendFrame(const std::string& frame) {
  if (m_channel == nullptr) return;
  m_counters.bytes_out += frame.size() + kFrameHeaderSize;
  m_channel->send(frame);
}

bool ServerLink::sendReliable(wire::ClientMessage& message) {
  message.set_number(m_unacknowledged.next());
  const std::string frame = message.SerializeAsString();
  if (!m_unacknowledged.keep(frame)) return false;
  sendFrame(frame);
  return true;
}

void ServerLink::resendReliable() {
  m_unacknowledged.forEach([this](const std::string& frame) { sendFrame(frame); });
}

void ServerLink::sendUpdate(std::string bytes) {
  wire::ClientMessage message;
  message.set_update(std::move(bytes));
  const std::string frame = message.SerializeAsString();
  sendFrame(frame);
  if (!m_second.isOpen()) return;
  m_counters.bytes_out += frame.size() + kFrameHeaderSize;
  m_second.send(frame);
}

void ServerLink::startSecond(std::unique_ptr<ReliableChannel> channel, const std::string& resume_token,
                             OnSnapshot on_snapshot) {
  SessionOptions options = m_options;
  options.password.clear();
  options.resume_token = resume_token;
  options.fresh = false;
  options.second_stream = true;
  m_second.start(std::move(channel), options, std::move(on_snapshot));
}

bool ServerLink::openDatagrams(const WelcomeMessage& welcome, OnSnapshot on_snapshot) {
  const auto aead = aeadFromWire(welcome.aead);
  const auto server = endpointFromText(m_channel->peerAddress());
  if (!aead || !m_options.open_socket || !server) return false;
  std::unique_ptr<DatagramSocket> socket = m_options.open_socket(*server);
  if (socket == nullptr) return false;
  m_datagrams = std::make_unique<SealedDatagrams>(
      std::move(socket), *server, ConnectionId{welcome.connection_id}, m_options.now, m_options.seal_limits);
  if (!m_datagrams->startEpoch(exporter(), *aead, welcome.epoch)) {
    m_datagrams.reset();
    return false;
  }
  m_datagrams->start(std::move(on_snapshot));
  return true;
}

void ServerLink::renewDatagrams(const WelcomeMessage& welcome) {
  const auto aead = aeadFromWire(welcome.aead);
  if (m_datagrams == nullptr || !aead) return;
  m_datagrams->startEpoch(exporter(), *aead, welcome.epoch);
  m_datagrams->reopen();
}

void ServerLink::sendDatagram(const std::string& bytes, bool ping) {
  if (ping) m_datagrams->ping();
  m_counters.bytes_out += bytes.size();
  m_datagrams->send(bytes);
}

KeyExporter ServerLink::exporter() const {
  return [this](std::string_view label, std::string_view context, std::size_t bytes) {
    return m_channel != nullptr ? m_channel->exportSecret(label, context, bytes) : std::string();
  };
}

}  // namespace naiad

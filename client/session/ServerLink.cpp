#include "client/session/ServerLink.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "naiad.pb.h"
#include "shared/net/base/Limits.h"
#include "shared/net/stream/Framing.h"
#include "shared/net/stream/TcpListener.h"

namespace naiad {

bool SecondStream::tryBeginAttempt(Time now) {
  if (m_channel != nullptr || now < m_next_attempt) return false;
  m_next_attempt = now + m_retry_delay;
  m_retry_delay = std::min(m_retry_delay * 2, kMaxRetryDelay);
  return true;
}

void SecondStream::start(std::unique_ptr<ReliableChannel> channel, const SessionOptions& options,
                         std::function<void(std::string_view bytes)> on_snapshot) {
  close();
  m_channel = std::move(channel);
  m_on_snapshot = std::move(on_snapshot);
  m_started = m_last_received = options.now();
  m_channel->setReceiveLimit(kMaxServerFrame);
  m_channel->start({[this, now = options.now](std::string_view frame) { receive(frame, now()); },
                    [this](CloseReason) { close(); }});
  m_channel->send(helloOf(options).SerializeAsString());
}

void SecondStream::update(Time now) {
  if (now - m_last_received >= kMaxSilence) close();
}

void SecondStream::receive(std::string_view frame, Time now) {
  m_last_received = now;
  if (now - m_started > m_retry_delay) m_retry_delay = kFirstRetryDelay;
  auto message = readServerMessage(frame);
  const auto* welcome = message ? std::get_if<WelcomeMessage>(&*message) : nullptr;
  if (!m_open && welcome != nullptr && welcome->second_stream) {
    m_open = true;
    return;
  }
  const auto* snapshot = message ? std::get_if<SnapshotMessage>(&*message) : nullptr;
  if (!m_open || snapshot == nullptr) return close();
  m_on_snapshot(snapshot->bytes);
}

bool SecondStream::isDuplicate(std::string_view snapshot) {
  const std::size_t hash = std::hash<std::string_view>()(snapshot);
  const std::size_t kept = std::min(m_snapshot_count, m_hashes.size());
  const auto end = m_hashes.begin() + static_cast<std::ptrdiff_t>(kept);
  if (std::find(m_hashes.begin(), end, hash) != end) return true;
  m_hashes[m_snapshot_count++ % m_hashes.size()] = hash;
  return false;
}

void SecondStream::send(std::string_view frame) {
  if (m_open && m_channel->unsentBytes() == 0) m_channel->send(frame);
}

void SecondStream::close() {
  m_open = false;
  if (m_channel == nullptr) return;
  m_channel->close();
  m_channel.reset();
}

SealedDatagrams::SealedDatagrams(std::unique_ptr<DatagramSocket> socket, const Endpoint& server,
                                 ConnectionId id, Now now, SealLimits limits)
    : m_socket(std::move(socket)),
      m_server(server),
      m_now(std::move(now)),
      m_link({SealedLink::Role::kClient, id, {}, limits}) {
  m_link.setServerPath({Endpoint{}, server});
}

bool SealedDatagrams::startEpoch(const KeyExporter& exporter, AeadId aead, Epoch epoch) {
  try {
    return m_link.startEpoch(epoch, deriveDatagramKeys(exporter, aead, m_link.id(), epoch), m_now());
  } catch (const KeyExportError&) {
    return false;
  }
}

bool SealedDatagrams::popNewEpochDue() {
  if (!m_link.needsNewEpoch() || m_reported_epoch == m_link.epoch()) return false;
  m_reported_epoch = m_link.epoch();
  return true;
}

void SealedDatagrams::start(std::function<void(std::string_view packet)> on_packet) {
  m_socket->start([this, on_packet = std::move(on_packet)](const Path& path, std::string_view packet) {
    const auto payload = m_link.open(path, packet, m_now());
    if (!payload) return;
    if (m_link.needsToSend(m_now())) send({});  // the response to a challenge
    if (!payload->empty()) on_packet(*payload);
  });
}

void SealedDatagrams::send(std::string_view packet) {
  const auto outgoing = m_link.seal(packet, m_now(), m_socket->nextPacket());
  if (!outgoing) return;
  m_socket->send(outgoing->path, outgoing->packet);
  m_socket->flush();
}

void SealedDatagrams::reopen() {
  try {
    m_socket->reopen();
  } catch (const ListenError&) {
    // No port is free. The stream continues, and the next new stream tries this again.
  }
}

ServerLink::ServerLink(std::unique_ptr<ReliableChannel> channel, const SessionOptions& options,
                       SessionCounters& counters)
    : m_options(options), m_counters(counters), m_channel(std::move(channel)) {
  m_channel->setReceiveLimit(kMaxServerFrame);
  send(helloOf(options));
}

void ServerLink::adoptStream(ServerLink& other) {
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
  if (!m_unacknowledged.add(frame)) return false;
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
  options.new_process = false;
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

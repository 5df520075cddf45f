#include "host/net/NetworkThread.h"

#include <pthread.h>
#include <time.h>

#include <algorithm>
#include <asio/post.hpp>
#include <cassert>
#include <future>
#include <memory>
#include <optional>
#include <utility>

#include "host/auth/ResumeTokens.h"
#include "host/net/RelayedStream.h"
#include "shared/net/datagram/UdpSocket.h"
#include "shared/net/stream/Framing.h"

namespace naiad {

namespace {

/// Maximum number of event-loop handlers per turn; then their results are passed to the tick thread.
constexpr int kMaxHandlers = 64;
/// Bytes counted for each event in addition to its frame, so that many small frames also reach a limit.
constexpr std::size_t kNoticeBytes = 32;
/// Minimum time between two counts of unsent bytes. A count takes one system call per stream. So the time is
/// kCounting times the duration of the last count, but at least kBusy and at most kLongBusy.
constexpr std::chrono::milliseconds kBusy{2};
constexpr std::chrono::milliseconds kLongBusy{6};
constexpr int kCounting = 20;
/// Interval of challenges to unvalidated addresses.
constexpr std::chrono::milliseconds kUnvalidated{50};
/// Time for which the tick thread serves events in one go between two ticks.
constexpr std::chrono::microseconds kHelping{200};
constexpr int kMinServed = 64;

}  // namespace

NetworkThread::NetworkThread(asio::io_context& home, const std::string& address, std::uint16_t port,
                             OnChannel on_channel, TcpOptions options, TlsListenerOptions tls, Limits limits,
                             ProxyListenerOptions visitors, const std::optional<InheritedSockets>& inherited)
    : m_home(home), m_on_channel(std::move(on_channel)), m_limits(limits) {
  const OnChannel meet = [this](std::unique_ptr<ReliableChannel> channel) {
    registerStream(std::move(channel));
  };
  m_port = inherited
               ? adoptServerPort(m_io, *inherited, meet, options, std::move(tls), std::move(visitors))
               : openServerPort(m_io, address, port, meet, options, std::move(tls), std::move(visitors));
}

NetworkThread::~NetworkThread() {
  stop();
  assert(m_relayed_streams.empty() && m_free_slots.size() == m_datagram_slots.size());
}

void NetworkThread::start() {
  if (m_thread.joinable()) return;
  m_stopping = false;
  m_thread = std::thread([this] { run(); });
}

void NetworkThread::stop() {
  if (m_thread.joinable()) {
    m_stopping = true;
    asio::post(m_io, [] {});
    m_thread.join();
  }
  // Runs the remaining commands, so that the objects in them are stored or released. No more data is sent.
  m_command_mailbox.push(m_commands);
  runCommands();
  reportCounters();
}

void NetworkThread::closeListener() {
  postCommand({.kind = Command::kCloseListener});
}

void NetworkThread::setTls(std::shared_ptr<const TlsContext> context) {
  asio::post(m_io, [this, context = std::move(context)] { m_port.streams->setTls(context); });
}

// ---- the tick thread --------------------------------------------------------------------------------------

bool NetworkThread::serve(Clock::time_point enough) {
  m_home_woken = false;  // before taking the batch, so that later events wake it again
  bool more = false;
  m_serving = true;
  Event notice;
  std::string_view bytes;
  for (int served = 1; !more; ++served) {
    if (!m_serving_batch.read(notice, bytes)) {
      m_event_mailbox.popAll(m_serving_batch);
      if (!m_serving_batch.read(notice, bytes)) break;
    }
    m_received_at = notice.received_at;
    onEvent(notice, bytes);
    more = served % kMinServed == 0 && Clock::now() >= enough;
  }
  m_serving = false;
  flush();
  return !more;
}

void NetworkThread::onEvent(const Event& notice, std::string_view bytes) {
  if (notice.kind == Event::kAccepted) {
    --m_unaccepted;
    return m_on_channel(std::make_unique<RelayedStream>(*this, *notice.stream));
  }
  if (notice.kind == Event::kDatagram) {
    const DatagramSlot& near = m_datagram_slots[notice.slot];
    if (near.id == notice.id && near.channel->m_on_packet) near.channel->m_on_packet(bytes);
    return;
  }
  const auto found = m_relayed_streams.find(notice.id);
  if (found == m_relayed_streams.end()) return;  // destroyed in the meantime
  RelayedStream& stream = *found->second;
  if (notice.kind == Event::kClosed) return stream.reportEnd(notice.reason);
  stream.m_end.in -= bytes.size() + kNoticeBytes;
  stream.deliver(bytes);
}

void NetworkThread::sendCommands(std::optional<Clock::time_point> tick_began) {
  if (m_commands.empty()) return;
  if (tick_began) {
    const auto began = static_cast<std::uint64_t>(tick_began->time_since_epoch().count());
    postCommand({.kind = Command::kTickEnd, .number = began});
  }
  m_command_mailbox.push(m_commands);
  if (!m_woken.exchange(true)) asio::post(m_io, [this] { runCommands(); });
}

void NetworkThread::wakeHome() {
  if (m_home_woken.exchange(true)) return;
  asio::post(m_home, [this] {
    if (!serve(Clock::now() + kHelping)) wakeHome();
  });
}

std::unique_ptr<SealedChannel> NetworkThread::openDatagrams(const ReliableChannel& stream, AeadId aead) {
  const auto* relayed = dynamic_cast<const RelayedStream*>(&stream);
  if (!hasDatagrams() || relayed == nullptr) return nullptr;
  constexpr Epoch kFirstEpoch{1};
  auto* const end = new NetworkSideDatagrams;  // owned by m_datagrams once the command runs
  end->id = ++m_newest_datagrams;
  if (m_free_slots.empty()) {
    m_free_slots.push_back(static_cast<std::uint32_t>(m_datagram_slots.size()));
    m_datagram_slots.emplace_back();
  }
  end->slot = m_free_slots.back();
  m_free_slots.pop_back();
  end->connection = randomBits();
  end->aead = aead;
  postCommand(
      {.kind = Command::kOpenDatagrams, .stream = &relayed->m_end, .datagrams = end, .number = kFirstEpoch});
  return std::make_unique<RelayedDatagrams>(*this, *end, kFirstEpoch);
}

bool NetworkThread::renewDatagrams(NetworkSideDatagrams& end, const ReliableChannel& stream, Epoch epoch) {
  const auto* relayed = dynamic_cast<const RelayedStream*>(&stream);
  if (relayed == nullptr) return false;
  postCommand({.kind = Command::kRenew, .stream = &relayed->m_end, .datagrams = &end, .number = epoch});
  return true;
}

// Data unsent at the deadline is lost. The posted jobs own everything they use, except this object.
void NetworkThread::broadcastAndClose(const std::string& frame, std::chrono::milliseconds timeout) {
  const auto end = Clock::now() + timeout;
  asio::post(m_io, [this, frame] {
    for (const auto& [p_end, stream] : m_streams) {
      if (!stream->channel) continue;
      stream->channel->send(frame);
      stream->channel->close();
    }
  });
  for (bool sent = false; !sent && Clock::now() < end;) {
    const auto answer = std::make_shared<std::promise<bool>>();
    auto answered = answer->get_future();
    asio::post(m_io, [this, answer] { answer->set_value(!hasUnsent()); });
    if (answered.wait_until(end) != std::future_status::ready) return;
    sent = answered.get();
    if (!sent) std::this_thread::sleep_for(kBusy);
  }
}

RelayCounters NetworkThread::counters() const {
  RelayCounters counters = m_counters;
  counters.datagrams_out_dropped = m_out_dropped;
  counters.streams_clogged = m_clogged;
  return counters;
}

NetworkCounters NetworkThread::latestCounters() const {
  NetworkCounters counters;
  {
    const std::lock_guard lock(m_gate_mutex);
    counters = m_reported;
  }
  counters.relay.datagrams_out_dropped = m_out_dropped;
  counters.relay.streams_clogged = m_clogged;
  return counters;
}

std::chrono::nanoseconds NetworkThread::cpuTime() {
  clockid_t clock{};
  timespec spent{};
  if (!m_thread.joinable() || pthread_getcpuclockid(m_thread.native_handle(), &clock) != 0 ||
      clock_gettime(clock, &spent) != 0)
    return {};
  return std::chrono::seconds(spent.tv_sec) + std::chrono::nanoseconds(spent.tv_nsec);
}

DatagramDemuxCounters NetworkThread::gateCounters() const {
  const std::lock_guard lock(m_gate_mutex);
  return m_gate_counters;
}

// ---- the network thread -----------------------------------------------------------------------------------

// Serves what is ready, then hands over the results, in a loop.
void NetworkThread::run() {
  while (!m_stopping) {
    if (!m_busy.empty()) {
      m_io.run_one_for(kBusy);
    } else if (m_port.datagrams && m_port.datagrams->hasUnvalidated()) {
      m_io.run_one_for(kUnvalidated);
    } else {
      m_io.run_one();
    }
    for (int i = 1; i < kMaxHandlers && m_io.poll_one() > 0; ++i) {
    }
    endIteration();
  }
}

void NetworkThread::endIteration() {
  if (m_port.datagrams) {
    m_port.datagrams->flush();
    const std::lock_guard lock(m_gate_mutex);
    m_gate_counters = m_port.datagrams->counters();
  }
  updateUnsent();
  if (m_events.empty()) return;
  m_event_mailbox.push(m_events);
  if (std::exchange(m_urgent, false)) wakeHome();
}

// Counts the unsent bytes of streams that had some at the last count or were sent more since then. Does not
// count in every turn, because after a tick all streams are busy for many turns.
void NetworkThread::updateUnsent() {
  const Clock::time_point begin = Clock::now();
  if (m_busy.empty() || begin < m_count_at) return;
  std::erase_if(m_busy, [](NetworkSideStream* end) {
    end->unsent = end->channel ? end->channel->unsentBytes() : 0;
    end->busy = end->unsent > 0;
    return !end->busy;
  });
  const Clock::time_point end = Clock::now();
  m_count_at = end + std::clamp<Clock::duration>(kCounting * (end - begin), kBusy, kLongBusy);
}

bool NetworkThread::hasUnsent() const {
  return std::any_of(m_streams.begin(), m_streams.end(), [](const auto& entry) {
    return entry.second->channel && entry.second->channel->unsentBytes() > 0;
  });
}

void NetworkThread::runCommands() {
  m_woken = false;  // before taking the batch, so that later commands wake it again
  m_command_mailbox.popAll(m_running_commands);
  Command order;
  std::string_view bytes;
  while (m_running_commands.read(order, bytes)) {
    runCommand(order, bytes);
  }
}

void NetworkThread::runCommand(const Command& order, std::string_view bytes) {
  NetworkSideStream* const stream = order.stream;
  NetworkSideDatagrams* const datagrams = order.datagrams;
  switch (order.kind) {
    case Command::kSendDatagram:
      if (!datagrams->channel) break;
      datagrams->channel->send(bytes);
      return updatePayloadBudget(*datagrams);
    case Command::kSendFrame:
      if (stream->channel) {
        stream->channel->send(bytes);
        ++m_traffic.frames_out;
        m_traffic.stream_bytes_out += kFrameHeaderSize + bytes.size();
        stream->unsent += kFrameHeaderSize + bytes.size();  // before `taken`: see RelayedStream::unsentBytes
        if (!std::exchange(stream->busy, true)) m_busy.push_back(stream);
      }
      stream->taken += kFrameHeaderSize + bytes.size();
      break;
    case Command::kClose:
      if (stream->channel) stream->channel->close();
      break;
    case Command::kCut:
      if (stream->channel) onClosed(*stream, CloseReason::kOverflow);
      break;
    case Command::kReceiveLimit:
      if (stream->channel) stream->channel->setReceiveLimit(order.number);
      break;
    case Command::kDropStream:
      std::erase(m_busy, stream);
      m_streams.erase(stream);
      break;
    case Command::kOpenDatagrams:
      m_datagrams.emplace(datagrams, datagrams);
      openDatagrams(*datagrams, *stream);
      break;
    case Command::kRenew:
      if (!datagrams->channel) break;
      if (!stream->channel || !datagrams->channel->renew(*stream->channel, static_cast<Epoch>(order.number)))
        ++m_counters.keyless;
      break;
    case Command::kDropDatagrams:
      m_datagrams.erase(datagrams);
      break;
    case Command::kCloseListener:
      if (m_port.visitors) m_port.visitors->close();
      m_port.streams->close();
      break;
    case Command::kTickEnd:
      if (m_port.datagrams) m_port.datagrams->flush();
      m_tick_times.add(Clock::now().time_since_epoch() - Clock::duration(order.number));
      break;
    case Command::kReportCounters:
      reportCounters();
      break;
  }
}

void NetworkThread::reportCounters() {
  NetworkCounters counters;
  counters.relay = m_counters;
  counters.traffic = m_traffic;
  counters.streams = m_port.streams->counters();
  if (m_port.visitors) counters.visitors = m_port.visitors->counters();
  if (m_port.datagrams) {
    counters.gate = m_port.datagrams->counters();
    counters.udp = m_port.p_socket->counters();
    counters.traffic.datagram_bytes_in = m_port.datagrams->bytesReceived();
    counters.traffic.datagram_bytes_out = m_port.datagrams->bytesSent();
  }
  const std::lock_guard lock(m_gate_mutex);
  m_reported = counters;
}

void NetworkThread::openDatagrams(NetworkSideDatagrams& end, const NetworkSideStream& stream) {
  if (stream.channel) {
    const KeyExporter exporter = [&](std::string_view label, std::string_view context, std::size_t bytes) {
      return stream.channel->exportSecret(label, context, bytes);
    };
    end.channel = m_port.datagrams->open(exporter, end.aead, ConnectionId{end.connection});
  }
  if (!end.channel) {
    ++m_counters.keyless;
    return;
  }
  end.channel->start([this, p_end = &end](std::string_view bytes) {
    updatePayloadBudget(*p_end);
    if (isEventMailboxFull()) {
      ++m_counters.datagrams_in_dropped;
      return;
    }
    addEvent({.kind = Event::kDatagram,
              .slot = p_end->slot,
              .id = p_end->id,
              .received_at = m_port.datagrams->received()},
             bytes);
  });
}

void NetworkThread::updatePayloadBudget(NetworkSideDatagrams& end) {
  const auto payload_budget = end.channel->payloadBudget();
  const std::int32_t now = payload_budget ? static_cast<std::int32_t>(*payload_budget) : -1;
  // Relaxed memory order, because nothing else depends on it. Compared first, because it rarely changes.
  if (end.payload_budget.load(std::memory_order_relaxed) != now)
    end.payload_budget.store(now, std::memory_order_relaxed);
}

void NetworkThread::addEvent(const Event& notice, std::string_view bytes) {
  m_events.add(notice, bytes);
  m_urgent = m_urgent || notice.kind != Event::kDatagram;
}

void NetworkThread::registerStream(std::unique_ptr<ReliableChannel> channel) {
  if (m_unaccepted >= m_limits.unaccepted || isEventMailboxFull()) {
    ++m_counters.unaccepted;
    return;
  }
  ++m_unaccepted;
  auto end = std::make_unique<NetworkSideStream>();
  NetworkSideStream* const p_end = end.get();
  end->id = ++m_newest_stream;
  end->peer = channel->peerAddress();
  end->channel = std::move(channel);
  m_streams.emplace(p_end, std::move(end));
  addEvent({.kind = Event::kAccepted, .id = p_end->id, .stream = p_end, .received_at = Clock::now()});
  p_end->channel->start({[this, p_end](std::string_view frame) { onFrame(*p_end, frame); },
                         [this, p_end](CloseReason reason) { onClosed(*p_end, reason); }});
}

void NetworkThread::onFrame(NetworkSideStream& end, std::string_view frame) {
  const std::size_t bytes = frame.size() + kNoticeBytes;
  if (end.in + bytes > m_limits.stream_in || isEventMailboxFull()) {
    ++m_counters.streams_overflowed;
    return onClosed(end, CloseReason::kOverflow);
  }
  end.in += bytes;
  ++m_traffic.frames_in;
  m_traffic.stream_bytes_in += kFrameHeaderSize + frame.size();
  addEvent({.kind = Event::kFrame, .id = end.id, .received_at = Clock::now()}, frame);
}

// Call when the stream has ended, or to end it.
void NetworkThread::onClosed(NetworkSideStream& end, CloseReason reason) {
  end.channel.reset();
  addEvent({.kind = Event::kClosed, .reason = reason, .id = end.id, .received_at = Clock::now()});
}

}  // namespace naiad
